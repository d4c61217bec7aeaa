#include "pipeline/footprint/map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "runtime/base/array.h"
#include "runtime/base/file.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

constexpr double kPlanWidth = 1200;  // of the town in the picture, pixels
constexpr double kMargin = 40;
constexpr double kListWidth = 460;
constexpr double kLineHeight = 17;
constexpr size_t kMaxListed = 60;
constexpr int kMaxGroundColumns = 1600;

const char* Fill(ObstacleKind kind) {
  switch (kind) {
    case ObstacleKind::kBuilding:
      return "#8c5a4a";
    case ObstacleKind::kWall:
      return "#5d5a57";
    case ObstacleKind::kTree:
      return "#4f7a46";
    case ObstacleKind::kLamp:
      return "#c9962b";
    case ObstacleKind::kOther:
      return "#6c7f93";
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
            g->min_m.y + static_cast<double>(g->rows) * g->cell_m},
           0);
    }
    if (min_.x > max_.x) min_ = {0, 0}, max_ = {10, 10};
    scale_ = kPlanWidth / std::max(max_.x - min_.x, max_.y - min_.y);
    width_ = (max_.x - min_.x) * scale_;
    height_ = (max_.y - min_.y) * scale_;
  }

  std::string Draw() {
    const size_t listed = std::min(options_.findings.size(), kMaxListed);
    const double list = options_.findings.empty() ? 0 : kListWidth;
    const double all_height =
        std::max(height_ + 2 * kMargin + 40, (static_cast<double>(listed) + 4) * kLineHeight + 80);
    const double all_width = width_ + 2 * kMargin + list;
    out_ = Format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" height=\"%.0f\" "
        "font-family=\"sans-serif\" font-size=\"12\" fill=\"#2b2b2b\">\n<rect width=\"100%%\" "
        "height=\"100%%\" fill=\"#fbfaf7\"/>\n",
        all_width, all_height, all_width, all_height);
    out_ += Format("<text x=\"%.0f\" y=\"30\" font-size=\"20\">", kMargin) + Escaped(options_.title) + "</text>\n";
    out_ += Format("<g transform=\"translate(%.0f %.0f)\">\n", kMargin, kMargin + 10);
    DrawTown();
    DrawStops();
    DrawMarks();
    out_ += "</g>\n";
    DrawLegend();
    DrawList();
    return out_ + "</svg>\n";
  }

  // The town alone, to be moved and zoomed, and the marks' places as JSON: [x, y] or null.
  std::string DrawForPage(std::string* places) {
    out_ = Format("<svg id=\"map\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\"><g id=\"town\">\n",
                  width_, height_);
    DrawTown();
    *places = "[";
    for (const Finding& f : options_.findings) {
      if (places->size() > 1) *places += ",";
      *places +=
          std::isfinite(f.at_m.x) && std::isfinite(f.at_m.y) ? Format("[%.2f,%.2f]", X(f.at_m.x), Y(f.at_m.y)) : "null";
    }
    *places += "]";
    return out_ + "</g><g id=\"marks\"></g></svg>\n";
  }

  double pixels_per_metre() const { return scale_; }

 private:
  void DrawTown() {
    DrawGround();
    for (const auto& street : options_.streets) DrawStreet(street);
    for (const Obstacle& o : footprints_.obstacles) DrawObstacle(o);
  }

  // The line is straight from stop to stop: the guide's own way goes around what stands there.
  void DrawStops() {
    std::string path;
    for (const Point2& p : options_.stops) path += Format("%s%.1f %.1f", path.empty() ? "M" : "L", X(p.x), Y(p.y));
    if (path.empty()) return;
    out_ += "<path fill=\"none\" stroke=\"#2a5d8a\" stroke-width=\"2\" stroke-dasharray=\"5 4\" d=\"" + path + "\"/>\n";
    for (size_t i = 0; i < options_.stops.size(); ++i) {
      const Point2& p = options_.stops[i];
      out_ += Format(
          "<g transform=\"translate(%.1f %.1f)\"><circle r=\"9\" fill=\"#2a5d8a\" stroke=\"#fff\"/><text y=\"4\" "
          "text-anchor=\"middle\" font-size=\"11\" fill=\"#fff\">%zu</text></g>\n",
          X(p.x), Y(p.y), i + 1);
    }
  }

  void DrawStreet(const std::vector<Point2>& street) {
    std::string path;
    for (const Point2& p : street) {
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) return;
      path += Format("%s%.2f %.2f", path.empty() ? "M" : "L", X(p.x), Y(p.y));
    }
    if (!path.empty()) out_ += "<path fill=\"none\" stroke=\"#b9b2a3\" stroke-width=\"1.5\" d=\"" + path + "\"/>\n";
  }

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
    const int step = std::max(1, std::max(g->columns, g->rows) / kMaxGroundColumns + 1);
    const double size = g->cell_m * static_cast<float>(step) * scale_;
    out_ += "<g shape-rendering=\"crispEdges\">\n";
    for (int row = 0; row < g->rows; row += step) {
      const auto kind = [&](int column) { return g->kind[RowMajor(row, g->columns, column)]; };
      for (int column = 0; column < g->columns;) {
        int end = column;
        while (end < g->columns && kind(end) == kind(column)) end += step;
        const int cells = (end - column) / step;
        if (kind(column) != 0)
          out_ += Format("<path fill=\"%s\" d=\"M%.1f %.1fh%.1fv%.1fh-%.1fz\"/>\n", GroundFill(kind(column)),
                         X(g->min_m.x + static_cast<double>(column) * g->cell_m),
                         Y(g->min_m.y + static_cast<double>(row) * g->cell_m) - size, cells * size + 0.6, size + 0.6,
                         cells * size + 0.6);
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
                     std::max(o.radius_m * scale_, 1.5), Fill(o.kind)) +
              title + "</circle>\n";
      return;
    }
    std::string path = PathOf(o.outer);
    for (const auto& hole : o.holes) path += PathOf(hole);
    out_ +=
        Format("<path fill=\"%s\" fill-rule=\"evenodd\" stroke=\"#3b2620\" stroke-width=\"0.6\" d=\"", Fill(o.kind)) +
        path + "\">" + title + "</path>\n";
  }

  static const char* MarkFill(const Finding& f) { return f.severity == Severity::kError ? "#d02020" : "#e08a00"; }

  void DrawMarks() {
    for (size_t i = options_.findings.size(); i-- > 0;) {
      const Finding& f = options_.findings[i];
      if (!std::isfinite(f.at_m.x) || !std::isfinite(f.at_m.y)) continue;
      out_ += Format(
                  "<g transform=\"translate(%.1f %.1f)\"><circle r=\"7\" fill=\"%s\" fill-opacity=\"0.85\" "
                  "stroke=\"#fff\"/><text y=\"3.5\" text-anchor=\"middle\" font-size=\"8\" fill=\"#fff\">%zu</text>",
                  X(f.at_m.x), Y(f.at_m.y), MarkFill(f), i + 1) +
              "<title>" + std::to_string(f.code) + " " + Escaped(f.message) + "</title></g>\n";
    }
  }

  void DrawLegend() {
    const double y = kMargin + 10 + height_ + 24;
    double step = std::pow(10, std::floor(std::log10((max_.x - min_.x) / 4)));
    if ((max_.x - min_.x) / step > 20) step *= 5;
    out_ += Format(
        "<path d=\"M%.1f %.1fv6h%.1fv-6\" fill=\"none\" stroke=\"#2b2b2b\"/><text x=\"%.1f\" y=\"%.1f\">%g m"
        "</text>\n",
        kMargin, y - 4, step * scale_, kMargin + step * scale_ + 6, y + 3, step);
    double x = kMargin + step * scale_ + 80;
    for (const ObstacleKind kind : {ObstacleKind::kBuilding, ObstacleKind::kWall, ObstacleKind::kTree,
                                    ObstacleKind::kLamp, ObstacleKind::kOther}) {
      out_ += Format(
          "<rect x=\"%.1f\" y=\"%.1f\" width=\"12\" height=\"12\" fill=\"%s\"/><text x=\"%.1f\" y=\"%.1f\">%s"
          "</text>\n",
          x, y - 7, Fill(kind), x + 17, y + 3, ObstacleKindName(kind));
      x += 85;
    }
  }

  void DrawList() {
    if (options_.findings.empty()) return;
    const double x = width_ + 2 * kMargin;
    double y = kMargin + 20;
    for (size_t i = 0; i < std::min(options_.findings.size(), kMaxListed); ++i) {
      const Finding& f = options_.findings[i];
      std::string text = std::to_string(f.code) + " " + f.message;
      if (text.size() > 68) text = std::string(Beginning(text, 66)) + "…";
      out_ += Format("<text x=\"%.0f\" y=\"%.0f\"><tspan fill=\"%s\" font-weight=\"bold\">%zu</tspan> ", x, y,
                     MarkFill(f), i + 1) +
              Escaped(text) + "</text>\n";
      y += kLineHeight;
    }
    if (options_.findings.size() > kMaxListed)
      out_ += Format("<text x=\"%.0f\" y=\"%.0f\">and %zu more</text>\n", x, y, options_.findings.size() - kMaxListed);
  }

  const Footprints& footprints_;
  const MapOptions& options_;
  Point2 min_{1e300, 1e300}, max_{-1e300, -1e300};
  double scale_ = 1, width_ = 0, height_ = 0;
  std::string out_;
};

