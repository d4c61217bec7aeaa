// Good obstacles, broken on purpose, one fault at a time: the fault is found at its obstacle, and nothing else is new.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <set>

#include "pipeline/footprint/check.h"
#include "pipeline/io/geojson.h"
#include "tests/unit/pipeline/footprint/test_town.h"

namespace flaneur {
namespace {

constexpr size_t kObstacles = 120;  // of a town, round a place
int TriesEach() {                   // more on request, to look for more
  const char* asked = std::getenv("FLANEUR_TRIES");
  return asked ? std::atoi(asked) : 10;
}

struct Case {
  Footprints footprints;
  CheckOptions options;
};

using Random = std::mt19937;

double Uniform(Random& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
}
size_t Below(Random& random, size_t n) { return random() % n; }

Point2 MiddleOf(const Ring& ring) {
  Point2 sum;
  for (const Point2& p : ring) sum = {sum.x + p.x, sum.y + p.y};
  return {sum.x / static_cast<double>(ring.size()), sum.y / static_cast<double>(ring.size())};
}

std::vector<Finding> RunCheck(const Case& broken) {
  std::vector<Finding> findings;
  EXPECT_EQ(Check(broken.footprints, nullptr, broken.options, &findings).message, "");
  return findings;
}

// What a fault is called, and how it is made; nothing where this obstacle does not lend itself to it. `feature`: where
// the finding belongs, if not to the obstacle.
struct Fault {
  const char* name;
  int code;
  std::function<bool(size_t at, Case* c, Random& random, std::string* feature)> make;
};

size_t LongestEdge(const Ring& ring) {
  size_t longest = 0;
  double most = 0;
  for (size_t i = 0; i < ring.size(); ++i) {
    const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
    if (const double d = std::hypot(b.x - a.x, b.y - a.y); d > most) most = d, longest = i;
  }
  return longest;
}

Point2 On(const Ring& ring, size_t edge, double t, double out = 0) {
  const Point2 a = ring[edge], b = ring[(edge + 1) % ring.size()];
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  return {a.x + t * (b.x - a.x) + out * (b.y - a.y) / length, a.y + t * (b.y - a.y) - out * (b.x - a.x) / length};
}

void Insert(Ring* ring, size_t edge, const Ring& points) {
  ring->insert(ring->begin() + static_cast<std::ptrdiff_t>(edge) + 1, points.begin(), points.end());
}

bool InsertSpike(Ring* ring, Random& random, double width, double length) {
  const size_t edge = LongestEdge(*ring);
  const double t = Uniform(random, 0.3, 0.6),
               edge_length = std::hypot(On(*ring, edge, 1).x - (*ring)[edge].x, On(*ring, edge, 1).y - (*ring)[edge].y);
  if (edge_length < 1) return false;
  const Point2 a = On(*ring, edge, t), b = On(*ring, edge, t + width / edge_length);
  if (width == 0) Insert(ring, edge, {a, On(*ring, edge, t, length), a});
  else Insert(ring, edge, {a, On(*ring, edge, t + width / edge_length / 2, length), b});
  return true;
}

Ring Square(Point2 middle, double half, bool clockwise = false) {
  Ring ring{{middle.x - half, middle.y - half},
            {middle.x + half, middle.y - half},
            {middle.x + half, middle.y + half},
            {middle.x - half, middle.y + half}};
  if (clockwise) std::reverse(ring.begin(), ring.end());
  return ring;
}

// A place well inside an obstacle; none where it is too narrow.
std::optional<Point2> Inside(const Obstacle& o, double room) {
  const Rings rooms = Offset({o.outer}, -room);
  if (rooms.empty() || !o.holes.empty()) return std::nullopt;
  return rooms[0][0];
}

std::vector<Fault> Faults() {
  const auto outer = [](std::function<bool(Ring*, Random&)> change) {
    return [change](size_t at, Case* c, Random& random, std::string*) {
      Ring& ring = c->footprints.obstacles[at].outer;
      return ring.size() >= 3 && change(&ring, random);
    };
  };
  return {
      {"two points", 101, outer([](Ring* r, Random&) { return r->resize(2), true; })},
      {"one point many times", 101, outer([](Ring* r, Random&) { return r->assign(5, (*r)[0]), true; })},
      {"near points", 102, outer([](Ring* r, Random& random) {
         const size_t i = Below(random, r->size());
         return Insert(r, i, {{(*r)[i].x + Uniform(random, 0, 0.0006), (*r)[i].y + Uniform(random, 0, 0.0006)}}), true;
       })},
      {"repeated point", 102, outer([](Ring* r, Random& random) {
         const size_t i = Below(random, r->size());
         return Insert(r, i, {(*r)[i]}), true;
       })},
      {"open ring", 103,
       [](size_t at, Case* c, Random&, std::string*) {
         if (c->footprints.obstacles[at].outer.empty()) return false;
         c->options.open_rings[at] = {0};
         return true;
       }},
      {"swapped points", 104, outer([](Ring* r, Random& random) {
         const size_t i = Below(random, r->size()), j = (i + 1) % r->size();
         if (r->size() < 5) return false;
         std::swap((*r)[i], (*r)[j]);
         return std::abs(SignedArea(*r)) > 1 && !Tidy({*r}, 0.01).empty() && Area(UnionOfRings({*r})) > 0 &&
                [&] {  // only where the edges beside them cross indeed
                  const size_t n = r->size();
                  const Point2 a = (*r)[(i + n - 1) % n], b = (*r)[i], p = (*r)[j], q = (*r)[(j + 1) % n];
                  const auto side = [](Point2 u, Point2 v, Point2 w) {
                    return (v.x - u.x) * (w.y - u.y) - (v.y - u.y) * (w.x - u.x);
                  };
                  return side(a, b, p) * side(a, b, q) < -1e-3 && side(p, q, a) * side(p, q, b) < -1e-3;
                }();
       })},
      {"turned ring", 105, outer([](Ring* r, Random&) { return std::reverse(r->begin(), r->end()), true; })},
      {"tiny", 106, outer([](Ring* r, Random&) {
         const Point2 middle = MiddleOf(*r);
         const double shrink = std::sqrt(0.005 / std::abs(SignedArea(*r)));
         for (Point2& p : *r) p = {middle.x + (p.x - middle.x) * shrink, middle.y + (p.y - middle.y) * shrink};
         return true;
       })},
      {"not a number", 107, outer([](Ring* r, Random& random) {
         return (*r)[Below(random, r->size())].y = std::numeric_limits<double>::quiet_NaN(), true;
       })},
      {"far away", 107, outer([](Ring* r, Random& random) { return (*r)[Below(random, r->size())].x = 1.5e6, true; })},
      {"many points", 108, outer([](Ring* r, Random&) {
         const size_t edge = LongestEdge(*r);
         Ring more;
         for (int i = 1; i < 300; ++i) more.push_back(On(*r, edge, i / 300.0));
         const double length = std::hypot(On(*r, edge, 1).x - (*r)[edge].x, On(*r, edge, 1).y - (*r)[edge].y);
         return length > 1 && (Insert(r, edge, more), true);
       })},
      {"no radius", 109,
       [](size_t at, Case* c, Random&, std::string*) {
         Obstacle tree;
         tree.name = "tree",
         tree.center = c->footprints.obstacles[at].outer.empty() ? Point2{} : c->footprints.obstacles[at].outer[0];
         c->footprints.obstacles[at] = tree;
         return false;  // takes an obstacle away: see the cases of circles in check_test.cpp
       }},
      {"hole outside", 201,
       [](size_t at, Case* c, Random&, std::string*) {
         Obstacle& o = c->footprints.obstacles[at];
         if (o.outer.empty()) return false;
         Point2 max{-1e300, -1e300};
         for (const Point2& p : o.outer) max = {std::max(max.x, p.x), std::max(max.y, p.y)};
         o.holes.push_back(Square({max.x + 2, max.y + 2}, 1, true));
         return true;
       }},
      {"holes overlap", 202,
       [](size_t at, Case* c, Random&, std::string*) {
         Obstacle& o = c->footprints.obstacles[at];
         const std::optional<Point2> place = o.outer.empty() ? std::nullopt : Inside(o, 2);
         if (!place) return false;
         o.holes = {Square(*place, 0.8, true), Square({place->x + 0.5, place->y}, 0.8, true)};
         return true;
       }},
      {"hairline spike", 203,
       outer([](Ring* r, Random& random) { return InsertSpike(r, random, 0, Uniform(random, 0.2, 3)); })},
      {"thin spike", 203,
       outer([](Ring* r, Random& random) { return InsertSpike(r, random, 0.012, Uniform(random, 0.3, 3)); })},
      {"copy", 402,
       [](size_t at, Case* c, Random&, std::string* feature) {
         Obstacle copy = c->footprints.obstacles[at];
         *feature = copy.name = "copy";
         c->footprints.obstacles.push_back(copy);
         c->options.open_rings.push_back(c->options.open_rings[at]);
         return true;
       }},
  };
}

using Key = std::tuple<int, std::string, std::string>;

std::multiset<Key> KeysOf(const std::vector<Finding>& findings) {
  std::multiset<Key> keys;
  for (const Finding& f : findings) {
    const bool pocket =
        f.code == 502 || f.code == 503;  // which of its ends is the deepest, and so its name, may change
    keys.insert({f.code, pocket ? "" : f.feature, f.other});
  }
  return keys;
}

std::string Listed(const std::multiset<Key>& keys) {
  std::string text;
  for (const auto& [code, feature, other] : keys)
    text += "  " + std::to_string(code) + " " + feature + " " + other + "\n";
  return text;
}

// Breaks obstacles at random; counts by fault how often it was found alone.
void BreakAndCheck(const Case& good, unsigned seed) {
  const std::multiset<Key> before = KeysOf(RunCheck(good));
  int broken = 0, missed = 0, more = 0;
  for (const Fault& fault : Faults()) {
    Random random(seed);
    for (int i = 0, made = 0; i < 10 * TriesEach() && made < TriesEach(); ++i) {
      Case c = good;
      const size_t at = Below(random, c.footprints.obstacles.size());
      std::string feature = c.footprints.obstacles[at].name;
      if (!fault.make(at, &c, random, &feature)) continue;
      ++made, ++broken;
      const std::multiset<Key> after = KeysOf(RunCheck(c));
      std::multiset<Key> fresh, gone;
      std::set_difference(before.begin(), before.end(), after.begin(), after.end(), std::inserter(gone, gone.end()));
      std::set_difference(after.begin(), after.end(), before.begin(), before.end(), std::inserter(fresh, fresh.end()));
      const bool found = std::any_of(fresh.begin(), fresh.end(), [&](const Key& k) {
        return std::get<0>(k) == fault.code && std::get<1>(k) == feature;
      });
      missed += !found, more += found && fresh.size() > 1;
      EXPECT_TRUE(found && fresh.size() == 1) << fault.name << " (" << fault.code << ") at " << feature << ", new:\n"
                                              << Listed(fresh) << " gone:\n"
                                              << Listed(gone);
    }
  }
  std::printf("%d faults made, %d not found, %d with more than themselves\n", broken, missed, more);
}

Case Town() {
  Case c;
  Random random(7);
  for (int i = 0; i < 60; ++i) {
    const double x = 30.0 * (i % 10), y = 30.0 * (i / 10);
    Obstacle o;
    o.name = "house_" + std::to_string(i);
    const double w = Uniform(random, 6, 18), h = Uniform(random, 6, 18);
    if (i % 3 == 0)
      o.outer = {{x, y}, {x + w, y}, {x + w, y + h}, {x + w / 2, y + h}, {x + w / 2, y + h / 2}, {x, y + h / 2}};
    else if (i % 3 == 1) o.outer = {{x, y}, {x + w, y + 1}, {x + w + 2, y + h / 2}, {x + w, y + h}, {x + 1, y + h}};
    else o.outer = Rectangle(x, y, x + w, y + h);
    c.footprints.obstacles.push_back(o);
    if (i % 4 != 0) continue;
    Obstacle neighbour;  // touches it, and has a gap to nobody
    neighbour.name = "annex_" + std::to_string(i);
    neighbour.outer = Rectangle(x, y - 4, x + w, y);
    if (o.outer[1].y == y) c.footprints.obstacles.push_back(neighbour);
  }
  c.options.open_rings.resize(c.footprints.obstacles.size());
  return c;
}

TEST(CheckMutation, MadeUpTown) {
  const Case town = Town();
  EXPECT_TRUE(RunCheck(town).empty());
  BreakAndCheck(town, 1);
}

TEST(CheckMutation, OldTownOfKrems) {
  const char* shared = std::getenv("FLANEUR_SHARED_DIR");
  const std::filesystem::path path =
      std::filesystem::path(shared ? shared : FLANEUR_SOURCE_DIR "/../shared") / "data/footprints/krems_old.geojson";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "needs " << path;
  GeoJsonFile file;
  ASSERT_EQ(ReadGeoJson(path, {}, &file).message, "");
  for (const Point2 place : {Point2{-640, -20}, Point2{-100, -150}}) {
    Case c;
    std::vector<Obstacle>& all = file.footprints.obstacles;
    const auto far = [&](const Obstacle& o) { return std::hypot(o.outer[0].x - place.x, o.outer[0].y - place.y); };
    std::sort(all.begin(), all.end(), [&](const Obstacle& a, const Obstacle& b) { return far(a) < far(b); });
    c.footprints.obstacles.assign(all.begin(), all.begin() + kObstacles);
    for (Obstacle& o : c.footprints.obstacles)
      if (SignedArea(o.outer) < 0) std::reverse(o.outer.begin(), o.outer.end());
    c.options.open_rings.resize(c.footprints.obstacles.size());
    for (const Way& way : file.ways) c.options.streets.push_back({way.name, way.points});
    BreakAndCheck(c, 2);
  }
}

}  // namespace
}  // namespace flaneur
