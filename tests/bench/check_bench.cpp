// How long all checks of 2,600 obstacles take: without a town, as a designer checks a map. With FLANEUR_SHARED_DIR set,
// also the old town of Krems three times side by side.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "pipeline/footprint/check.h"
#include "pipeline/io/geojson.h"

namespace flaneur {
namespace {

struct Plan {
  Footprints footprints;
  CheckOptions options;
};

// Blocks of ten houses that adjoin, some set back, with streets between; every fourth house has a yard.
Plan MadeUpTown(int houses) {
  Plan plan;
  std::mt19937 random(3);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  const int across = 16;
  for (int i = 0; i < houses; ++i) {
    const int block = i / 10, row = i % 10 / 5, place = i % 5;
    const double x = 66.0 * (block % across) + 12.0 * place, y = 40.0 * (block / across) + (row ? 14 : 0);
    const double front = uniform(0, 1.5), depth = uniform(9, 12);
    Obstacle o;
    o.name = "house_" + std::to_string(i);
    const double low = row ? y : y + front, high = row ? y + depth : y + depth - 1;
    o.outer = {{x, low}, {x + 4, low}, {x + 4, low + 0.8}, {x + 12, low + 0.8}, {x + 12, high}, {x, high}};
    if (i % 4 == 0) o.holes = {{{x + 5, low + 3}, {x + 5, low + 6}, {x + 9, low + 6}, {x + 9, low + 3}}};
    plan.footprints.obstacles.push_back(std::move(o));
  }
  plan.options.open_rings.resize(plan.footprints.obstacles.size());
  return plan;
}

Plan KremsThrice(const std::filesystem::path& path) {
  GeoJsonFile file;
  if (Error error = ReadGeoJson(path, {}, &file)) return {};
  Plan plan;
  for (int i = 0; i < 3; ++i) {
    const double move = 2500.0 * i;
    for (size_t k = 0; k < file.footprints.obstacles.size(); ++k) {
      Obstacle o = file.footprints.obstacles[k];
      o.name += "_" + std::to_string(i);
      for (Point2& p : o.outer) p.x += move;
      for (auto& hole : o.holes)
        for (Point2& p : hole) p.x += move;
      plan.footprints.obstacles.push_back(std::move(o));
      plan.options.open_rings.push_back(file.open_rings[k]);
    }
    for (const Way& way : file.ways) {
      Centreline street{way.name, way.points};
      for (Point2& p : street.points_m) p.x += move;
      plan.options.streets.push_back(std::move(street));
    }
  }
  return plan;
}

void RunChecks(benchmark::State& state, const Plan& plan) {
  std::vector<Finding> findings;
  for (auto _ : state) {
    if (Error error = Check(plan.footprints, nullptr, plan.options, &findings))
      state.SkipWithError(error.message.c_str());
  }
  state.counters["obstacles"] = static_cast<double>(plan.footprints.obstacles.size());
  state.counters["findings"] = static_cast<double>(findings.size());
}

void CheckMadeUpTown(benchmark::State& state) { RunChecks(state, MadeUpTown(2600)); }
BENCHMARK(CheckMadeUpTown)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void CheckKremsThrice(benchmark::State& state) {
  const char* shared = std::getenv("FLANEUR_SHARED_DIR");
  const std::filesystem::path path = std::filesystem::path(shared ? shared : "") / "data/footprints/krems_old.geojson";
  if (!std::filesystem::exists(path)) return state.SkipWithError("set FLANEUR_SHARED_DIR");
  RunChecks(state, KremsThrice(path));
}
BENCHMARK(CheckKremsThrice)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace flaneur
