#include "pipeline/footprint/for_each.h"

#include <gtest/gtest.h>

#include <new>

namespace flaneur {
namespace {

TEST(ForEach, WhatAThreadThrowsReachesTheCaller) {
  for (const int threads : {1, 4})
    EXPECT_THROW(ForEach(100, threads,
                         [](size_t i) {
                           if (i == 50) throw std::bad_alloc();
                         }),
                 std::bad_alloc)
        << threads;
}

}  // namespace
}  // namespace flaneur
