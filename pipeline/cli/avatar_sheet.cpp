#include "pipeline/cli/avatar_sheet.h"

#include <algorithm>
#include <cstdio>

#include "pipeline/avatar/atlas_picture.h"
#include "pipeline/avatar/figure_picture.h"
#include "pipeline/rig/motion_quality.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr int kRow_px = 200, kLevel_px = 240;
constexpr int kPhases = 6;

std::string Escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') out += "&amp;";
    else if (c == '<') out += "&lt;";
    else if (c == '"') out += "&quot;";
    else out += c;
  }
  return out;
}

std::string Number(const char* format, float value) {
  char text[48];
  std::snprintf(text, sizeof text, format, static_cast<double>(value));
  return text;
}

std::string Figures(const Avatar& avatar) {
  std::string text = Number("%.2f m high, ", avatar.height_m) + std::to_string(avatar.joints.size()) +
                     " joints, walks at " + Number("%.2f m/s", avatar.walk_speed_mps);
  if (const Clip* walk = FindClip(avatar, "walk")) {
    text += Number(", soles slide by %.0f %% of it", 100 * FootSlide(avatar, *walk, avatar.walk_speed_mps));
  }
  return text;
}

}  // namespace

std::vector<uint8_t> AvatarSheet(const AvatarLevels& levels) {
  const Avatar& avatar = levels.avatar;
  std::vector<Pixels> rows;
  const Clip* walk = FindClip(avatar, "walk");
  Pixels level_row;
  for (const AvatarLevel& level : levels.levels) {
    std::vector<FigureView> views;
    for (const float yaw_deg : {20.0f, 200.0f}) {
      views.push_back(
          {walk != nullptr ? SkinningMatrices(avatar, *walk, 0) : std::vector<Mat4>(avatar.joints.size()), yaw_deg});
    }
    const Pixels drawn = DrawFigures(level.meshes, avatar, views, avatar.height_m, kLevel_px);
    if (level_row.width == 0) level_row = drawn;
    else level_row = Beside(level_row, drawn);
  }
  rows.push_back(std::move(level_row));
  for (const Clip& clip : avatar.clips) {
    std::vector<Mesh> meshes = avatar.meshes;
    rows.push_back(DrawFigures(meshes, avatar, ViewsOfClip(avatar, clip, kPhases), avatar.height_m, kRow_px));
  }
  return Encoded(Stacked(rows), true).bytes;
}

std::string SheetPage(const std::vector<SheetEntry>& entries) {
  std::string page =
      "<!doctype html><meta charset=utf-8><title>People</title><style>body{font:16px "
      "sans-serif;margin:2em;max-width:90em}"
      "img{max-width:100%;border:1px solid #ccc}.warning{color:#850}.error{color:#a00}</style><h1>People</h1>\n";
  for (const SheetEntry& entry : entries) {
    page += "<h2>" + Escaped(entry.input.filename().string()) + "</h2>\n";
    for (const std::string& warning : entry.warnings) page += "<p class=warning>" + Escaped(warning) + "</p>\n";
    if (!entry.error.empty()) {
      page += "<p class=error>" + Escaped(entry.error) + "</p>\n";
      continue;
    }
    page += "<p>" + Escaped(Figures(entry.avatar)) + ": <a href=\"" + Escaped(entry.output.filename().string()) +
            "\">" + Escaped(entry.output.filename().string()) + "</a></p>\n<p>Levels, then";
    for (const Clip& clip : entry.avatar.clips) page += " " + Escaped(clip.name);
    page += ":</p>\n<img src=\"" + Escaped(entry.picture.filename().string()) + "\" alt=\"levels and clips\">\n";
  }
  return page;
}

}  // namespace flaneur
