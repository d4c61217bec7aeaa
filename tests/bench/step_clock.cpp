// step_clock [PEOPLE]: milliseconds by the clock of a crowd's step on the open field, the median of many. The same
// source natively and as a page's code, whose clock of the processor's time ticks once a millisecond, so that the two
// can be compared in one run on an idle machine.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "runtime/base/clock.h"
#include "runtime/crowd/constants.h"
#include "tests/unit/runtime/crowd/open_field.h"

namespace flaneur {
namespace {

double Step_ms(OpenField* field) {
  const double begin_ms = Now_ms();
  if (field->crowd.step % kSortEvery_steps == 0) SortBySpace(&field->scratch, &field->crowd);
  StepOpenField(field);
  return Now_ms() - begin_ms;
}

// A call that cannot become a part of main: browsers make code fast that is called again, and main is called once.
double (*volatile step_ms)(OpenField*) = Step_ms;

}  // namespace
}  // namespace flaneur

int main(int count, char** arguments) {
  using namespace flaneur;
  constexpr int kWarmUp_steps = 90, kSteps = 150;
  OpenField field = MakeOpenField(count > 1 ? std::atoi(arguments[1]) : 10000, 8);
  for (int f : field.fields) BuildField(field.walkable, f, &field.crowd);
  std::vector<double> took_ms;
  for (int i = 0; i < kWarmUp_steps + kSteps; ++i) {
    const double took = step_ms(&field);
    if (i >= kWarmUp_steps) took_ms.push_back(took);
  }
  std::sort(took_ms.begin(), took_ms.end());
  std::printf("%.3f\n", took_ms[took_ms.size() / 2]);
  return 0;
}
