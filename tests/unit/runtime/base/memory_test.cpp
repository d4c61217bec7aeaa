#include "runtime/base/memory.h"

#include <gtest/gtest.h>

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>

namespace flaneur {
namespace {

TEST(Memory, LargeBlocksGoBackToTheSystemAtOnce) {
  KeepNoLargeStock();
  const size_t before = mallinfo2().hblks;
  void* volatile large = std::malloc(300 * 1024);  // volatile: else compilers do without
  EXPECT_EQ(mallinfo2().hblks, before + 1) << "a mapping of its own";
  std::free(large);
  EXPECT_EQ(mallinfo2().hblks, before);
}

}  // namespace
}  // namespace flaneur
#endif
