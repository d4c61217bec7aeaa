// Our own obstacles against our own check, in coordinate systems at random: a small made-up town somewhere in each
// system's area is extracted, written in local metres and in longitude and latitude, read again, and checked alone and
// against its town. Prints how many systems gave findings that the model has not (301 to 305, 401, 402, 9xx), and
// which. bench_own_output [SYSTEMS] [SEED]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "pipeline/cli/georeference.h"
#include "pipeline/cli/place_obstacles.h"
#include "pipeline/core/temporary_folder.h"
#include "pipeline/footprint/extract_footprints.h"
#include "pipeline/io/map_projection.h"
#include "pipeline/io/scene_reader.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Random = std::mt19937;

double Uniform(Random* random, double low, double high) {
  return low + (high - low) * (static_cast<double>((*random)()) / 4294967296.0);
}

// Houses askew in metres round (0, 0), some against each other, one with a yard.
struct House {
  std::vector<Point2> plan;
  double height_m;
};
std::vector<House> MadeUpTown(Random* random) {
  std::vector<House> houses;
  const double turn = Uniform(random, 0, 1.5);
  const int count = 6 + static_cast<int>((*random)() % 10);
  for (int i = 0; i < count; ++i) {
    const double x = 25.0 * (i % 4), y = 25.0 * (i / 4), w = Uniform(random, 6, 15), d = Uniform(random, 6, 15);
    std::vector<Point2> plan{{x, y}, {x + w, y}, {x + w, y + d}, {x, y + d}};
    if (i % 3 == 0)
      plan = {{x, y}, {x + w, y}, {x + w, y + d}, {x + w / 2, y + d}, {x + w / 2, y + d / 2}, {x, y + d / 2}};
    std::vector<std::vector<Point2>> plans{plan};
    if (i % 4 == 1) plans.push_back({{x + w, y}, {x + w + 5, y}, {x + w + 5, y + d}, {x + w, y + d}});
    for (std::vector<Point2>& p : plans) {
      for (Point2& q : p)
        q = {q.x * std::cos(turn) - q.y * std::sin(turn), q.x * std::sin(turn) + q.y * std::cos(turn)};
      houses.push_back({p, Uniform(random, 3, 12)});
    }
  }
  return houses;
}

// As CityJSON in this system; false where it has no image there.
bool WriteTown(const fs::path& path, const std::vector<House>& houses, Point2 place, const std::string& system) {
  Json vertices = Json::array(), objects = Json::object();
  std::vector<Point2> points;
  for (const House& house : houses) points.insert(points.end(), house.plan.begin(), house.plan.end());
  if (TransformPoints(LocalMapSystem(place), system, &points)) return false;
  size_t next = 0;
  for (size_t h = 0; h < houses.size(); ++h) {
    const size_t n = houses[h].plan.size(), first = vertices.size();
    for (int level = 0; level < 2; ++level) {
      for (size_t i = 0; i < n; ++i) {
        const Point2 p = points[next + i];
        if (!std::isfinite(p.x) || std::abs(p.x) > 9e7 || std::abs(p.y) > 9e7) return false;
        vertices.push_back({p.x, p.y, level == 0 ? 0 : houses[h].height_m});
      }
    }
    next += n;
    Json floor = Json::array(), roof = Json::array(), faces = Json::array();
    for (size_t i = 0; i < n; ++i) floor.push_back(first + n - 1 - i), roof.push_back(first + n + i);
    faces.push_back({floor}), faces.push_back({roof});
    for (size_t i = 0; i < n; ++i) {
      const size_t j = (i + 1) % n;
      faces.push_back({{first + i, first + j, first + n + j, first + n + i}});
    }
    const Json solid{{"type", "Solid"}, {"lod", "2"}, {"boundaries", Json::array({faces})}};
    objects["house_" + std::to_string(h)] = {{"type", "Building"}, {"geometry", Json::array({solid})}};
  }
  std::ofstream(path) << Json{{"type", "CityJSON"},
                              {"version", "2.0"},
                              {"vertices", vertices},
                              {"CityObjects", objects},
                              {"metadata", {{"referenceSystem", system}}}};
  return true;
}

