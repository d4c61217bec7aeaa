// One format for libFuzzer, which looks for inputs that reach new code; fuzz.sh starts it.
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <random>

#include "tests/fuzz/mutator.h"
#include "tests/fuzz/targets.h"

namespace {

const flaneur::fuzz::Target& ThisTarget() {
  static const flaneur::fuzz::Target* const target = flaneur::fuzz::TargetNamed(FLANEUR_FUZZ_TARGET);
  return *target;
}

}  // namespace

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

// Every other change keeps the structure.
extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned int seed) {
  using flaneur::fuzz::Material, flaneur::fuzz::Mutator;
  static const Material material = MaterialOf(ThisTarget(), FLANEUR_SOURCE_DIR);
  if (seed % 2 == 0 || material.seeds.empty()) return LLVMFuzzerMutate(data, size, max_size);
  const std::string changed = Mutator(ThisTarget(), material, seed).Changed({reinterpret_cast<char*>(data), size});
  const size_t bytes = std::min(changed.size(), max_size);
  std::memcpy(data, changed.data(), bytes);
  return bytes;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("flaneur_fuzz_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const std::filesystem::path path = folder / (std::string("input.") + ThisTarget().extension);
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  const std::string fault = ThisTarget().attempt(path, {data, size});
  if (fault.empty()) return 0;
  std::fprintf(stderr, "%s\n", fault.c_str());
  std::abort();
}
