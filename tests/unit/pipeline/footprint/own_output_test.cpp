// What is extracted from random towns passes the check against the same town.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <random>

#include "pipeline/footprint/check.h"
#include "pipeline/footprint/polygon_sets.h"
#include "runtime/base/array.h"
#include "tests/unit/pipeline/footprint/test_town.h"

namespace flaneur {
namespace {

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  float Any(float from, float to) { return from + (to - from) * static_cast<float>(random_()) / 4294967296.0f; }
  bool Chance(float share) { return Any(0, 1) < share; }
  int Below(int n) { return static_cast<int>(Any(0, static_cast<float>(n))); }

 private:
  std::mt19937 random_;
};

// Wrong in obstacles, where the town itself has nothing wrong. Without a clearance what just reaches into the band is
// as thin as it is there.
bool IsOwnFault(int code, double clearance_m) {
  if (clearance_m < 0.02 && (code == 203 || (code >= 301 && code <= 303))) return false;
  return code <= 107 || (code >= 200 && code <= 305) || code == 401 || code == 402;
}

void ExpectNoOwnFault(const Scene& town, const Footprints& footprints, unsigned seed) {
  std::vector<Finding> findings;
  ASSERT_EQ(Check(footprints, &town, {}, &findings).message, "");
  for (const Finding& f : findings)
    EXPECT_FALSE(IsOwnFault(f.code, footprints.clearance_m)) << "seed " << seed << ": " << f.message;
}

// A canal between two quays, with houses on them and bridges over it; beneath quays and bridges no ground is given.
TestTown Canal(unsigned seed) {
  Dice dice(seed);
  const float water = dice.Any(-3, -0.3f), quay = dice.Any(0.2f, 1), parapet = dice.Any(-0.1f, 0.9f), length = 60;
  TestTown town;
  town.Node("west", NodeKind::kGround).Quad({0, 0, 0}, {18, 0, 0}, {18, length, 0}, {0, length, 0});
  town.Node("east", NodeKind::kGround).Quad({32, 0, 0}, {50, 0, 0}, {50, length, 0}, {32, length, 0});
  town.Node("canal", NodeKind::kGround)
      .Quad({18 + quay, 0, water}, {32 - quay, 0, water}, {32 - quay, length, water}, {18 + quay, length, water});
  for (const float x : {18.0f, 32 - quay})
    town.Node("quay", NodeKind::kOther).Box({x, 0, water - 0.5f}, {x + quay, length, parapet});
  for (int i = 0; i < 3; ++i) {
    const float y = 8 + 16 * static_cast<float>(i), foot = dice.Any(water - 1, 0), deck = dice.Any(-0.3f, 1.5f);
    const float west = dice.Any(16, 19), east = dice.Any(31, 34);
    town.Node("bridge", NodeKind::kOther).Box({west, y, std::min(foot, deck - 0.2f)}, {east, y + dice.Any(2, 6), deck});
    if (i > 0)
      town.Box({18, y - dice.Any(1, 4), water - 1}, {18 + dice.Any(0.2f, 4), y + 1, water + dice.Any(-0.2f, 0.4f)});
    town.scene.nodes.back().is_bridge = true;
    town.Node("house", NodeKind::kBuilding).Box({dice.Any(8, 12), y - 6, -0.5f}, {dice.Any(13, 18), y - 1, 7});
  }
  return town;
}

// Houses, arcades, walls, stairs, bridges, trees and slabs on level or hilly ground, with holes or without any; nothing
// stands in anything else.
class Mixture {
 public:
  explicit Mixture(unsigned seed) : dice_(seed) {
    slope_ = dice_.Chance(0.5f) ? dice_.Any(-0.12f, 0.12f) : 0;
    if (dice_.Chance(0.5f))
      for (int k = 0; k < 4; ++k) hills_.push_back({dice_.Any(0, kSide_m), dice_.Any(0, kSide_m), dice_.Any(-4, 4)});
    if (dice_.Chance(0.7f)) AddTerrain();
    for (int k = 3 + dice_.Below(14); k > 0; --k) AddThing();
  }
  TestTown town;
  std::map<std::string, Ring> plans;  // of whole houses, by name
  FootprintOptions Options() {
    FootprintOptions options;
    if (dice_.Chance(0.3f)) options.clearance_m = 0;
    else if (dice_.Chance(0.4f)) options.clearance_m = dice_.Any(0, 0.3f);
    if (dice_.Chance(0.2f)) options.tolerance_m = dice_.Any(0, 0.08f);
    return options;
  }

