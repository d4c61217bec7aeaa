#include "runtime/pack/byte_ranges.h"

#include <gtest/gtest.h>

namespace flaneur {
namespace {

TEST(ByteRanges, HoldWhatHasBeenAddedInAnyOrder) {
  ByteRanges there;
  there.Add({10, 5});
  there.Add({20, 5});
  EXPECT_TRUE(there.Holds({11, 4}));
  EXPECT_FALSE(there.Holds({11, 5}));
  EXPECT_FALSE(there.Holds({10, 15}));
  there.Add({14, 7});
  EXPECT_TRUE(there.Holds({10, 15}));
  EXPECT_EQ(there.HeldFrom(12), 13u);
  EXPECT_EQ(there.HeldFrom(9), 0u);
  EXPECT_EQ(there.HeldFrom(25), 0u);
}

TEST(ByteRanges, PartsThatTouchAreOne) {
  ByteRanges there;
  for (size_t at : {size_t{30}, size_t{0}, size_t{20}, size_t{10}}) there.Add({at, 10});
  EXPECT_TRUE(there.Holds({0, 40}));
  EXPECT_TRUE(there.Holds({100, 0}));
}

}  // namespace
}  // namespace flaneur
