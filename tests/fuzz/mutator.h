// Files changed at random: the same seed gives the same changes.
#pragma once
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/targets.h"

namespace flaneur::fuzz {

struct Material {
  std::vector<std::string> seeds;  // files to begin with
  std::vector<std::string> words;  // that the format knows
};

// Seeds and words of a target: tests/data/fuzz/NAME and tests/fuzz/dictionaries/NAME.dict under `source`.
Material MaterialOf(const Target& target, const std::filesystem::path& source);

class Mutator {
 public:
  Mutator(const Target& target, const Material& material, uint64_t seed);
  std::string Next();  // of at most kMostInput_bytes
  // One that was given, changed.
  std::string Changed(std::string file);

  static constexpr size_t kMostInput_bytes = 1000000;

 private:
  size_t Below(size_t n) { return n == 0 ? 0 : random_() % n; }
  void ChangeBytes(std::string* text);
  void ReplaceNumber(size_t from, std::string* text);
  std::string ChangedJson(const std::string& text);
  std::string ChangedGlb(const std::string& file);

  const Target& target_;
  const Material& material_;
  std::mt19937_64 random_;
};

}  // namespace flaneur::fuzz
