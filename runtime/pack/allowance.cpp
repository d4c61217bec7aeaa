#include "runtime/pack/allowance.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "runtime/pack/gltf_file.h"

namespace flaneur {
namespace {

constexpr uint64_t kBytesAMebibyte = 1048576;
constexpr uint64_t kMostSquareSide_px = 4096;

void Take(uint64_t amount, uint64_t* left, const std::string& refusal) {
  if (amount > *left) throw PackRefused(refusal);
  *left -= amount;
}

std::string Mebibytes(uint64_t bytes) { return std::to_string(bytes / kBytesAMebibyte) + " MiB"; }

}  // namespace

uint64_t Product(uint64_t a, uint64_t b) {
  constexpr uint64_t kMost = std::numeric_limits<uint64_t>::max();
  return b != 0 && a > kMost / b ? kMost : a * b;
}

Allowance::Allowance(uint64_t file_bytes, const PackLimits& limits)
    : limits_(limits),
      memory_left_(limits.memory_bytes),
      pictures_left_(limits.pictures_bytes),
      work_left_(kPackWork + file_bytes * kPackWorkAByte),
      pixels_left_(kFreePixels + file_bytes * kPixelsAByte) {}

void Allowance::TakeMemory(uint64_t bytes, const std::string& what) {
  Take(bytes, &memory_left_, "asks for more memory than the " + Mebibytes(limits_.memory_bytes) + " allowed: " + what);
}

void Allowance::TakeWork(uint64_t units, const std::string& what) {
  Take(units, &work_left_, "asks for far more work than its size is worth: " + what);
}

void Allowance::TakePicture(int width_px, int height_px, const std::string& what) {
  const auto width = static_cast<uint64_t>(width_px), height = static_cast<uint64_t>(height_px);
  const uint64_t side = std::min(kMostSquareSide_px, std::bit_ceil(std::max(width, height)));
  Take(width * height, &pixels_left_, "holds far more pixels than its size is worth: " + what);
  Take(4 * std::max(width * height, side * side), &pictures_left_,
       "asks for more memory for pictures than the " + Mebibytes(limits_.pictures_bytes) + " allowed: " + what);
}

}  // namespace flaneur
