// Names a stage's input by its content, so that what was made from it once need not be made again, by whomever.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "runtime/base/error.h"

namespace flaneur {

class Fingerprint {
 public:
  Fingerprint();
  ~Fingerprint();
  Fingerprint(Fingerprint&&) noexcept;
  Fingerprint& operator=(Fingerprint&&) noexcept;

  // Parts are kept apart: ("ab", "c") differs from ("a", "bc").
  Fingerprint& Add(std::string_view part);
  Fingerprint& Add(double number);
  // The content, not the name or age; a file that cannot be read counts as empty. For a .gltf, .glb, .obj
  // or CityGML also the files it names, each once, for a folder all its .py files, in order of their names.
  Fingerprint& AddFile(const std::filesystem::path& path);
  // 64 digits: SHA-256 (FIPS 180-4), which holds against whoever wants two inputs mistaken for each other. Call it
  // last.
  std::string Hex();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// SHA-256 of bytes and of a file alone, as sha256sum prints it. Errors: as for ReadFile.
std::string Sha256(std::string_view bytes);
Error Sha256OfFile(const std::filesystem::path& path, std::string* hex);

}  // namespace flaneur
