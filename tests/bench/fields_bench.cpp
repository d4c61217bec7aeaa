// Flow fields that are built beside the steps: how long a step stands still for them, at once, in slices without
// threads and with threads. FLANEUR_PACK names the tour pack.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <thread>
#include <vector>

#include "runtime/base/clock.h"
#include "runtime/crowd/constants.h"
#include "runtime/crowd/field_builder.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {
namespace {

constexpr size_t kGoals = 12;
constexpr double kStep_ms = 1000.0 / 30;

// The thread's own: other work on the machine disturbs it least.
double ThreadTime_ms() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

void Print(const char* how, std::vector<double> took_ms, const char* of) {
  std::sort(took_ms.begin(), took_ms.end());
  std::printf("%-10s median %6.2f, worst %6.2f ms %s\n", how, took_ms[took_ms.size() / 2], took_ms.back(), of);
}

std::vector<Vec2> Goals(const TourPack& pack, const Walkable& w) {
  std::vector<Vec2> goals;
  const size_t every = std::max<size_t>(1, pack.places.size() / kGoals);
  for (size_t k = 0; k < pack.places.size(); k += every) {
    if (const int cell = NearestFreeCell(w, pack.places[k].position_m, 3); cell >= 0)
      goals.push_back(CellCenter(w, cell));
  }
  return goals;
}

void TimeWhole(const Walkable& w, const std::vector<Vec2>& goals) {
  std::vector<double> took_ms;
  for (Vec2 goal : goals) {
    const double start_ms = ThreadTime_ms();
    BuildFlowField(w, goal);
    took_ms.push_back(ThreadTime_ms() - start_ms);
  }
  Print("at once", std::move(took_ms), "of processor time a field");
}

// All goals are asked for at once. With threads the steps are as far apart as in a tour, and what they wait is
// measured.
void TimeSteps(const Walkable& w, const std::vector<Vec2>& goals, size_t threads) {
  Jobs jobs(threads);
  const auto clock_ms = threads > 0 ? Now_ms : ThreadTime_ms;
  Crowd crowd;
  for (Vec2 goal : goals) crowd.asked_fields.push_back(FieldFor(goal, &crowd));
  FieldBuilder builder;
  std::vector<double> took_ms;
  while (!std::all_of(crowd.fields.begin(), crowd.fields.end(), IsBuilt)) {
    const double step_start_ms = Now_ms(), start_ms = clock_ms();
    builder.Step(w, &jobs, &crowd);
    took_ms.push_back(clock_ms() - start_ms);
    if (threads > 0)
      std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(kStep_ms - (Now_ms() - step_start_ms)));
    ++crowd.step;
  }
  Print((std::to_string(threads) + " threads").c_str(), std::move(took_ms),
        threads > 0 ? "a step" : "of processor time a step");
}

int Run() {
  const char* path = std::getenv("FLANEUR_PACK");
  TourPack pack;
  if (path == nullptr || LoadTourPack(path, {.geometry_and_images = false}, &pack)) {
    std::fprintf(stderr, "FLANEUR_PACK names no tour pack\n");
    return 2;
  }
  Walkable w;
  w.ground = pack.ground;
  static_cast<Obstacles&>(w) = pack.obstacles;
  BuildWalkable(0.3f, &w);
  const std::vector<Vec2> goals = Goals(pack, w);
  if (goals.empty()) return std::fprintf(stderr, "this tour has no places to go to\n"), 2;
  const auto free = std::count_if(w.cost.begin(), w.cost.end(), [](float cost) { return cost > 0; });
  std::printf("%zu cells, of which %lld are free; a field takes %lld steps\n", w.cost.size(),
              static_cast<long long>(free),
              1 + static_cast<long long>(w.cost.size()) / static_cast<long long>(kCellsAStep));
  TimeWhole(w, goals);
  for (size_t threads : {0, 1, 2}) TimeSteps(w, goals, threads);
  return 0;
}

}  // namespace
}  // namespace flaneur

int main() { return flaneur::Run(); }
