#include "runtime/pack/byte_ranges.h"

#include <algorithm>
#include <iterator>

namespace flaneur {

void ByteRanges::Add(ByteRange range) {
  if (range.bytes == 0) return;
  size_t begin = range.offset, end = range.offset + range.bytes;
  auto next = ends_.upper_bound(begin);
  if (next != ends_.begin() && std::prev(next)->second >= begin) --next;
  for (; next != ends_.end() && next->first <= end; next = ends_.erase(next)) {
    begin = std::min(begin, next->first);
    end = std::max(end, next->second);
  }
  ends_[begin] = end;
}

bool ByteRanges::Holds(ByteRange range) const { return HeldFrom(range.offset) >= range.bytes; }

size_t ByteRanges::HeldFrom(size_t offset) const {
  const auto next = ends_.upper_bound(offset);
  if (next == ends_.begin() || std::prev(next)->second <= offset) return 0;
  return std::prev(next)->second - offset;
}

}  // namespace flaneur
