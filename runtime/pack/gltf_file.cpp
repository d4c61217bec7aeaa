#include "runtime/pack/gltf_file.h"

#include <algorithm>
#include <cstring>

#include "runtime/base/array.h"
#include "runtime/base/json_text.h"
#include "runtime/base/text.h"
#include "runtime/pack/allowance.h"
#include "runtime/pack/gltf_check.h"
#include "runtime/pack/meshopt_view.h"

namespace flaneur {
namespace {

constexpr const char* kMeshoptExtension = "EXT_meshopt_compression";
constexpr uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

uint32_t Word(std::span<const uint8_t> bytes, size_t offset) {
  uint32_t word = 0;
  if (offset + 4 > bytes.size()) throw PackRefused("is truncated");
  std::memcpy(&word, bytes.data() + offset, 4);
  return word;
}

size_t ComponentSize(int type) {
  switch (type) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      throw PackRefused("has an accessor of unknown component type " + std::to_string(type));
  }
}

template <typename T>
T Read(const uint8_t* data) {
  T value;
  std::memcpy(&value, data, sizeof value);
  return value;
}

double ReadComponent(const uint8_t* data, int type) {
  switch (type) {
    case 5120:
      return Read<int8_t>(data);
    case 5121:
      return Read<uint8_t>(data);
    case 5122:
      return Read<int16_t>(data);
    case 5123:
      return Read<uint16_t>(data);
    case 5125:
      return Read<uint32_t>(data);
    default:
      return static_cast<double>(Read<float>(data));
  }
}

// Calls visit(value) for every component of the accessor, in order.
template <typename Visit>
void VisitComponents(const GltfFile& file, int accessor_index, Visit visit) {
  const Json& accessor = Element(file.json, "accessors", accessor_index);
  const std::string name = "accessor " + std::to_string(accessor_index);
  const int type = Member(accessor, "componentType").get<int>();
  const size_t size = ComponentSize(type);
  const size_t components = static_cast<size_t>(ComponentCount(Member(accessor, "type").get<std::string>()));
  const size_t count = Member(accessor, "count").get<size_t>();
  if (!accessor.contains("bufferView") || accessor.contains("sparse")) {
    throw PackRefused("has " + name + " without plain data");
  }
  const int view_index = accessor["bufferView"].get<int>();
  const std::span<const uint8_t> view = BufferView(file, view_index);
  const Json& view_json = At(file.json["bufferViews"], view_index);
  const size_t stride = view_json.value("byteStride", size * components);
  const size_t offset = accessor.value("byteOffset", size_t{0});
  if (stride < size * components || offset > view.size() || count > view.size() / std::max<size_t>(stride, 1) + 1 ||
      (count > 0 && offset + (count - 1) * stride + size * components > view.size())) {
    throw PackRefused("has " + name + " that reaches beyond its buffer view");
  }
  if (file.allowance != nullptr) {
    file.allowance->TakeMemory(count * components * sizeof(float), name);
    file.allowance->TakeWork(count * components, name);
  }
  for (size_t i = 0; i < count; ++i) {
    for (size_t c = 0; c < components; ++c) {
      visit(ReadComponent(view.data() + offset + i * stride + c * size, type));
    }
  }
}

// A range of the binary chunk, as a buffer view or an extension of one gives it.
std::span<const uint8_t> PlaceInBinary(const GltfFile& file, const Json& range, int view) {
  const size_t offset = range.value("byteOffset", size_t{0});
  const size_t length = Member(range, "byteLength").get<size_t>();
  if (range.value("buffer", 0) != 0 || offset > file.binary.size() || length > file.binary.size() - offset) {
    throw PackRefused("has buffer view " + std::to_string(view) + " that reaches beyond the file");
  }
  return file.binary.subspan(offset, length);
}

ByteRange RangeOf(const GltfFile& file, std::span<const uint8_t> part) {
  return {static_cast<size_t>(part.data() - file.bytes.data()), part.size()};
}

std::span<const uint8_t> Range(const GltfFile& file, const Json& range, int view) {
  const std::span<const uint8_t> place = PlaceInBinary(file, range, view);
  if (file.there && !file.there->Holds(RangeOf(file, place)))
    throw PackRefused("has not arrived as far as buffer view " + std::to_string(view));
  return place;
}

void DecodeViews(GltfFile* file) {
  if (!file->json.contains("bufferViews")) return;
  int index = 0;
  for (const Json& view : file->json["bufferViews"]) {
    const auto extensions = view.find("extensions");
    if (extensions != view.end() && extensions->contains(kMeshoptExtension)) {
      const Json& packed = (*extensions)[kMeshoptExtension];
      if (packed.value("mode", "") != "ATTRIBUTES") throw PackRefused("has a buffer view compressed in an unknown way");
      const uint64_t bytes =
          Product(Member(packed, "count").get<uint64_t>(), Member(packed, "byteStride").get<uint64_t>());
      file->allowance->TakeMemory(bytes, "buffer view " + std::to_string(index));
      file->allowance->TakeWork(bytes, "buffer view " + std::to_string(index));
      file->decoded[index] =
          DecodeMeshoptView(Range(*file, packed, index), Member(packed, "count").get<size_t>(),
                            Member(packed, "byteStride").get<size_t>(), packed.value("filter", "NONE"));
    }
    ++index;
  }
}

}  // namespace

