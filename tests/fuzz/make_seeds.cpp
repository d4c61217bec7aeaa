// Makes the seeds of binary formats anew: make_fuzz_seeds tests/data/fuzz
#include <filesystem>

#include "pipeline/io/gltf.h"
#include "tests/unit/pipeline/pack/small_tour.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

void Write(const fs::path& path, std::span<const uint8_t> bytes) {
  if (const Error e = WriteFile(path, bytes)) std::printf("%s\n", e.message.c_str());
}

// Of the pack's first compressed view: count, stride and filter before its bytes.
void WriteMeshopt(const std::vector<uint8_t>& pack, const fs::path& folder) {
  const Json json = JsonOf(pack);
  const size_t binary = 20 + GetWord(pack, 12) + 8;
  int number = 0;
  for (const Json& view : json["bufferViews"]) {
    if (!view.contains("extensions") || number >= 3) continue;
    const Json& packed = view["extensions"]["EXT_meshopt_compression"];
    const std::string filter = packed.value("filter", "NONE");
    std::vector<uint8_t> bytes(8, 0);
    PutWord(&bytes, 0, packed["count"].get<size_t>());
    bytes[4] = packed["byteStride"].get<uint8_t>();
    bytes[5] = filter == "NONE" ? 0 : filter == "QUATERNION" ? 1 : 2;
    const auto first = pack.begin() + static_cast<std::ptrdiff_t>(binary + packed.value("byteOffset", size_t{0}));
    bytes.insert(bytes.end(), first, first + packed["byteLength"].get<std::ptrdiff_t>());
    Write(folder / ("view_" + std::to_string(number++) + ".bin"), bytes);
  }
}

void WriteAll(const fs::path& folder) {
  const std::vector<uint8_t> pack = Written(SmallTour());
  Write(folder / "pack/small.glb", pack);
  WriteMeshopt(pack, folder / "meshopt");
  Write(folder / "ktx2/bc7.ktx2", Ktx2(TextureFormat::kBc7Srgb, 32, 64));
  Write(folder / "ktx2/bc5.ktx2", Ktx2(TextureFormat::kBc5, 16, 16));
  Write(folder / "ktx2/bc4.ktx2", Ktx2(TextureFormat::kBc4, 16, 8));
  const std::vector<uint8_t> pixels(size_t{12} * 9 * 3, 90);
  Write(folder / "picture/small.png", EncodePng(12, 9, 3, pixels));
  Write(folder / "picture/small.jpg", EncodeJpeg(12, 9, 80, pixels));
  if (const Error e = WriteAvatarGlb(folder / "model/person.glb", TwoLevels())) std::printf("%s\n", e.message.c_str());
}

}  // namespace
}  // namespace flaneur

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  flaneur::WriteAll(argv[1]);
  return 0;
}
