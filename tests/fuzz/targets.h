// The formats that come from outside, each with what reads it: for mutations_test.cpp, fuzz_formats and libFuzzer.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace flaneur::fuzz {

// What a format is made of, as far as changing it in a sensible way needs it.
enum class Structure { kBytes, kText, kJson, kGlb };

struct Target {
  const char* name;       // of its seeds in tests/data/fuzz/NAME, and of its dictionary
  const char* extension;  // its readers tell formats by it
  Structure structure;
  std::array<const char*, 3> seeds;  // under the source folder, besides those in tests/data/fuzz/NAME; null: none
  // Reads a file, and goes on with what came of it. Returns which promise was broken, or nothing: a refusal must be one
  // line, what is taken must be sound. Crashes, time and memory are for the caller to see.
  std::string (*attempt)(const std::filesystem::path& file, std::span<const uint8_t> bytes);
};

std::span<const Target> Targets();
const Target* TargetNamed(const std::string& name);  // null: there is none

}  // namespace flaneur::fuzz