constexpr const char* kPageStyle = R"(
body { margin: 0; font: 13px sans-serif; color: #2b2b2b; background: #fbfaf7; display: flex; height: 100vh; }
#left { flex: 1; position: relative; overflow: hidden; }
#map { width: 100%; height: 100%; cursor: grab; display: block; }
#map path, #map circle { vector-effect: non-scaling-stroke; }
#hover { position: absolute; left: 10px; bottom: 10px; background: #fffd; padding: 4px 8px; border-radius: 4px; }
#scale { position: absolute; right: 14px; bottom: 10px; border: solid #2b2b2b; border-width: 0 1px 1px; text-align: center; }
#right { width: 430px; overflow-y: auto; border-left: 1px solid #ddd8cc; padding: 0 12px; }
h1 { font-size: 17px; } h2 { font-size: 14px; margin: 14px 0 2px; }
h2 label { cursor: pointer; } .advice { color: #666; margin: 0 0 4px; }
.item { padding: 2px 4px; cursor: pointer; border-radius: 3px; } .item:hover, .item.on { background: #ece6d6; }
.error { color: #d02020; } .warning { color: #b06c00; }
#marks circle { stroke: #fff; stroke-width: 1.5; } #marks .on circle { stroke: #000; stroke-width: 3; }
#marks text { font-size: 8px; fill: #fff; text-anchor: middle; pointer-events: none; } #marks g { cursor: pointer; }
)";

// View: what of the plan's pixels is shown; marks keep their size on the screen.
constexpr const char* kPageScript = R"(
const map = document.getElementById('map'), marks = document.getElementById('marks');
const hover = document.getElementById('hover'), list = document.getElementById('list');
const whole = map.viewBox.baseVal, full = {x: whole.x, y: whole.y, w: whole.width, h: whole.height};
let view = {...full};
const make = (name, parent, text) => {
  const node = name == 'g' || name == 'circle' || name == 'text'
    ? document.createElementNS('http://www.w3.org/2000/svg', name) : document.createElement(name);
  if (text !== undefined) node.textContent = text;
  parent.appendChild(node);
  return node;
};
function show() {
  map.setAttribute('viewBox', `${view.x} ${view.y} ${view.w} ${view.h}`);
  const unit = 1 / map.getScreenCTM().a;
  for (const mark of marks.children) mark.setAttribute('transform', `translate(${mark.at}) scale(${unit})`);
  let metres = Math.pow(10, Math.floor(Math.log10(150 * unit / pixelsPerMetre)));
  for (const step of [2, 5]) if (step * metres * pixelsPerMetre / unit < 150) var best = step * metres;
  metres = best || metres;
  const bar = document.getElementById('scale');
  bar.style.width = metres * pixelsPerMetre / unit + 'px';
  bar.textContent = metres + ' m';
}
function zoom(factor, x, y) {
  view = {x: x + (view.x - x) * factor, y: y + (view.y - y) * factor, w: view.w * factor, h: view.h * factor};
  show();
}
const at = event => new DOMPoint(event.clientX, event.clientY).matrixTransform(map.getScreenCTM().inverse());
map.addEventListener('wheel', event => {
  event.preventDefault();
  const p = at(event);
  zoom(Math.exp(event.deltaY / 400), p.x, p.y);
}, {passive: false});
let grabbed = null;
map.addEventListener('pointerdown', event => { grabbed = at(event); });
window.addEventListener('pointerup', () => { grabbed = null; });
window.addEventListener('pointermove', event => {
  if (!grabbed) return;
  const p = at(event);
  view.x += grabbed.x - p.x, view.y += grabbed.y - p.y;
  show();
});
map.addEventListener('dblclick', () => { view = {...full}; show(); });
map.addEventListener('mouseover', event => {
  const title = event.target.querySelector && event.target.querySelector('title');
  if (title && !event.target.finding) hover.textContent = title.textContent;
});
function light(i, on) {
  for (const node of [items[i], nodes[i]]) if (node) node.classList.toggle('on', on);
  if (on) hover.textContent = data[i].code + ' ' + data[i].message;
}
const items = [], nodes = [], codes = [...new Set(data.map(f => f.code))];
for (const code of codes) {
  const all = data.map((f, i) => i).filter(i => data[i].code == code), first = data[all[0]];
  const head = make('label', make('h2', list)), box = make('input', head), part = make('div', list);
  box.type = 'checkbox', box.checked = true;
  make('span', head, `${code} ${first.title} (${all.length})`).className = first.severity;
  make('p', part, first.advice).className = 'advice';
  for (const i of all) {
    items[i] = make('div', part, `${i + 1}. ${data[i].feature} ${data[i].detail}`);
    items[i].className = 'item';
    items[i].onmouseenter = () => light(i, true), items[i].onmouseleave = () => light(i, false);
    items[i].onclick = () => {
      if (!places[i]) return;
      const size = Math.min(full.w, 40 * pixelsPerMetre), high = size * full.h / full.w;
      view = {x: places[i][0] - size / 2, y: places[i][1] - high / 2, w: size, h: high};
      show();
    };
  }
  box.onchange = () => {
    part.hidden = !box.checked;
    for (const i of all) if (nodes[i]) nodes[i].style.display = box.checked ? '' : 'none';
  };
}
for (let i = data.length - 1; i >= 0; --i) {
  if (!places[i]) continue;
  const mark = nodes[i] = make('g', marks), dot = make('circle', mark);
  mark.at = places[i].join(' ');
  dot.setAttribute('r', 8), dot.setAttribute('fill', data[i].severity == 'error' ? '#d02020' : '#e08a00');
  make('text', mark, i + 1).setAttribute('y', 3);
  dot.finding = true;
  mark.onmouseenter = () => { light(i, true); items[i].scrollIntoView({block: 'nearest'}); };
  mark.onmouseleave = () => light(i, false);
}
window.onresize = show;
show();
)";

// JSON inside a script element.
std::string ForScript(std::string json) {
  for (size_t i = json.find('<'); i != std::string::npos; i = json.find('<', i + 1)) json.replace(i, 1, "\\u003c");
  return json;
}

std::string PageData(const std::vector<Finding>& findings) {
  nlohmann::json list = nlohmann::json::array();
  for (const Finding& f : findings) {
    const FindingKind& kind = KindOf(f.code);
    const std::string title = kind.title;
    const bool titled = f.message.starts_with(title + ": ");
    list.push_back({{"code", f.code},
                    {"severity", SeverityName(f.severity)},
                    {"feature", f.feature},
                    {"title", title},
                    {"message", f.message},
                    {"detail", titled ? f.message.substr(title.size() + 2) : ""},
                    {"advice", kind.advice}});
  }
  return ForScript(list.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace

Error WriteMap(const std::filesystem::path& path, const Footprints& footprints, const MapOptions& options) {
  return WriteTextFile(path, Plan(footprints, options).Draw());
}

Error WriteMapPage(const std::filesystem::path& path, const Footprints& footprints, const MapOptions& options) {
  Plan plan(footprints, options);
  std::string places;
  const std::string map = plan.DrawForPage(&places), title = Escaped(options.title);
  const auto errors = std::count_if(options.findings.begin(), options.findings.end(),
                                    [](const Finding& f) { return f.severity == Severity::kError; });
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + title + "</title><style>" +
      kPageStyle + "</style></head>\n<body><div id=\"left\">" + map +
      "<div id=\"hover\">Wheel: zoom. Drag: move. Double click: all.</div><div id=\"scale\"></div></div>\n"
      "<div id=\"right\"><h1>" +
      title + "</h1><p>" + std::to_string(errors) + " errors, " +
      std::to_string(static_cast<std::ptrdiff_t>(options.findings.size()) - errors) + " warnings, " +
      std::to_string(footprints.obstacles.size()) + " obstacles</p><div id=\"list\"></div></div>\n<script>\n";
  page += "const data = " + PageData(options.findings) + ";\nconst places = " + places + ";\n" +
          Format("const pixelsPerMetre = %.9g;", plan.pixels_per_metre()) + kPageScript;
  return WriteTextFile(path, page + "</script></body></html>\n");
}

}  // namespace flaneur