 private:
  static constexpr float kSide_m = 60;
  struct Place {
    float x, y, turn_rad, ground_m;
  };

  float Height(float x, float y) const {
    float height = slope_ * x;
    for (const Vec3& h : hills_) height += h.z * std::exp(-((x - h.x) * (x - h.x) + (y - h.y) * (y - h.y)) / 200);
    return height;
  }

  void AddTerrain() {
    const float step = dice_.Chance(0.5f) ? 4 : 10, holes = dice_.Chance(0.3f) ? 0.1f : 0;
    const auto at = [&](float x, float y) { return Vec3{x, y, Height(x, y)}; };
    town.Node("ground", NodeKind::kGround);
    for (float x = 0; x < kSide_m; x += step)
      for (float y = 0; y < kSide_m; y += step)
        if (!dice_.Chance(holes)) town.Quad(at(x, y), at(x + step, y), at(x + step, y + step), at(x, y + step));
  }

  TestTown& Node(const char* kind, NodeKind node) { return town.Node(kind + std::to_string(count_++), node); }

  // Of a house whose walls reach the ground all round, and whose roof nobody touches.
  void AddPlan(const Place& p, float width, float depth, float low, float high) {
    const float cosine = std::cos(p.turn_rad), sine = std::sin(p.turn_rad), u = width / 2, v = depth / 2;
    Ring plan;
    for (const auto& [a, b] : {std::pair{-u, -v}, {u, -v}, {u, v}, {-u, v}}) {
      const float x = p.x + cosine * a - sine * b, y = p.y + sine * a + cosine * b,
                  ground_m = Height(x, y) - p.ground_m;
      if (ground_m < low || ground_m > high - 2.3f) return;
      plan.push_back({x, y});
    }
    plans["house" + std::to_string(count_ - 1)] = plan;
  }

  // Four walls with a flat roof; `without`: a wall that is missing.
  void Block(const Place& p, float width, float depth, float low, float high, float overhang = 0, int without = -1) {
    const float cosine = std::cos(p.turn_rad), sine = std::sin(p.turn_rad);
    const auto corners = [&](float beyond, float z) {
      const float u = width / 2 + beyond, v = depth / 2 + beyond;
      const auto at = [&](float a, float b) {
        return Vec3{p.x + cosine * a - sine * b, p.y + sine * a + cosine * b, z};
      };
      return std::array<Vec3, 4>{at(-u, -v), at(u, -v), at(u, v), at(-u, v)};
    };
    const auto foot = corners(0, p.ground_m + low), top = corners(0, p.ground_m + high);
    for (int k = 0; k < 4; ++k)
      if (k != without) town.Quad(At(foot, k), At(foot, (k + 1) % 4), At(top, (k + 1) % 4), At(top, k));
    const auto roof = corners(overhang, p.ground_m + high);
    town.Quad(roof[0], roof[1], roof[2], roof[3]);
    if (dice_.Chance(0.5f)) town.Quad(foot[3], foot[2], foot[1], foot[0]);
  }

  bool Takes(const Place& p, float reach_m) {
    for (const Vec3& other : taken_)
      if (std::hypot(other.x - p.x, other.y - p.y) < other.z + reach_m) return false;
    taken_.push_back({p.x, p.y, reach_m});
    return true;
  }

