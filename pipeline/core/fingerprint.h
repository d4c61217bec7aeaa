// Names a stage's input by its content, so that what was made from it once need not be made again.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace flaneur {

class Fingerprint {
 public:
  // Parts are kept apart: ("ab", "c") differs from ("a", "bc").
  Fingerprint& Add(std::string_view part);
  Fingerprint& Add(double number);
  // The content, not the name or age; a file that cannot be read counts as empty. For a .gltf or .glb also the files it
  // names, for a folder all its .py files, in order of their names.
  Fingerprint& AddFile(const std::filesystem::path& path);
  std::string Hex() const;

 private:
  // FNV-1a, 64 bits (Fowler, Noll, Vo): not against attackers, only against mistaking one input for another.
  uint64_t state_ = 14695981039346656037ull;
};

}  // namespace flaneur
