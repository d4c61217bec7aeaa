#include "tests/fuzz/try_input.h"

#include <algorithm>
#include <cmath>

#include "pipeline/footprint/check.h"
#include "pipeline/footprint/extract_footprints.h"
#include "pipeline/io/geojson.h"
#include "pipeline/io/scene_reader.h"

namespace flaneur::fuzz {
namespace {

bool IsOneLine(const std::string& text) {
  return !text.empty() && std::none_of(text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; });
}

std::string Refused(const Error& error, const std::filesystem::path& path, bool names_file) {
  if (!IsOneLine(error.message)) return "not one line: " + error.message;
  if (names_file && error.message.find(path.filename().string()) == std::string::npos)
    return "names no file: " + error.message;
  return {};
}

std::string Unsound(const Scene& scene) {
  for (const SceneNode& node : scene.nodes) {
    if (node.parent >= static_cast<int>(scene.nodes.size())) return "a parent that is none";
    for (const int mesh : node.meshes)
      if (mesh < 0 || mesh >= static_cast<int>(scene.meshes.size())) return "a mesh that is none";
  }
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.indices.size() % 3 != 0) return "corners that make no triangles";
    for (const uint32_t i : mesh.indices)
      if (i >= mesh.positions.size()) return "a vertex that is none";
    for (const Vec3& p : mesh.positions)
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return "a position that is not finite";
  }
  return {};
}

std::string Unsound(const Footprints& footprints) {
  const auto finite = [](Point2 p) { return std::isfinite(p.x) && std::isfinite(p.y); };
  for (const Obstacle& o : footprints.obstacles) {
    if (o.outer.empty() ? !(o.radius_m > 0) : o.outer.size() < 3) return "an obstacle without an area";
    if (!std::all_of(o.outer.begin(), o.outer.end(), finite) || !finite(o.center))
      return "an obstacle that is not finite";
  }
  return {};
}

}  // namespace

std::string TryTown(const std::filesystem::path& path) {
  Scene scene;
  std::vector<std::string> warnings;
  if (const Error error = ReadScene(path, &scene, &warnings)) return Refused(error, path, true);
  for (const std::string& warning : warnings)
    if (!IsOneLine(warning)) return "a warning is not one line: " + warning;
  if (std::string fault = Unsound(scene); !fault.empty()) return fault;
  Footprints footprints;
  if (const Error error = ExtractFootprints(scene, {}, &footprints)) return Refused(error, path, false);
  return Unsound(footprints);
}

std::string TryObstacles(const std::filesystem::path& path) {
  GeoJsonFile file;
  if (const Error error = ReadGeoJson(path, {}, &file)) return Refused(error, path, true);
  CheckOptions options;
  options.open_rings = file.open_rings;
  for (const Way& way : file.ways) options.streets.push_back({way.name, way.points});
  std::vector<Finding> findings;
  if (const Error error = Check(file.footprints, nullptr, options, &findings)) return Refused(error, path, false);
  for (const Finding& f : findings)
    if (!IsOneLine(f.message)) return "a finding is not one line: " + f.message;
  return {};
}

}  // namespace flaneur::fuzz
