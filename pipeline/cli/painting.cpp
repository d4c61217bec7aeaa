#include "pipeline/cli/painting.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/pictures/picture_files.h"
#include "runtime/base/array.h"
#include "runtime/base/png.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

constexpr float kCell_m = 1;  // of the painting as packed
constexpr int kMaxCells = 4'000'000;
constexpr float kShapeTolerance = 0.02f;
constexpr uint8_t kMinColor = 8;  // less than this is a grey that a compressed picture has tinted
constexpr std::array<uint8_t, 5> kGreyOfGround = {255, 176, 208, 224, 192};  // by GroundKind; 0: none
constexpr uint8_t kGreyOfObstacle = 64;

struct Picture {
  int width = 0, height = 0;
  std::vector<uint8_t> red, green;  // strength of the paint, rows from the top
};

uint8_t Beyond(int value, int others, int alpha) {
  const int strength = std::max(0, value - others) * alpha / 255;
  return static_cast<uint8_t>(strength < kMinColor ? 0 : strength);
}

Error ReadPaint(const fs::path& file, Picture* picture) {
  int channels = 0;
  std::vector<uint8_t> values;
  const auto accept = [&](const PictureShape& shape) {
    picture->width = shape.width;
    picture->height = shape.height;
    channels = Count(shape.channels);
    return channels < 3
               ? Fail(file.string() + ": has no colours; paint red where people go and green where they stand about")
               : Ok();
  };
  if (Error e = ReadPicture(file, accept, &values)) return e;
  const size_t pixels = static_cast<size_t>(picture->width) * static_cast<size_t>(picture->height);
  picture->red.resize(pixels);
  picture->green.resize(pixels);
  for (size_t i = 0; i < pixels; ++i) {
    const uint8_t* p = &values[i * static_cast<size_t>(channels)];
    const int alpha = channels > 3 ? p[3] : 255;
    picture->red[i] = Beyond(p[0], std::max(p[1], p[2]), alpha);
    picture->green[i] = Beyond(p[1], std::max(p[0], p[2]), alpha);
  }
  return Ok();
}

std::string Metres(Vec2 size_m) {
  return std::to_string(std::lround(size_m.x)) + " x " + std::to_string(std::lround(size_m.y)) + " m";
}

// The mean over a cell's pixels; a stroke thinner than a cell still counts.
uint8_t MeanOver(const std::vector<uint8_t>& values, const Picture& picture, int x0, int x1, int y0, int y1) {
  int64_t sum = 0;
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) sum += values[RowMajor(y, picture.width, x)];
  }
  const int64_t count = static_cast<int64_t>(x1 - x0) * (y1 - y0);
  return static_cast<uint8_t>((sum + count - 1) / count);
}

void Resample(const Picture& picture, Painting* p) {
  const auto range = [](int cell, int cells, int pixels) {
    const int first = static_cast<int>(static_cast<int64_t>(cell) * pixels / cells);
    return std::pair{first, std::max(first + 1, static_cast<int>(static_cast<int64_t>(cell + 1) * pixels / cells))};
  };
  for (int row = 0; row < p->rows; ++row) {
    const auto [y0, y1] = range(p->rows - 1 - row, p->rows, picture.height);
    for (int column = 0; column < p->columns; ++column) {
      const auto [x0, x1] = range(column, p->columns, picture.width);
      p->people.push_back(MeanOver(picture.red, picture, x0, x1, y0, y1));
      p->loiter.push_back(MeanOver(picture.green, picture, x0, x1, y0, y1));
    }
  }
}

bool AnyOnGround(const Painting& p, const GroundRaster& ground) {
  for (int row = 0; row < ground.rows; ++row) {
    for (int column = 0; column < ground.columns; ++column) {
      if (ground.kind[RowMajor(row, ground.columns, column)] == 0) continue;
      const Vec2 at =
          ground.min_m + Vec2{static_cast<float>(column) + 0.5f, static_cast<float>(row) + 0.5f} * ground.cell_m;
      const int cell = PaintingCell(p, at);
      if (cell >= 0 && (At(p.people, cell) > 0 || At(p.loiter, cell) > 0)) return true;
    }
  }
  return false;
}

