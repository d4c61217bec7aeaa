#include "pipeline/io/gltf_number.h"

#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <limits>

namespace flaneur {
namespace {

using tinygltf::Value;

TEST(GltfNumber, WhatIsNoIndexIsNone) {
  EXPECT_EQ(IndexOf(Value(7)), 7);
  EXPECT_EQ(IndexOf(Value(7.0)), 7);
  for (const double none : {-1.0, 1e308, 4e9, -1e308, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(IndexOf(Value(none)), -1) << none;
  EXPECT_EQ(IndexOf(Value(std::string("7"))), -1);
  EXPECT_EQ(IndexOf(Value()), -1);
}

}  // namespace
}  // namespace flaneur
