#include "pipeline/io/map_projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

namespace flaneur {
namespace {

// Of a town somewhere in the system's area, within `wide_m` of each other, in the system's coordinates.
std::vector<Point2> PlacesIn(const std::string& name, const MapSystem& system, double wide_m, std::mt19937* random) {
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>((*random)()) / 4294967296.0);
  };
  const double high = system.east < system.west ? system.east + 360 : system.east;
  std::vector<Point2> places{{uniform(0.1, 0.9) * (high - system.west) + system.west,
                              uniform(0.1, 0.9) * (system.north - system.south) + system.south}};
  if (places[0].x > 180) places[0].x -= 360;
  if (TransformPoints(kLongitudeLatitude, name, &places)) return {};
  for (int i = 0; i < 20; ++i)
    places.push_back({places[0].x + uniform(-wide_m, wide_m), places[0].y + uniform(-wide_m, wide_m)});
  return places;
}

double Farthest(const std::vector<Point2>& a, const std::vector<Point2>& b) {
  double most = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const double d = std::hypot(a[i].x - b[i].x, a[i].y - b[i].y);
    if (!(d <= most)) most = d;
  }
  return most;
}

// As a town goes to longitude and latitude, from there to a plan, and back.
double LostOnTheWay(const std::string& name, std::vector<Point2> places, std::vector<Point2>* on_earth) {
  *on_earth = places;
  if (TransformPoints(name, kLongitudeLatitude, on_earth)) return HUGE_VAL;
  std::vector<Point2> back = *on_earth;
  const std::string local = LocalMapSystem((*on_earth)[0]);
  if (TransformPoints(kLongitudeLatitude, local, &back) || TransformPoints(local, name, &back)) return HUGE_VAL;
  return Farthest(places, back);
}

class KnownSystem : public testing::TestWithParam<const char*> {};

TEST_P(KnownSystem, ThereAndBackIsWhereItWas) {
  std::mt19937 random(5);
  MapSystem system;
  ASSERT_EQ(FindMapSystem(GetParam(), &system).message, "");
  for (int i = 0; i < 2; ++i) {
    std::vector<Point2> on_earth;
    const std::vector<Point2> places = PlacesIn(GetParam(), system, 3000, &random);
    ASSERT_FALSE(places.empty());
    EXPECT_LT(LostOnTheWay(GetParam(), places, &on_earth), 1e-4);
  }
}
INSTANTIATE_TEST_SUITE_P(Datums, KnownSystem,
                         testing::Values("EPSG:2056", "EPSG:21781", "EPSG:7415", "EPSG:28992", "EPSG:31467",
                                         "EPSG:25833", "EPSG:3068", "EPSG:27700", "EPSG:31256", "EPSG:31370",
                                         "EPSG:5514", "EPSG:2180", "EPSG:23032", "EPSG:2100", "EPSG:26910",
                                         "EPSG:26710", "EPSG:6677", "EPSG:2193", "EPSG:28355", "EPSG:2154"));

// FLANEUR_MANY_SYSTEMS=3000 goes on for longer.
TEST(MapProjection, SystemsAtRandomLeadThereAndBack) {
  std::mt19937 random(27);
  const char* const more = std::getenv("FLANEUR_MANY_SYSTEMS");
  const int wanted = more ? std::atoi(more) : 15;
  int tried = 0;
  for (int codes = 0; tried < wanted && codes < 100 * wanted; ++codes) {
    const std::string name = "EPSG:" + std::to_string(2000 + random() % 30761);
    MapSystem system;
    if (FindMapSystem(name, &system) || !system.has_area || system.degrees || !system.other_unit.empty()) continue;
    const std::vector<Point2> places = PlacesIn(name, system, 3000, &random);
    if (places.empty() || !std::isfinite(places[0].x)) continue;
    ++tried;
    std::vector<Point2> on_earth;
    EXPECT_LT(LostOnTheWay(name, places, &on_earth), 5e-4) << name;
    EXPECT_TRUE(IsUsedAt(system, on_earth[0], 0.1) || system.east < system.west) << name;
  }
  EXPECT_EQ(tried, wanted);
}