std::string Findings(const fs::path& obstacles, const Scene* town) {
  GeoJsonFile file;
  if (Error e = ReadGeoJson(obstacles, {}, &file)) return e.message;
  CheckOptions options;
  options.threads = 1;
  PreparedTown prepared;
  bool found = true;
  std::vector<std::string> warnings;
  if (town) {
    if (Error e = PrepareTown(*town, file.footprints, options, &prepared)) return e.message;
    if (Error e = PlaceObstacles(obstacles, {}, prepared, options.tolerance_m, &file, &found, &warnings))
      return e.message;
  }
  options.open_rings = file.open_rings;
  std::vector<Finding> findings;
  if (Error e = CheckPrepared(file.footprints, town && found ? &prepared : nullptr, options, &findings))
    return e.message;
  std::map<int, int> count;
  std::string first;
  for (const Finding& f : findings) {
    const bool counts =
        (f.code >= 101 && f.code < 204) || (f.code > 300 && f.code < 306) || f.code == 401 || f.code == 402;
    if (counts && count[f.code]++ == 0 && first.empty()) first = f.message;
  }
  std::string text;
  for (const auto& [code, n] : count) text += std::to_string(code) + " x" + std::to_string(n) + " ";
  for (const GeoJsonFault& fault : file.faults) text += "fault: " + fault.message + " ";
  return text + first;
}

std::string TryIn(const std::string& system, const fs::path& folder, Point2 place, Random* random, bool* made) {
  const fs::path town_file = folder / "town.json", local = folder / "o.geojson";
  *made = WriteTown(town_file, MadeUpTown(random), place, system);
  if (!*made) return {};
  Scene town;
  std::vector<std::string> warnings;
  if (Error e = ReadScene(town_file, &town, &warnings)) return e.message;
  if (Error e = SetGeoreference({}, 1, &town, &warnings)) return e.message;
  if (town.reference_system.empty()) return "no longitude and latitude: " + (warnings.empty() ? "" : warnings[0]);
  Footprints footprints;
  FootprintOptions options;
  options.threads = 1;
  if (Error e = ExtractFootprints(town, options, &footprints)) return e.message;
  if (Error e = WriteGeoJson(local, footprints)) return e.message;
  if (Error e = WriteLongitudeLatitude(LongitudeLatitudePath(local), footprints)) return e.message;
  // As `flaneur check` reads it: without what the extraction was told.
  Scene again;
  if (Error e = ReadScene(town_file, &again, &warnings)) return e.message;
  for (const fs::path& file : {local, LongitudeLatitudePath(local)}) {
    for (const Scene* with : {static_cast<const Scene*>(nullptr), static_cast<const Scene*>(&again)}) {
      const std::string found = Findings(file, with);
      if (!found.empty()) return file.filename().string() + (with ? " with its town: " : " alone: ") + found;
    }
  }
  return {};
}

int Run(int wanted, unsigned seed) {
  Random random(seed);
  TemporaryFolder folder;
  if (Error e = folder.Create("flaneur_own_output_", fs::temp_directory_path())) return std::puts(e.message.c_str()), 1;
  int tried = 0, degrees = 0, wrong = 0;
  for (int codes = 0; tried < wanted && codes < 200 * wanted; ++codes) {
    const std::string name = "EPSG:" + std::to_string(2000 + random() % 30761);
    MapSystem system;
    if (FindMapSystem(name, &system) || !system.has_area || !system.other_unit.empty()) continue;
    const double east = system.east < system.west ? system.east + 360 : system.east;
    Point2 place{Uniform(&random, 0.1, 0.9) * (east - system.west) + system.west,
                 Uniform(&random, 0.1, 0.9) * (system.north - system.south) + system.south};
    if (place.x > 180) place.x -= 360;
    if (std::abs(place.y) > 84) continue;
    bool made = false;
    const std::string problem = TryIn(name, folder.path(), place, &random, &made);
    if (!made) continue;
    ++tried;
    degrees += system.degrees;
    wrong += !problem.empty();
    if (!problem.empty())
      std::printf("%s at %.3f east, %.3f north: %s\n", name.c_str(), place.x, place.y, problem.c_str());
  }
  std::printf("%d systems (%d of them in degrees), seed %u: in %d own output is called wrong\n", tried, degrees, seed,
              wrong);
  return wrong > 0;
}

}  // namespace
}  // namespace flaneur

int main(int argc, char** argv) {
  return flaneur::Run(argc > 1 ? std::atoi(argv[1]) : 200, argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 1);
}
