// For libFuzzer: the first byte tells the kind of file. Start it in a folder with seeds: fuzz_inputs CORPUS
// -max_len=20000
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "tests/fuzz/try_input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size < 1) return 0;
  static const char* const kKinds[] = {"gml", "city.json", "obj", "glb", "gltf", "geojson"};
  const std::string kind = kKinds[data[0] % std::size(kKinds)];
  static const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("flaneur_fuzz_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const std::filesystem::path path = folder / ("input." + kind);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data) + 1, static_cast<std::streamsize>(size) - 1);
  const std::string fault = kind == "geojson" ? flaneur::fuzz::TryObstacles(path) : flaneur::fuzz::TryTown(path);
  if (!fault.empty()) {
    std::fprintf(stderr, "%s\n", fault.c_str());
    std::abort();
  }
  return 0;
}