TEST(MapProjection, AllPointsOfATownGoTheSameWay) {
  // On the border of two ways from NAD27 to WGS 84, which are metres apart.
  std::vector<Point2> a, b;
  for (int i = 0; i <= 20; ++i) a.push_back({-100.0 - i * 1e-4, 40 + i * 1e-4});
  b = a;
  ASSERT_EQ(TransformPoints(kLongitudeLatitude, "EPSG:4267", &b).message, "");
  for (size_t i = 1; i < a.size(); ++i) {
    EXPECT_NEAR(b[i].x - b[i - 1].x, a[i].x - a[i - 1].x, 1e-8);
    EXPECT_NEAR(b[i].y - b[i - 1].y, a[i].y - a[i - 1].y, 1e-8);
  }
}

TEST(MapProjection, TheSystemInMetresThatFits) {
  EXPECT_EQ(MetricSystemAt("EPSG:6697", {139.7, 35.5}), "EPSG:6691");
  EXPECT_EQ(MetricSystemAt("EPSG:4258", {10.5, 52.1}), "EPSG:25832");
  EXPECT_EQ(MetricSystemAt("EPSG:4326", {-70.6, -33.4}), "EPSG:32719");
  EXPECT_EQ(MetricSystemAt("EPSG:4979", {10.5, 52.1}), "EPSG:32632");
  EXPECT_NE(MetricSystemAt("EPSG:4326", {10.5, 89}).find("+proj=tmerc"), std::string::npos);
}

class MeridianOfSystem : public testing::TestWithParam<const char*> {};

TEST_P(MeridianOfSystem, DegreesFromGreenwich) {
  MapSystem system;
  ASSERT_EQ(FindMapSystem(GetParam(), &system).message, "");
  ASSERT_TRUE(system.degrees && system.has_area);
  EXPECT_NE(system.meridian_deg, 0);
  const Point2 place{(system.west + system.east) / 2, (system.south + system.north) / 2};
  std::vector<Point2> there{place};
  ASSERT_EQ(TransformPoints(kLongitudeLatitude, GetParam(), &there).message, "");
  const Point2 back = FromGreenwich(system, there[0]);
  EXPECT_NEAR(back.x, place.x, 0.05) << "but for the datum";
  EXPECT_NEAR(back.y, place.y, 0.05);
}
// Athens, Ferro, Bern, Bogota, Rome, Jakarta, Oslo; Paris in grads.
INSTANTIATE_TEST_SUITE_P(Geographic, MeridianOfSystem,
                         testing::Values("EPSG:4815", "EPSG:4818", "EPSG:5229", "EPSG:4801", "EPSG:4802", "EPSG:4806",
                                         "EPSG:4813", "EPSG:4817", "EPSG:4807", "EPSG:4810", "EPSG:4819"));

TEST(MapProjection, HeightsAloneAreNoMap) {
  MapSystem system;
  for (const char* name : {"EPSG:5723", "EPSG:4978"})
    EXPECT_NE(FindMapSystem(name, &system).message.find("none of a map"), std::string::npos) << name;
}

TEST(MapProjection, MapsOfMetres) {
  EXPECT_TRUE(IsMapOfMetres("EPSG:25832", {604000, 5779000}));
  EXPECT_TRUE(IsMapOfMetres("EPSG:2056", {2683000, 1248000}));
  EXPECT_TRUE(IsMapOfMetres("EPSG:5514", {-743000, -1043000}));
  EXPECT_FALSE(IsMapOfMetres("EPSG:3857", {1172000, 6830000})) << "stretched";
  EXPECT_FALSE(IsMapOfMetres("EPSG:2065", {1043000, 743000})) << "mirrored: south, west";
  EXPECT_FALSE(IsMapOfMetres("EPSG:2048", {47400, 3750000})) << "turned: west, south";
}

}  // namespace
}  // namespace flaneur
