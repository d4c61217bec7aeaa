// step_clock [PEOPLE]: milliseconds of processor time of a crowd's step on the open field, the median of many. The same
// source natively and as a page's code, so that the two can be compared in one run.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

#include "runtime/crowd/constants.h"
#include "tests/unit/runtime/crowd/open_field.h"

int main(int count, char** arguments) {
  using namespace flaneur;
  constexpr int kWarmUp_steps = 90, kSteps = 150;
  OpenField field = MakeOpenField(count > 1 ? std::atoi(arguments[1]) : 10000, 8);
  for (int f : field.fields) BuildField(field.walkable, f, &field.crowd);
  std::vector<double> took_ms;
  for (int i = 0; i < kWarmUp_steps + kSteps; ++i) {
    const std::clock_t begin = std::clock();
    if (field.crowd.step % kSortEvery_steps == 0) SortBySpace(&field.scratch, &field.crowd);
    StepOpenField(&field);
    if (i >= kWarmUp_steps) took_ms.push_back(1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  std::sort(took_ms.begin(), took_ms.end());
  std::printf("%.3f\n", took_ms[took_ms.size() / 2]);
  return 0;
}
