#include "runtime/town/painted.h"

#include <algorithm>

#include "runtime/town/places.h"

namespace flaneur {
namespace {

constexpr int kGoals = 24, kMaxLoiterPlaces = 60;
constexpr float kGoalsApart_m = 4, kLoiterApart_m = 2.6f;
constexpr int kPasses = 24;  // the weakest paint's cells come in the last ones

int Strength(const std::vector<uint8_t>& layer, const Town& town, int cell) {
  const int painted = PaintingCell(town.painting, CellCenter(town.walkable, cell));
  return painted < 0 ? 0 : layer[static_cast<size_t>(painted)];
}

void Shuffle(std::vector<int>* cells, Random* random) {
  for (size_t k = cells->size(); k > 1; --k)
    std::swap((*cells)[k - 1], (*cells)[static_cast<size_t>(random->Below(static_cast<int>(k)))]);
}

bool AnyPaint(const std::vector<uint8_t>& layer) {
  return std::any_of(layer.begin(), layer.end(), [](uint8_t strength) { return strength > 0; });
}

// Spread over the layer; none where it is not painted.
void AddPlaces(const std::vector<uint8_t>& layer, const char* kind, int most, float apart_m, Town* town) {
  if (!AnyPaint(layer)) return;
  std::vector<Vec2> chosen;
  for (int cell : PaintedOrder(layer, HomeCells(*town), town)) {
    if (static_cast<int>(chosen.size()) == most || Strength(layer, *town, cell) == 0) break;
    const Vec2 p = CellCenter(town->walkable, cell);
    if (std::any_of(chosen.begin(), chosen.end(), [&](Vec2 other) { return Length(other - p) < apart_m; })) continue;
    chosen.push_back(p);
    town->places.push_back({"painted_" + std::string(kind) + "_" + std::to_string(chosen.size()), kind, p, 1});
  }
  if (chosen.empty())
    town->warnings.push_back(std::string("the painting has no place of kind ") + kind +
                             " where people can walk; it is not used");
}

}  // namespace

std::vector<int> PaintedOrder(const std::vector<uint8_t>& layer, std::vector<int> cells, Town* town) {
  Shuffle(&cells, &town->random);
  std::vector<int> left, order;
  int strongest = 0;
  for (int cell : cells) {
    if (town->painting.columns == 0 || Strength(layer, *town, cell) == 0) continue;
    left.push_back(cell);
    strongest = std::max(strongest, Strength(layer, *town, cell));
  }
  if (left.empty()) return cells;
  for (int pass = 0; pass < kPasses && !left.empty(); ++pass) {
    // Each pass takes a cell with a probability in proportion to its strength, few enough that the first pass has many.
    std::vector<int> later;
    for (int cell : left) {
      const bool now =
          town->random.Uniform() * static_cast<float>(strongest) < static_cast<float>(Strength(layer, *town, cell));
      (now ? order : later).push_back(cell);
    }
    left = std::move(later);
  }
  order.insert(order.end(), left.begin(), left.end());
  return order;
}

void AddPaintedPlaces(Town* town) {
  if (town->painting.columns == 0) return;
  AddPlaces(town->painting.people, "goal", kGoals, kGoalsApart_m, town);
  if (!AnyPaint(town->painting.loiter)) return;
  town->places.erase(
      std::remove_if(town->places.begin(), town->places.end(), [](const Place& p) { return p.kind == "loiter"; }),
      town->places.end());
  AddPlaces(town->painting.loiter, "loiter", kMaxLoiterPlaces, kLoiterApart_m, town);
}

}  // namespace flaneur
