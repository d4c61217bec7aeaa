// How many points a town may have: what stands once in a file may be placed many times.
#pragma once
#include <algorithm>
#include <cstdint>

#include "runtime/base/error.h"
#include "runtime/base/limits.h"

namespace flaneur {

class TownPoints {
 public:
  explicit TownPoints(uint64_t file_bytes)
      : left_(kFreeTownPoints + kTownPointsAByte * std::min(file_bytes, kMostFile_bytes)) {}

  // To be asked before they are made. Errors: more than the file's size is worth.
  Error Take(uint64_t points) {
    if (points > left_)
      return Fail("places its parts so often that the town would be far larger than the file is worth");
    left_ -= points;
    return Ok();
  }

 private:
  uint64_t left_;
};

}  // namespace flaneur
