// A steady step of the crowd allocates nothing: operator new is counted in this program.
#include <gtest/gtest.h>

#include "tests/unit/allocations.h"
#include "tests/unit/runtime/crowd/open_field.h"

namespace flaneur {
namespace {

TEST(Crowd, ASteadyStepAllocatesNothing) {
  OpenField field = MakeOpenField(1000);
  for (int f : field.fields) BuildField(field.walkable, f, &field.crowd);
  const auto mixed_views = [&] {  // people come into view and go out of it
    for (size_t i = 0; i < field.crowd.size(); ++i) {
      field.crowd.view[i] = field.crowd.position[i].x < 30 ? ViewClass::kVisible : ViewClass::kOutside;
    }
  };
  for (int step = 0; step < 300; ++step) StepOpenField(&field);
  const long before = allocations;
  for (int step = 0; step < 300; ++step) StepOpenField(&field);
  EXPECT_EQ(allocations - before, 0);
  for (int step = 0; step < 300; ++step) mixed_views(), StepOpenField(&field);
  EXPECT_EQ(allocations - before, 0);
  std::printf("allocations in 600 steady steps: %ld\n", allocations - before);
}

}  // namespace
}  // namespace flaneur