std::string Complaint(const std::exception& e) {
  if (dynamic_cast<const Json::exception*>(&e) == nullptr) return e.what();
  return "is broken: in its JSON, " + PlainJsonError(e.what());
}

GltfFile OpenGltf(FileBytes bytes, std::optional<ByteRanges> there, Allowance* allowance) {
  GltfFile file;
  file.allowance = allowance;
  file.bytes = std::move(bytes);
  file.there = std::move(there);
  const std::span<const uint8_t> all = std::as_const(file.bytes).span();
  if (all.size() < 12 || Word(all, 0) != kMagic) throw PackRefused("is not a glTF binary");
  if (Word(all, 4) != 2) throw PackRefused("is not glTF 2.0");
  if (Word(all, 8) != all.size()) throw PackRefused("is truncated");
  const size_t json_size = Word(all, 12);
  if (Word(all, 16) != kJsonChunk || json_size > all.size() - 20) throw PackRefused("is truncated");
  const auto text = all.subspan(20, json_size);
  const std::string_view json(reinterpret_cast<const char*>(text.data()), text.size());
  if (NestsTooDeep(json)) throw PackRefused(kNestsTooDeep);
  allowance->TakeMemory(MemoryOfJson_bytes(json), "its JSON");
  file.json = Json::parse(text.begin(), text.end(), nullptr, false);
  if (!file.json.is_object()) throw PackRefused("holds broken JSON");
  CheckGltf(file.json);
  file.tree = TreeOf(file.json);
  const size_t chunk = 20 + json_size;
  if (chunk + 8 <= all.size() && Word(all, chunk + 4) == kBinaryChunk) {
    const size_t binary_size = Word(all, chunk);
    if (binary_size > all.size() - chunk - 8) throw PackRefused("is truncated");
    file.binary = all.subspan(chunk + 8, binary_size);
  }
  DecodeViews(&file);
  return file;
}

const Json& Member(const Json& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  if (!object.is_object() || found == object.end()) throw PackRefused("lacks '" + std::string(key) + "'");
  return *found;
}

int Index(const Json& object, const char* key, size_t limit) {
  const auto value = Member(object, key).get<int64_t>();
  if (value < 0 || static_cast<size_t>(value) >= limit) {
    throw PackRefused("has '" + std::string(key) + "' " + std::to_string(value) + ", but there are only " +
                      std::to_string(limit));
  }
  return static_cast<int>(value);
}

int IndexOrNone(const Json& object, const char* key, size_t limit) {
  if (!object.contains(key) || object[key] == -1) return -1;
  return Index(object, key, limit);
}

const Json& Element(const Json& root, const char* array, int index) {
  const Json& all = Member(root, array);
  if (!all.is_array() || !InRange(all, index)) {
    throw PackRefused("has no element " + std::to_string(index) + " in '" + array + "'");
  }
  return At(all, index);
}

size_t CountOf(const Json& root, const char* array) {
  const auto found = root.find(array);
  return found != root.end() && found->is_array() ? found->size() : 0;
}

uint64_t CountOfValues(const GltfFile& file, int accessor) {
  return Member(Element(file.json, "accessors", accessor), "count").get<uint64_t>();
}

std::span<const uint8_t> BufferView(const GltfFile& file, int index) {
  const Json& view = Element(file.json, "bufferViews", index);
  const auto decoded = file.decoded.find(index);
  return decoded != file.decoded.end() ? std::span<const uint8_t>(decoded->second) : Range(file, view, index);
}

std::span<const uint8_t> BeginningOfView(const GltfFile& file, int index) {
  const std::span<const uint8_t> place = PlaceInBinary(file, Element(file.json, "bufferViews", index), index);
  return file.there ? place.first(std::min(place.size(), file.there->HeldFrom(RangeOf(file, place).offset))) : place;
}

ByteRange RangeOfView(const GltfFile& file, int index) {
  const Json& view = Element(file.json, "bufferViews", index);
  const auto extensions = view.find("extensions");
  const bool packed = extensions != view.end() && extensions->contains(kMeshoptExtension);
  return RangeOf(file, PlaceInBinary(file, packed ? (*extensions)[kMeshoptExtension] : view, index));
}

int ComponentCount(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4") return 4;
  if (type == "MAT4") return 16;
  throw PackRefused("has an accessor of unknown type '" + type + "'");
}

float NormalizedScale(const Json& accessor) {
  if (!accessor.value("normalized", false)) return 1;
  switch (Member(accessor, "componentType").get<int>()) {
    case 5120:
      return 1.0f / 127;
    case 5121:
      return 1.0f / 255;
    case 5122:
      return 1.0f / 32767;
    case 5123:
      return 1.0f / 65535;
    default:
      return 1;
  }
}

Values ReadAccessor(const GltfFile& file, int accessor) {
  const Json& json = Element(file.json, "accessors", accessor);
  Values values;
  values.components = ComponentCount(Member(json, "type").get<std::string>());
  const float scale = NormalizedScale(json);
  VisitComponents(file, accessor, [&](double v) { values.numbers.push_back(static_cast<float>(v) * scale); });
  return values;
}

std::vector<uint32_t> ReadIndices(const GltfFile& file, int accessor) {
  std::vector<uint32_t> indices;
  VisitComponents(file, accessor, [&](double v) {
    if (!(v >= 0 && v <= 4294967295.0)) throw PackRefused("has an index out of range");
    indices.push_back(static_cast<uint32_t>(v));
  });
  return indices;
}

}  // namespace flaneur
