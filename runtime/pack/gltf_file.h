// A glTF binary opened for reading: its JSON and checked access to its binary chunk. Internal to runtime/pack.
#pragma once
#include <nlohmann/json.hpp>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "runtime/base/file_bytes.h"
#include "runtime/pack/byte_ranges.h"

namespace flaneur {

using Json = nlohmann::json;

// Thrown inside this folder alone, and turned into an Error by LoadTourPack.
struct PackRefused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// What it says, in our words where the JSON library found a member of another type.
std::string Complaint(const std::exception& e);

class Allowance;

// The file's nodes: each has one parent at most, and none lies deeper than kMostNodeDepth.
struct NodeTree {
  std::vector<int> parent, depth;  // by node; parent -1: none
};

struct GltfFile {
  FileBytes bytes;
  Json json;
  std::span<const uint8_t> binary;              // into bytes
  std::map<int, std::vector<uint8_t>> decoded;  // by buffer view, those that were compressed
  std::optional<ByteRanges> there;              // of bytes; none: all of them
  NodeTree tree;
  Allowance* allowance = nullptr;  // while the pack is opened; afterwards everything has been taken
};

// Splits the container, parses and checks the JSON (every index and size is a whole number from 0, every other number
// finite, nodes make trees) and decodes what EXT_meshopt_compression packed. Throws PackRefused. The allowance is in
// the file that comes back, for whoever reads on.
GltfFile OpenGltf(FileBytes bytes, std::optional<ByteRanges> there, Allowance* allowance);

// Member access that names what is missing or of the wrong type.
const Json& Member(const Json& object, const char* key);
int Index(const Json& object, const char* key, size_t limit);         // 0 <= value < limit
int IndexOrNone(const Json& object, const char* key, size_t limit);   // -1 where absent or -1
const Json& Element(const Json& root, const char* array, int index);  // root[array][index]
size_t CountOf(const Json& root, const char* array);                  // of its elements; 0 where it is missing

std::span<const uint8_t> BufferView(const GltfFile& file, int index);
// As much of its beginning as is there.
std::span<const uint8_t> BeginningOfView(const GltfFile& file, int index);
// Where it stands in the file; of a compressed one what stands there for it.
ByteRange RangeOfView(const GltfFile& file, int index);

// How many values an accessor has, whether or not they are plain data.
uint64_t CountOfValues(const GltfFile& file, int accessor);

struct Values {
  int components = 0;          // a value
  std::vector<float> numbers;  // normalized integers scaled to their range
  size_t count() const { return components > 0 ? numbers.size() / static_cast<size_t>(components) : 0; }
};

// An accessor's values as floats.
Values ReadAccessor(const GltfFile& file, int accessor);
std::vector<uint32_t> ReadIndices(const GltfFile& file, int accessor);
int ComponentCount(const std::string& type);
// The factor that turns a normalized integer of this component type into its range, 1 for others.
float NormalizedScale(const Json& accessor);

}  // namespace flaneur