// Calls visit(column) for the cells of a row that lie within rings, by the even-odd rule.
template <typename Visit>
void FillRow(const Obstacle& o, const GroundRaster& g, int row, Visit visit) {
  const double y = static_cast<double>(g.min_m.y) + (row + 0.5) * static_cast<double>(g.cell_m);
  std::vector<double> crossings;
  const auto cross = [&](const std::vector<Point2>& ring) {
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const Point2 &a = ring[i], &b = ring[j];
      if ((a.y > y) != (b.y > y)) crossings.push_back((b.x - a.x) * (y - a.y) / (b.y - a.y) + a.x);
    }
  };
  if (!o.outer.empty()) cross(o.outer);
  for (const auto& hole : o.holes) cross(hole);
  if (o.outer.empty() && std::abs(o.center.y - y) < o.radius_m) {
    const double half = std::sqrt(o.radius_m * o.radius_m - (o.center.y - y) * (o.center.y - y));
    crossings = {o.center.x - half, o.center.x + half};
  }
  std::sort(crossings.begin(), crossings.end());
  const auto column = [&](double x) {
    return static_cast<int>(std::ceil((x - static_cast<double>(g.min_m.x)) / static_cast<double>(g.cell_m) - 0.5));
  };
  for (size_t k = 0; k + 1 < crossings.size(); k += 2) {
    for (int c = std::max(0, column(crossings[k])); c < std::min(g.columns, column(crossings[k + 1])); ++c) visit(c);
  }
}

}  // namespace

Error ReadPainting(const PaintingSettings& settings, const GroundRaster& ground, Painting* out) {
  const std::string name = settings.file.string() + ": ";
  Picture picture;
  if (Error e = ReadPaint(settings.file, &picture)) return e;
  const Vec2 ground_size_m{static_cast<float>(ground.columns) * ground.cell_m,
                           static_cast<float>(ground.rows) * ground.cell_m};
  Painting p;
  p.min_m = settings.min_m.value_or(ground.min_m);
  const Vec2 size_m = settings.max_m.value_or(ground.min_m + ground_size_m) - p.min_m;
  const float shape = static_cast<float>(picture.width) / static_cast<float>(picture.height) * size_m.y / size_m.x;
  const float pixel = 1.5f / static_cast<float>(std::min(picture.width, picture.height));
  if (std::abs(shape - 1) > std::max(kShapeTolerance, pixel)) {
    return Fail(name + "its " + std::to_string(picture.width) + " x " + std::to_string(picture.height) +
                " pixels don't fit the shape of the " + Metres(size_m) +
                " that it covers; paint over the bake's plan.png, or give [painting] min_m and max_m");
  }
  const auto painted = [](const std::vector<uint8_t>& values) {
    return std::any_of(values.begin(), values.end(), [](uint8_t v) { return v > 0; });
  };
  if (!painted(picture.red) && !painted(picture.green)) {
    return Fail(name + "nothing is painted; paint red where people start and go to, green where they stand about");
  }
  p.cell_m = std::max(kCell_m, std::sqrt(size_m.x * size_m.y / kMaxCells));
  p.columns = std::max(1, static_cast<int>(std::ceil(size_m.x / p.cell_m)));
  p.rows = std::max(1, static_cast<int>(std::ceil(size_m.y / p.cell_m)));
  Resample(picture, &p);
  if (!AnyOnGround(p, ground)) return Fail(name + "all that is painted lies off the town's ground");
  *out = std::move(p);
  return Ok();
}

Error WritePlan(const fs::path& path, const GroundRaster& g, const Footprints& footprints) {
  const auto at = [&](int column, int row) {
    return static_cast<size_t>(g.rows - 1 - row) * static_cast<size_t>(g.columns) + static_cast<size_t>(column);
  };
  std::vector<uint8_t> grey(static_cast<size_t>(g.columns) * static_cast<size_t>(g.rows));
  for (int row = 0; row < g.rows; ++row) {
    for (int column = 0; column < g.columns; ++column) {
      const uint8_t kind = g.kind[RowMajor(row, g.columns, column)];
      grey[at(column, row)] = kGreyOfGround[std::min<size_t>(kind, kGreyOfGround.size() - 1)];
    }
    for (const Obstacle& o : footprints.obstacles) {
      FillRow(o, g, row, [&](int column) { grey[at(column, row)] = kGreyOfObstacle; });
    }
  }
  std::vector<uint8_t> rgb;
  rgb.reserve(3 * grey.size());
  for (uint8_t value : grey) rgb.insert(rgb.end(), {value, value, value});
  return WritePng(path, g.columns, g.rows, rgb);
}

}  // namespace flaneur
