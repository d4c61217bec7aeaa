// What a pack may still ask for while it is opened. Everything that a few of its bytes could make large is taken from
// here before it is allocated or begun. Internal to runtime/pack.
#pragma once
#include <cstdint>
#include <string>

#include "runtime/base/limits.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {

class Allowance {
 public:
  Allowance(uint64_t file_bytes, const PackLimits& limits);

  // Each throws PackRefused where there is not so much left; `what` asks for it.
  void TakeMemory(uint64_t bytes, const std::string& what);
  // Units of about ten nanoseconds.
  void TakeWork(uint64_t units, const std::string& what);
  // A picture that is decoded and becomes a square of a power of two.
  void TakePicture(int width_px, int height_px, const std::string& what);

 private:
  PackLimits limits_;
  uint64_t memory_left_, pictures_left_, work_left_, pixels_left_;
};

// The largest number there is where the product is larger.
uint64_t Product(uint64_t a, uint64_t b);

}  // namespace flaneur
