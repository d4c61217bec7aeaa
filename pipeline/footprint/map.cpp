#include "pipeline/footprint/map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "runtime/base/file.h"

namespace flaneur {
namespace {

constexpr double kPlanWidth = 1200;     // of the town in the picture, pixels
constexpr double kMargin = 40;
constexpr double kListWidth = 460;
constexpr double kLineHeight = 17;
constexpr size_t kMostListed = 60;
constexpr int kMostGroundColumns = 1600;

const char* Fill(ObstacleKind kind) {
  switch (kind) {
    case ObstacleKind::kBuilding: return "#8c5a4a";
    case ObstacleKind::kWall: return "#5d5a57";
    case ObstacleKind::kTree: return "#4f7a46";
    case ObstacleKind::kLamp: return "#c9962b";
    case ObstacleKind::kOther: return "#6c7f93";
  }
  return "#6c7f93";
}

// By GroundKind.
const char* GroundFill(uint8_t kind) {
  static const char* const kFills[] = {"#ffffff", "#d9d4cc", "#e9e4da", "#efe6d0", "#cfdcb8"};
  return kFills[kind < 5 ? kind : 0];
}

std::string Escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') out += "&amp;";
    else if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '"') out += "&quot;";
    else out += c;
  }
  return out;
}

std::string Format(const char* format, auto... values) {
  char text[512];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

class Plan {
 public:
  Plan(const Footprints& footprints, const MapOptions& options) : footprints_(footprints), options_(options) {
    for (const Obstacle& o : footprints.obstacles) {
      for (const Point2& p : o.outer) Grow(p, 1);
      if (o.outer.empty()) Grow(o.center, o.radius_m);
    }
    if (const GroundRaster* g = options.ground) {
      Grow({g->min_m.x, g->min_m.y}, 0);
      Grow({g->min_m.x + static_cast<double>(g->columns) * g->cell_m,
            g->min_m.y + static_cast<double>(g->rows) * g->cell_m}, 0);
    }
    if (min_.x > max_.x) min_ = {0, 0}, max_ = {10, 10};
    scale_ = kPlanWidth / std::max(max_.x - min_.x, max_.y - min_.y);
    width_ = (max_.x - min_.x) * scale_;
    height_ = (max_.y - min_.y) * scale_;
  }

  std::string Draw() {
    const size_t listed = std::min(options_.findings.size(), kMostListed);
    const double list = options_.findings.empty() ? 0 : kListWidth;
    const double all_height = std::max(height_ + 2 * kMargin + 40, (listed + 4.0) * kLineHeight + 80);
    const double all_width = width_ + 2 * kMargin + list;
    out_ = Format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" height=\"%.0f\" "
                  "font-family=\"sans-serif\" font-size=\"12\" fill=\"#2b2b2b\">\n<rect width=\"100%%\" "
                  "height=\"100%%\" fill=\"#fbfaf7\"/>\n",
                  all_width, all_height, all_width, all_height);
    out_ += Format("<text x=\"%.0f\" y=\"30\" font-size=\"20\">", kMargin) + Escaped(options_.title) + "</text>\n";
    out_ += Format("<g transform=\"translate(%.0f %.0f)\">\n", kMargin, kMargin + 10);
    DrawGround();
    for (const Obstacle& o : footprints_.obstacles) DrawObstacle(o);
    DrawMarks();
    out_ += "</g>\n";
    DrawLegend();
    DrawList();
    return out_ + "</svg>\n";
  }

 private:
  void Grow(Point2 p, double by) {
    if (!(std::abs(p.x) < 1e6 && std::abs(p.y) < 1e6) || !std::isfinite(by)) return;
    min_ = {std::min(min_.x, p.x - by), std::min(min_.y, p.y - by)};
    max_ = {std::max(max_.x, p.x + by), std::max(max_.y, p.y + by)};
  }
  double X(double x) const { return (x - min_.x) * scale_; }
  double Y(double y) const { return (max_.y - y) * scale_; }

  // Runs of one kind in a row become one rectangle; rows are thinned where cells are smaller than pixels.
  void DrawGround() {
    const GroundRaster* g = options_.ground;
    if (!g) return;
    const int step = std::max(1, std::max(g->columns, g->rows) / kMostGroundColumns + 1);
    const double size = g->cell_m * step * scale_;
    out_ += "<g shape-rendering=\"crispEdges\">\n";
    for (int row = 0; row < g->rows; row += step) {
      const auto kind = [&](int column) {
        return g->kind[static_cast<size_t>(row) * static_cast<size_t>(g->columns) + static_cast<size_t>(column)];
      };
      for (int column = 0; column < g->columns;) {
        int end = column;
        while (end < g->columns && kind(end) == kind(column)) end += step;
        if (kind(column) != 0)
          out_ += Format("<path fill=\"%s\" d=\"M%.1f %.1fh%.1fv%.1fh-%.1fz\"/>\n", GroundFill(kind(column)),
                         X(g->min_m.x + static_cast<double>(column) * g->cell_m),
                         Y(g->min_m.y + static_cast<double>(row) * g->cell_m) - size,
                         (end - column) / step * size + 0.6, size + 0.6, (end - column) / step * size + 0.6);
        column = end;
      }
    }
    out_ += "</g>\n";
  }

  std::string PathOf(const std::vector<Point2>& ring) const {
    std::string path;
    for (size_t i = 0; i < ring.size(); ++i) {
      if (!std::isfinite(ring[i].x) || !std::isfinite(ring[i].y)) return {};
      path += Format("%s%.2f %.2f", i == 0 ? "M" : "L", X(ring[i].x), Y(ring[i].y));
    }
    return path + "Z";
  }

  void DrawObstacle(const Obstacle& o) {
    const std::string title = "<title>" + Escaped(o.name) + " (" + ObstacleKindName(o.kind) + ")</title>";
    if (o.outer.empty()) {
      if (!std::isfinite(o.center.x) || !std::isfinite(o.center.y) || !(o.radius_m > 0)) return;
      out_ += Format("<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\" fill=\"%s\">", X(o.center.x), Y(o.center.y),
                     std::max(o.radius_m * scale_, 1.5), Fill(o.kind)) + title + "</circle>\n";
      return;
    }
    std::string path = PathOf(o.outer);
    for (const auto& hole : o.holes) path += PathOf(hole);
    out_ += Format("<path fill=\"%s\" fill-rule=\"evenodd\" stroke=\"#3b2620\" stroke-width=\"0.6\" d=\"", Fill(o.kind)) +
            path + "\">" + title + "</path>\n";
  }

  static const char* MarkFill(const Finding& f) { return f.severity == Severity::kError ? "#d02020" : "#e08a00"; }

  void DrawMarks() {
    for (size_t i = options_.findings.size(); i-- > 0;) {
      const Finding& f = options_.findings[i];
      if (!std::isfinite(f.at_m.x) || !std::isfinite(f.at_m.y)) continue;
      out_ += Format("<g transform=\"translate(%.1f %.1f)\"><circle r=\"7\" fill=\"%s\" fill-opacity=\"0.85\" "
                     "stroke=\"#fff\"/><text y=\"3.5\" text-anchor=\"middle\" font-size=\"8\" fill=\"#fff\">%zu</text>",
                     X(f.at_m.x), Y(f.at_m.y), MarkFill(f), i + 1) +
              "<title>" + std::to_string(f.code) + " " + Escaped(f.message) + "</title></g>\n";
    }
  }

  void DrawLegend() {
    const double y = kMargin + 10 + height_ + 24;
    double step = std::pow(10, std::floor(std::log10((max_.x - min_.x) / 4)));
    if ((max_.x - min_.x) / step > 20) step *= 5;
    out_ += Format("<path d=\"M%.1f %.1fv6h%.1fv-6\" fill=\"none\" stroke=\"#2b2b2b\"/><text x=\"%.1f\" y=\"%.1f\">%g m"
                   "</text>\n",
                   kMargin, y - 4, step * scale_, kMargin + step * scale_ + 6, y + 3, step);
    double x = kMargin + step * scale_ + 80;
    for (const ObstacleKind kind : {ObstacleKind::kBuilding, ObstacleKind::kWall, ObstacleKind::kTree,
                                    ObstacleKind::kLamp, ObstacleKind::kOther}) {
      out_ += Format("<rect x=\"%.1f\" y=\"%.1f\" width=\"12\" height=\"12\" fill=\"%s\"/><text x=\"%.1f\" y=\"%.1f\">%s"
                     "</text>\n",
                     x, y - 7, Fill(kind), x + 17, y + 3, ObstacleKindName(kind));
      x += 85;
    }
  }

  void DrawList() {
    if (options_.findings.empty()) return;
    const double x = width_ + 2 * kMargin;
    double y = kMargin + 20;
    for (size_t i = 0; i < std::min(options_.findings.size(), kMostListed); ++i) {
      const Finding& f = options_.findings[i];
      std::string text = std::to_string(f.code) + " " + f.message;
      if (text.size() > 68) text = text.substr(0, 66) + "…";
      out_ += Format("<text x=\"%.0f\" y=\"%.0f\"><tspan fill=\"%s\" font-weight=\"bold\">%zu</tspan> ", x, y, MarkFill(f),
                     i + 1) + Escaped(text) + "</text>\n";
      y += kLineHeight;
    }
    if (options_.findings.size() > kMostListed)
      out_ += Format("<text x=\"%.0f\" y=\"%.0f\">and %zu more</text>\n", x, y, options_.findings.size() - kMostListed);
  }

  const Footprints& footprints_;
  const MapOptions& options_;
  Point2 min_{1e300, 1e300}, max_{-1e300, -1e300};
  double scale_ = 1, width_ = 0, height_ = 0;
  std::string out_;
};

}  // namespace

Error WriteMap(const std::filesystem::path& path, const Footprints& footprints, const MapOptions& options) {
  return WriteTextFile(path, Plan(footprints, options).Draw());
}

}  // namespace flaneur
