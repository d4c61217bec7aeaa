// Which bytes of a file are there, while it arrives piece by piece.
#pragma once
#include <cstddef>
#include <map>
#include <vector>

namespace flaneur {

struct ByteRange {
  size_t offset = 0, bytes = 0;
  bool operator==(const ByteRange&) const = default;
};

class ByteRanges {
 public:
  void Add(ByteRange range);
  bool Holds(ByteRange range) const;
  size_t HeldFrom(size_t offset) const;  // how many bytes from there on, without a gap

 private:
  std::map<size_t, size_t> ends_;  // by beginning; neither overlapping nor touching
};

}  // namespace flaneur
