#include "runtime/player/painted.h"

#include <algorithm>

#include "runtime/player/places.h"

namespace flaneur {
namespace {

constexpr int kGoals = 24, kMostLoiterPlaces = 60;
constexpr float kGoalsApart_m = 4, kLoiterApart_m = 2.6f;
constexpr int kPasses = 24;  // the weakest paint's cells come in the last ones

int Strength(const std::vector<uint8_t>& layer, const Simulation& s, int cell) {
  const int painted = PaintingCell(s.painting, CellCenter(s.walkable, cell));
  return painted < 0 ? 0 : layer[static_cast<size_t>(painted)];
}

void Shuffle(std::vector<int>* cells, Random* random) {
  for (size_t k = cells->size(); k > 1; --k) std::swap((*cells)[k - 1], (*cells)[static_cast<size_t>(random->Below(static_cast<int>(k)))]);
}

bool AnyPaint(const std::vector<uint8_t>& layer) {
  return std::any_of(layer.begin(), layer.end(), [](uint8_t strength) { return strength > 0; });
}

// Spread over the layer; none where it is not painted.
void AddPlaces(const std::vector<uint8_t>& layer, const char* kind, int most, float apart_m, Simulation* s) {
  if (!AnyPaint(layer)) return;
  std::vector<Vec2> chosen;
  for (int cell : PaintedOrder(layer, HomeCells(*s), s)) {
    if (static_cast<int>(chosen.size()) == most || Strength(layer, *s, cell) == 0) break;
    const Vec2 p = CellCenter(s->walkable, cell);
    if (std::any_of(chosen.begin(), chosen.end(), [&](Vec2 other) { return Length(other - p) < apart_m; })) continue;
    chosen.push_back(p);
    s->places.push_back({"painted_" + std::string(kind) + "_" + std::to_string(chosen.size()), kind, p, 1});
  }
  if (chosen.empty()) s->warnings.push_back(std::string("the painting has no place of kind ") + kind + " where people can walk; it is not used");
}

}  // namespace

std::vector<int> PaintedOrder(const std::vector<uint8_t>& layer, std::vector<int> cells, Simulation* s) {
  Shuffle(&cells, &s->random);
  std::vector<int> left, order;
  int strongest = 0;
  for (int cell : cells) {
    if (s->painting.columns == 0 || Strength(layer, *s, cell) == 0) continue;
    left.push_back(cell);
    strongest = std::max(strongest, Strength(layer, *s, cell));
  }
  if (left.empty()) return cells;
  for (int pass = 0; pass < kPasses && !left.empty(); ++pass) {
    // Each pass takes a cell with a probability in proportion to its strength, few enough that the first pass has many.
    std::vector<int> later;
    for (int cell : left) {
      const bool now = s->random.Uniform() * static_cast<float>(strongest) < static_cast<float>(Strength(layer, *s, cell));
      (now ? order : later).push_back(cell);
    }
    left = std::move(later);
  }
  order.insert(order.end(), left.begin(), left.end());
  return order;
}

void AddPaintedPlaces(Simulation* s) {
  if (s->painting.columns == 0) return;
  AddPlaces(s->painting.people, "goal", kGoals, kGoalsApart_m, s);
  if (!AnyPaint(s->painting.loiter)) return;
  s->places.erase(std::remove_if(s->places.begin(), s->places.end(), [](const PackPlace& p) { return p.kind == "loiter"; }), s->places.end());
  AddPlaces(s->painting.loiter, "loiter", kMostLoiterPlaces, kLoiterApart_m, s);
}

}  // namespace flaneur