  void AddThing() {
    Place p{dice_.Any(6, 54), dice_.Any(6, 54), dice_.Chance(0.5f) ? 0 : dice_.Any(0, 3), 0};
    p.ground_m = Height(p.x, p.y);
    const float width = dice_.Any(4, 12);
    float depth = dice_.Any(4, 10), high = 0;
    const float reach_m = std::hypot(width, depth) / 2 + 0.8f;
    switch (dice_.Below(10)) {
      case 0:
        if (Takes(p, reach_m)) AddArcade(p, width, depth);
        break;
      case 1:
        if (!Takes(p, 10.5f)) break;
        Node("wall", NodeKind::kOther);
        Block(p, dice_.Any(5, 20), dice_.Any(0.1f, 0.6f), -2, dice_.Any(0.05f, 2.5f));
        break;
      case 2:
        if (Takes(p, 4)) AddStairs(p);
        break;
      case 3:
        if (!Takes(p, reach_m + 2)) break;
        Node("bridge", NodeKind::kOther);
        Block(p, width + 4, 3, -dice_.Any(0, 1), dice_.Any(-0.2f, 3));
        town.scene.nodes.back().is_bridge = true;
        break;
      case 4:
        if (!Takes(p, 2.4f)) break;
        Node("tree", NodeKind::kTree).Column({p.x, p.y, p.ground_m - 0.3f}, dice_.Any(0.1f, 0.5f), 5, 8);
        Block(p, 3, 3, 2.2f, 5);
        break;
      case 5:
        if (!Takes(p, reach_m)) break;
        Node("slab", NodeKind::kOther);
        Block(p, width, depth, -0.3f, dice_.Any(0, 0.4f));
        break;
      case 6:
        if (!Takes(p, reach_m + width)) break;
        Node("house", NodeKind::kBuilding);
        Block(p, width, depth, -1, 5);
        AddPlan(p, width, depth, -1, 5);
        p.x += std::cos(p.turn_rad) * width, p.y += std::sin(p.turn_rad) * width;  // and its neighbour
        Node("house", NodeKind::kBuilding);
        depth *= dice_.Any(0.5f, 1.2f);
        high = dice_.Any(3, 7);
        Block(p, width, depth, -1, high);
        AddPlan(p, width, depth, -1, high);
        break;
      default:
        if (!Takes(p, reach_m)) break;
        Node("house", dice_.Chance(0.7f) ? NodeKind::kBuilding : NodeKind::kOther);
        const float low = -dice_.Any(0, 2.5f), overhang = dice_.Any(0, 0.8f);
        high = dice_.Any(2.5f, 9);
        const int without = dice_.Chance(0.2f) ? dice_.Below(4) : -1;
        Block(p, width, depth, low, high, overhang, without);
        if (without < 0) AddPlan(p, width, depth, low, high);
    }
  }

  void AddArcade(const Place& p, float width, float depth) {
    Node("arcade", NodeKind::kBuilding);
    Block(p, width, depth, 2.6f, 8);
    const float cosine = std::cos(p.turn_rad), sine = std::sin(p.turn_rad);
    for (const float a : {-width / 2 + 0.3f, width / 2 - 0.3f})
      for (const float b : {-depth / 2 + 0.3f, depth / 2 - 0.3f})
        Block({p.x + cosine * a - sine * b, p.y + sine * a + cosine * b, p.turn_rad, p.ground_m}, 0.4f, 0.4f, -1, 2.6f);
  }

  void AddStairs(const Place& p) {
    Node("stairs", NodeKind::kOther);
    for (int step = 0; step < 6; ++step) {
      const float up = static_cast<float>(step);
      Block({p.x + 0.3f * up, p.y, 0, p.ground_m}, 0.3f, 2, -1, 0.17f * (up + 1));
    }
  }

