#include "pipeline/core/report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "runtime/base/file.h"

namespace flaneur {
namespace {

using Json = nlohmann::ordered_json;

// To three decimals; whole numbers without a point.
Json Rounded(double value) {
  const double rounded = std::round(value * 1000) / 1000;
  if (rounded == std::floor(rounded) && std::abs(rounded) < 1e15) return static_cast<int64_t>(rounded);
  return rounded;
}

Json LevelJson(const AvatarLevel& level) {
  return {{"triangles", level.triangles},
          {"error_mm", Rounded(static_cast<double>(level.error_mm))},
          {"posed_error_mm", Rounded(static_cast<double>(level.posed_error_mm))},
          {"switch_px", Rounded(static_cast<double>(level.switch_px))},
          {"joints", level.joints}};
}

Json StageJson(const StageReport& stage) {
  Json json{{"stage", stage.stage},
            {"item", stage.item},
            {"seconds", Rounded(stage.seconds)},
            {"work_s", Rounded(stage.work_s)},
            {"cached", stage.cached},
            {"peak_mb", Rounded(stage.peak_mb)}};
  for (const auto& [key, value] : stage.figures) json[key] = Rounded(value);
  if (!stage.levels.empty()) {
    json["levels"] = Json::array();
    for (const AvatarLevel& level : stage.levels) json["levels"].push_back(LevelJson(level));
  }
  return json;
}

}  // namespace

Error WriteReport(const std::filesystem::path& folder, const BakeReport& report) {
  Json json{{"version", 1}, {"tour", report.tour}};
  json["stages"] = Json::array();
  for (const StageReport& stage : report.stages) json["stages"].push_back(StageJson(stage));
  json["pack"] = {{"path", report.pack_path}, {"bytes", report.pack_bytes}};
  json["warnings"] = report.warnings;
  if (Error e = WriteTextFile(folder / "report.html", ReportHtml(report))) return e;
  return WriteTextFile(folder / "report.json", json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace flaneur
