// Small files of every format, changed at random, the same on every run.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

#include "tests/fuzz/try_input.h"

namespace flaneur::fuzz {
namespace {

constexpr int kChanged = 300;  // of each file

std::string Bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Mutator {
 public:
  explicit Mutator(uint32_t seed) : random_(seed) {}

  std::string Changed(std::string text) {
    for (size_t i = 0, count = 1 + Below(4); i < count && !text.empty(); ++i) ChangeOnce(&text);
    return text;
  }

 private:
  size_t Below(size_t n) { return random_() % n; }

  void ChangeOnce(std::string* text) {
    const size_t at = Below(text->size()), length = std::min(1 + Below(60), text->size() - at);
    switch (Below(7)) {
      case 0:
        (*text)[at] = static_cast<char>((*text)[at] ^ (1 << Below(8)));
        break;
      case 1:
        (*text)[at] = static_cast<char>(Below(256));
        break;
      case 2:
        text->erase(at, length);
        break;
      case 3:
        text->insert(Below(text->size()), text->substr(at, length));
        break;
      case 4:
        text->resize(at);
        break;
      default:
        ReplaceNumber(at, text);
        break;
    }
  }

  // The next number by one that is hard to bear.
  void ReplaceNumber(size_t from, std::string* text) {
    static const char* const kNumbers[] = {
        "0",      "-1",     "1e308", "1e-308", "NaN", "-1e9", "4294967295", "2147483648", "99999999999999999999",
        "0.0001", "100000", "null",  "\"a\"",  "[]"};
    const size_t begin = text->find_first_of("0123456789", from);
    if (begin == std::string::npos) return;
    const size_t end = std::min(text->find_first_not_of("0123456789.eE+-", begin), text->size());
    text->replace(begin, end - begin, kNumbers[Below(std::size(kNumbers))]);
  }

  std::mt19937 random_;
};

class ChangedFile : public testing::TestWithParam<const char*> {};

TEST_P(ChangedFile, IsRefusedInOneLineOrTakenSoundly) {
  const std::filesystem::path seed = std::filesystem::path(FLANEUR_SOURCE_DIR) / "tests/data" / GetParam();
  const bool town = seed.parent_path().filename() == "towns" || seed.extension() == ".gltf";
  const auto attempt = town ? TryTown : TryObstacles;
  ASSERT_EQ(attempt(seed), "") << "as it is";
  const std::string whole = Bytes(seed);
  const std::filesystem::path changed = std::filesystem::path(testing::TempDir()) /
                                        ("changed_" + std::to_string(getpid()) + "_" + seed.filename().string());
  Mutator mutator(17);
  for (int i = 0; i < kChanged; ++i) {
    std::ofstream(changed, std::ios::binary | std::ios::trunc) << mutator.Changed(whole);
    ASSERT_EQ(attempt(changed), "") << "change " << i << " of " << GetParam();
  }
  std::filesystem::remove(changed);
}

std::string NameOf(const testing::TestParamInfo<const char*>& info) {
  std::string name = info.param;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, ChangedFile,
                         testing::Values("towns/houses.gml", "towns/houses.city.json", "towns/houses.city.jsonl",
                                         "towns/houses.obj", "towns/houses.ply", "towns/houses.stl", "towns/street.glb",
                                         "check/601.gltf", "towns/instances.gltf", "check/sound.geojson",
                                         "check/203.geojson", "check/504.geojson"),
                         NameOf);

}  // namespace
}  // namespace flaneur::fuzz