  Dice dice_;
  float slope_ = 0;
  std::vector<Vec3> hills_, taken_;  // z: height; radius
  int count_ = 0;
};

// FLANEUR_MANY_TOWNS=2000 goes on for longer.
unsigned Towns(unsigned usual) {
  const char* const more = std::getenv("FLANEUR_MANY_TOWNS");
  return more ? static_cast<unsigned>(std::atoi(more)) : usual;
}

TEST(OwnOutput, IsRightBesideCanals) {
  for (unsigned seed = 181; seed < 181 + Towns(40); ++seed) {
    const TestTown town = Canal(seed);
    Footprints footprints;
    ASSERT_EQ(ExtractFootprints(town.scene, {}, &footprints).message, "");
    ExpectNoOwnFault(town.scene, footprints, seed);
  }
}

TEST(OwnOutput, IsRightInMixturesOfEverything) {
  for (unsigned seed = 1; seed <= Towns(100); ++seed) {
    Mixture mixture(seed);
    Footprints footprints;
    ASSERT_EQ(ExtractFootprints(mixture.town.scene, mixture.Options(), &footprints).message, "");
    ExpectNoOwnFault(mixture.town.scene, footprints, seed);
  }
}

TEST(OwnOutput, IsWhereHousesStand) {
  for (unsigned seed = 1; seed <= Towns(100); ++seed) {
    Mixture mixture(seed);
    const FootprintOptions options = mixture.Options();
    Footprints footprints;
    ASSERT_EQ(ExtractFootprints(mixture.town.scene, options, &footprints).message, "");
    for (const auto& [name, plan] : mixture.plans) {
      Rings made;
      for (const Obstacle& o : footprints.obstacles) {
        if (o.source != name) continue;
        Rings own{o.outer};
        own.insert(own.end(), o.holes.begin(), o.holes.end());
        made = Union(made, own);
      }
      Rings neighbours;
      for (const auto& [other, its_plan] : mixture.plans)
        if (other != name) neighbours.push_back(its_plan);
      const Rings wanted = Difference(Offset({plan}, options.clearance_m), neighbours);
      const double both = Area(Intersection(made, wanted)), either = Area(made) + Area(wanted) - both;
      EXPECT_GT(both / either, 0.95) << "seed " << seed << ": " << name << ", " << Area(made) << " of " << Area(wanted);
    }
  }
}

// ---- One fault at a time ----

Ring Moved(Ring ring, double x, double y) {
  for (Point2& p : ring) p.x += x, p.y += y;
  return ring;
}

// The obstacle, broken; false where it does not lend itself to it. `feature`: where the finding belongs.
using Break = std::function<bool(size_t at, Dice& dice, Footprints* footprints, std::string* feature)>;

bool Resized(double by_m, Obstacle* o) {
  const Rings rings = Offset({o->outer}, by_m);
  if (rings.size() != 1) return false;
  o->outer = rings[0];
  return true;
}

const std::map<std::string, Break> kBreaks{
    {"moved by 0.3 m",
     [](size_t at, Dice& dice, Footprints* f, std::string*) {
       const float way = dice.Any(0, 2 * kPi);
       Obstacle& o = f->obstacles[at];
       o.outer = Moved(o.outer, 0.3 * std::cos(way), 0.3 * std::sin(way));
       for (Ring& hole : o.holes) hole = Moved(hole, 0.3 * std::cos(way), 0.3 * std::sin(way));
       return true;
     }},
    {"left out",
     [](size_t at, Dice&, Footprints* f, std::string* feature) {
       *feature = f->obstacles[at].source;
       std::erase_if(f->obstacles, [&](const Obstacle& o) { return o.source == *feature; });
       return true;
     }},
    {"too small", [](size_t at, Dice&, Footprints* f, std::string*) { return Resized(-0.12, &f->obstacles[at]); }},
    {"too large", [](size_t at, Dice&, Footprints* f, std::string*) { return Resized(0.4, &f->obstacles[at]); }},
    {"one corner moved by 0.5 m",
     [](size_t at, Dice& dice, Footprints* f, std::string*) {
       Ring& ring = f->obstacles[at].outer;
       const float way = dice.Any(0, 2 * kPi);
       Point2& corner = ring[static_cast<size_t>(dice.Below(Count(ring)))];
       corner.x += 0.5 * std::cos(way), corner.y += 0.5 * std::sin(way);
       return true;
     }},
    {"nobody's", [](size_t at, Dice&, Footprints* f, std::string* feature) {
       Obstacle strange = f->obstacles[at];
       strange.name = strange.source = *feature = "strange";
       strange.outer = {{-20, -20}, {-15, -20}, {-15, -15}, {-20, -15}};
       strange.holes.clear();
       f->obstacles.push_back(std::move(strange));
       return true;
     }}};

TEST(OwnOutput, OneFaultIsFoundWhereItIsAndNothingElse) {
  for (unsigned seed = 1; seed <= Towns(30); ++seed) {
    Mixture mixture(seed);
    const Scene& town = mixture.town.scene;
    Footprints sound;
    ASSERT_EQ(ExtractFootprints(town, {}, &sound).message, "");
    Dice dice(seed);
    std::vector<size_t> polygons;
    for (size_t i = 0; i < sound.obstacles.size(); ++i)
      if (!sound.obstacles[i].outer.empty()) polygons.push_back(i);
    if (polygons.empty()) continue;
    const size_t at = At(polygons, dice.Below(Count(polygons)));
    for (const auto& [name, make] : kBreaks) {
      Footprints broken = sound;
      const std::string source = sound.obstacles[at].source;
      std::string feature = sound.obstacles[at].name;
      if (!make(at, dice, &broken, &feature)) continue;
      std::vector<Finding> findings;
      ASSERT_EQ(Check(broken, &town, {}, &findings).message, "");
      bool found = false;
      for (const Finding& f : findings) {
        const bool its_own = f.feature == feature || f.feature == source || f.other == feature;
        found |= its_own && f.code < 403;
        EXPECT_FALSE(!its_own && IsOwnFault(f.code, 1)) << "seed " << seed << ", " << name << ": " << f.message;
      }
      EXPECT_TRUE(found) << "seed " << seed << ": " << feature << " " << name;
    }
  }
}

}  // namespace
}  // namespace flaneur
