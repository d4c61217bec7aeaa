#include "pipeline/core/report.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "runtime/base/file.h"

namespace flaneur {
namespace {

using Json = nlohmann::ordered_json;

double Rounded(double value) { return std::round(value * 1000) / 1000; }

Json LevelJson(const AvatarLevel& level) {
  return {{"triangles", level.triangles},
          {"error_mm", Rounded(level.error_mm)},
          {"posed_error_mm", Rounded(level.posed_error_mm)},
          {"switch_px", Rounded(level.switch_px)}};
}

Json StageJson(const StageReport& stage) {
  Json json{{"stage", stage.stage},
            {"item", stage.item},
            {"seconds", Rounded(stage.seconds)},
            {"cached", stage.cached},
            {"peak_mb", Rounded(stage.peak_mb)}};
  for (const auto& [key, value] : stage.figures) json[key] = Rounded(value);
  if (!stage.levels.empty()) {
    json["levels"] = Json::array();
    for (const AvatarLevel& level : stage.levels) json["levels"].push_back(LevelJson(level));
  }
  return json;
}

std::string Escaped(const std::string& text) {
  std::string out;
  for (char c : text) {
    if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '&') out += "&amp;";
    else if (c == '"') out += "&quot;";
    else out += c;
  }
  return out;
}

std::string Format(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string StageDetails(const StageReport& stage) {
  std::string out;
  for (const AvatarLevel& level : stage.levels) {
    out += "<div>" + std::to_string(level.triangles) + " triangles, posed error " +
           Format("%.2f mm", static_cast<double>(level.posed_error_mm)) + ", needed from " +
           Format("%.0f px", static_cast<double>(level.switch_px)) + "</div>";
  }
  for (const auto& [key, value] : stage.figures) out += "<div>" + Escaped(key) + " " + Format("%.6g", value) + "</div>";
  if (!stage.picture_png.empty()) {
    out += "<a href=\"" + Escaped(stage.picture_png) + "\"><img src=\"" + Escaped(stage.picture_png) + "\" alt=\"atlas of " +
           Escaped(stage.item) + "\"></a>";
  }
  return out;
}

constexpr const char* kStyle = R"(
body{font:15px/1.45 system-ui,sans-serif;color:#2b2622;background:#f6f2ea;max-width:1100px;margin:2rem auto;padding:0 1rem}
h1{font-weight:600;margin-bottom:.2rem} h2{margin-top:2rem} .muted{color:#7a6f63}
table{border-collapse:collapse;width:100%;background:#fff} td,th{padding:.4rem .6rem;border-bottom:1px solid #e4dccf;
text-align:left;vertical-align:top} td.n{text-align:right;white-space:nowrap} img{height:120px;margin-top:.3rem;
background:#cfd8dc;object-fit:cover;object-position:0 0;width:420px} .map svg{width:100%;height:auto;background:#fff}
li{margin:.2rem 0}
)";

std::string Html(const BakeReport& report) {
  std::string out = "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>" + Escaped(report.tour) +
                    ": bake report</title><style>" + kStyle + "</style><h1>" + Escaped(report.tour) + "</h1>";
  double total_s = 0;
  for (const StageReport& stage : report.stages) total_s += stage.seconds;
  out += "<p class=\"muted\">" + Escaped(report.pack_path) + ", " +
         Format("%.1f MB", static_cast<double>(report.pack_bytes) / 1e6) + ", " + Format("%.0f s of work", total_s) + "</p>";
  if (!report.warnings.empty()) {
    out += "<h2>Warnings</h2><ul>";
    for (const std::string& warning : report.warnings) out += "<li>" + Escaped(warning) + "</li>";
    out += "</ul>";
  }
  out += "<h2>Stages</h2><table><tr><th>Stage<th>Item<th>Seconds<th>Peak MB<th>Details</tr>";
  for (const StageReport& stage : report.stages) {
    out += "<tr><td>" + Escaped(stage.stage) + "<td>" + Escaped(stage.item) + "<td class=\"n\">" +
           (stage.cached ? std::string("cached") : Format("%.1f", stage.seconds)) + "<td class=\"n\">" +
           Format("%.0f", stage.peak_mb) + "<td>" + StageDetails(stage) + "</tr>";
  }
  out += "</table>";
  if (!report.map_svg.empty()) out += "<h2>Obstacles</h2><div class=\"map\">" + report.map_svg + "</div>";
  return out + "</html>\n";
}

}  // namespace

Error WriteReport(const std::filesystem::path& folder, const BakeReport& report) {
  Json json{{"version", 1}, {"tour", report.tour}};
  json["stages"] = Json::array();
  for (const StageReport& stage : report.stages) json["stages"].push_back(StageJson(stage));
  json["pack"] = {{"path", report.pack_path}, {"bytes", report.pack_bytes}};
  json["warnings"] = report.warnings;
  if (Error e = WriteTextFile(folder / "report.json", json.dump(1) + "\n")) return e;
  return WriteTextFile(folder / "report.html", Html(report));
}

}  // namespace flaneur
