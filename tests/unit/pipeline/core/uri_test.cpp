#include "pipeline/core/uri.h"

#include <gtest/gtest.h>

namespace flaneur {
namespace {

TEST(DecodedUri, TakesTwoHexadecimalDigitsAndNothingElse) {
  EXPECT_EQ(DecodedUri("a%20b%2Fc%c3%A9.bin"), "a b/c\xC3\xA9.bin");
  EXPECT_EQ(DecodedUri("100%"), "100%");
  EXPECT_EQ(DecodedUri("%4"), "%4");
  EXPECT_EQ(DecodedUri("%+f%-1% 1%x1%g0"), "%+f%-1% 1%x1%g0");
  EXPECT_EQ(DecodedUri("%2541"), "%41") << "once alone";
  EXPECT_EQ(DecodedUri(""), "");
}

}  // namespace
}  // namespace flaneur
