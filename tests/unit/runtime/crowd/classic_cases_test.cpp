// The small cases that steering is classically judged by (Singh, Kapadia, Faloutsos and Reinman 2009, SteerBench): few
// people, each with a start and a goal, standing at first, in the open or at an opening in a wall.
//
// Time over ideal: a person's seconds from standing until the goal's circle, over the seconds of the shortest way of a
// disc of their radius to that circle at their preferred speed, alone. Effort over ideal: the energy of walking, the
// integral of 2.23 + 1.26 v^2 (W/kg; Whittle 2008, as used by Guy et al. 2010, PLEdestrians) over the time, over the
// same for the shortest way at the preferred speed. Both are means over the people of a case, then over the cases.
// Stuck: not at the goal after 2.5 times the ideal time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "runtime/crowd/constants.h"
#include "runtime/crowd/crowd.h"

namespace flaneur {
namespace {

CrowdScratch scratch;
constexpr float kStep_s = 1.0f / 30, kRadius_m = 0.25f, kUsual_mps = 1.3f, kStuckAfter = 2.5f;

struct Walker {
  Vec2 from, to;
  float preferred_mps = kUsual_mps;
};
struct Gate {
  Vec2 a, b;
};  // everybody's shortest way crosses this segment, and the gates in order

struct Case {
  std::string name;
  std::vector<Walker> walkers;
  std::vector<PolygonObstacle> walls;
  std::vector<Gate> gates;  // in the order of growing x
};

struct Outcome {
  double time = 0, effort = 0;
  float deepest_touch_m = 0;
  int stuck = 0;
};

Vec2 OnGate(const Gate& g, Vec2 p, Vec2 q) {
  const Vec2 along = g.b - g.a, way = q - p;
  const float across = Cross(way, along);
  const float t = std::abs(across) > 1e-6f ? Cross(g.a - p, way) / across : 0.5f;
  return g.a + along * std::clamp(t, 0.0f, 1.0f);
}

// The taut string from start to goal through the gates: each point on its gate is moved to where its neighbours' line
// crosses.
float ShortestWay_m(const Case& c, const Walker& walker) {
  std::vector<Vec2> points{walker.from};
  std::vector<Gate> gates = c.gates;
  if (walker.to.x < walker.from.x) std::reverse(gates.begin(), gates.end());
  for (const Gate& g : gates) points.push_back((g.a + g.b) * 0.5f);
  points.push_back(walker.to);
  for (int pass = 0; pass < 200; ++pass) {
    for (size_t k = 1; k + 1 < points.size(); ++k) points[k] = OnGate(gates[k - 1], points[k - 1], points[k + 1]);
  }
  float way_m = 0;
  for (size_t k = 1; k < points.size(); ++k) way_m += Length(points[k] - points[k - 1]);
  return way_m - kArrival_m;
}

double Power(double speed_mps) { return 2.23 + 1.26 * speed_mps * speed_mps; }

PolygonObstacle Box(float x0, float y0, float x1, float y1) { return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}}; }

Outcome Play(const Case& c) {
  Walkable w;
  w.ground = Share({{-20, -20}, 0.5f, 80, 80, std::vector<float>(6400, 0), std::vector<uint8_t>(6400, 3)});
  w.polygons = c.walls;
  BuildWalkable(0.3f, &w, kRadius_m);
  Crowd crowd;
  std::vector<float> ideal_s;
  for (const Walker& walker : c.walkers) {
    Person p;
    p.position = walker.from;
    p.heading_rad = std::atan2(walker.to.y - walker.from.y, walker.to.x - walker.from.x);
    p.radius_m = kRadius_m;
    p.preferred_mps = walker.preferred_mps;
    p.field = FieldFor(walker.to, &crowd);
    AddPerson(p, &crowd);
    crowd.view.back() = ViewClass::kVisible;
    ideal_s.push_back(ShortestWay_m(c, walker) / walker.preferred_mps);
  }
  const float longest_s = *std::max_element(ideal_s.begin(), ideal_s.end());
  Outcome outcome;
  const double people = static_cast<double>(c.walkers.size());
  std::vector<double> effort(c.walkers.size(), 0);
  for (int step = 1; crowd.size() > 0 && static_cast<float>(step) * kStep_s < kStuckAfter * longest_s; ++step) {
    StepCrowd(w, {}, kStep_s, &scratch, &crowd);
    for (size_t i = 0; i < crowd.size(); ++i) {
      effort[static_cast<size_t>(crowd.id[i])] += Power(Length(crowd.velocity[i])) * kStep_s;
      for (size_t j = 0; j < i; ++j) {
        const float touch_m = 2 * kRadius_m - Length(crowd.position[i] - crowd.position[j]);
        outcome.deepest_touch_m = std::max(outcome.deepest_touch_m, touch_m);
      }
    }
    for (size_t i = crowd.size(); i-- > 0;) {
      if (crowd.arrived[i] != Arrival::kThere) continue;
      const size_t id = static_cast<size_t>(crowd.id[i]);
      outcome.time += step * kStep_s / ideal_s[id] / people;
      outcome.effort += effort[id] / (Power(c.walkers[id].preferred_mps) * ideal_s[id]) / people;
      RemovePerson(i, &crowd);
    }
  }
  outcome.stuck = static_cast<int>(crowd.size());
  return outcome;
}

Vec2 Direction(float degrees) { return {std::cos(degrees * kPi / 180), std::sin(degrees * kPi / 180)}; }

std::string Named(const char* format, float a, float b) {
  char text[96];
  std::snprintf(text, sizeof text, format, static_cast<double>(a), static_cast<double>(b));
  return text;
}

void AddHeadOn(std::vector<Case>* cases) {
  for (float aside_m : {0.0f, 0.1f, 0.25f, 0.4f}) {
    for (float other_mps : {kUsual_mps, 0.9f}) {
      cases->push_back({Named("head-on, %.2f m aside, against %.1f m/s", aside_m, other_mps),
                        {{{-8, 0}, {8, 0}}, {{8, aside_m}, {-8, aside_m}, other_mps}},
                        {},
                        {}});
    }
  }
}

void AddCrossing(std::vector<Case>* cases) {
  for (float angle_deg : {30.0f, 60.0f, 90.0f, 120.0f, 150.0f}) {
    for (float behind_m : {0.0f, 0.3f}) {
      const Vec2 way = Direction(angle_deg);
      cases->push_back({Named("crossing at %.0f degrees, %.1f m behind", angle_deg, behind_m),
                        {{{-8, 0}, {8, 0}}, {way * -(8 + behind_m), way * 8}},
                        {},
                        {}});
    }
  }
}

void AddOvertaking(std::vector<Case>* cases) {
  for (float slow_mps : {0.7f, 0.9f, 1.1f}) {
    for (float aside_m : {0.0f, 0.2f}) {
      cases->push_back({Named("overtaking %.1f m/s, %.1f m aside", slow_mps, aside_m),
                        {{{-9, 0}, {12, 0}, 1.5f}, {{-6, aside_m}, {9, aside_m}, slow_mps}},
                        {},
                        {}});
    }
  }
}

// A wall of 0.3 m along y with an opening.
Case WithOpening(std::string name, float width_m) {
  const float half_m = 0.5f * width_m, way_m = half_m - kRadius_m;
  return {std::move(name),
          {},
          {Box(-0.15f, -20, 0.15f, -half_m), Box(-0.15f, half_m, 0.15f, 20)},
          {{{-0.15f, -way_m}, {-0.15f, way_m}}, {{0.15f, -way_m}, {0.15f, way_m}}}};
}

// Rows of people on either side, 0.9 m from each other.
void AddRows(int people, float side, int abreast, Case* c) {
  for (int k = 0; k < people; ++k) {
    const float y_m =
        0.9f * (static_cast<float>(k % abreast) - 0.5f * static_cast<float>(std::min(people, abreast) - 1));
    const float back_m = 1.2f * static_cast<float>(k / abreast);
    c->walkers.push_back({{side * (7 + back_m), y_m}, {-side * (8 - back_m), y_m}});
  }
}

void AddDoorways(std::vector<Case>* cases) {
  for (float width_m : {1.0f, 1.5f}) {
    Case meeting = WithOpening(Named("doorway of %.1f m, one from each side", width_m, 0), width_m);
    AddRows(1, -1, 1, &meeting), AddRows(1, 1, 1, &meeting);
    cases->push_back(meeting);
    for (int people : {3, 6}) {
      Case squeeze =
          WithOpening(Named("doorway of %.1f m, %.0f together", width_m, static_cast<float>(people)), width_m);
      AddRows(people, -1, 3, &squeeze);
      cases->push_back(squeeze);
    }
  }
}

void AddGroups(std::vector<Case>* cases) {
  for (float width_m : {3.0f, 4.0f}) {
    for (int people : {2, 4, 6}) {
      Case c = WithOpening(Named("gap of %.0f m, groups of %.0f", width_m, static_cast<float>(people)), width_m);
      AddRows(people, -1, 2, &c), AddRows(people, 1, 2, &c);
      cases->push_back(c);
    }
  }
}

void AddCircles(std::vector<Case>* cases) {
  for (float radius_m : {6.0f, 9.0f}) {
    for (int people : {4, 6, 10}) {
      Case c{Named("circle of %.0f m, %.0f swap", radius_m, static_cast<float>(people)), {}, {}, {}};
      for (int k = 0; k < people; ++k) {
        const Vec2 from = Direction(360.0f * static_cast<float>(k) / static_cast<float>(people)) * radius_m;
        c.walkers.push_back({from, from * -1});
      }
      cases->push_back(c);
    }
  }
}

// Two ways along the walls of a house meet behind its corner.
void AddSurprises(std::vector<Case>* cases) {
  for (float behind_m : {-0.4f, 0.0f, 0.4f}) {
    for (int others : {1, 2}) {
      Case c{Named("corner, %.1f m behind, against %.0f", behind_m, static_cast<float>(others)),
             {{{-8, -0.5f}, {8, -0.5f}}},
             {Box(-20, -20, -1, -1)},
             {}};
      for (int k = 0; k < others; ++k) {
        const float back_m = behind_m + 0.9f * static_cast<float>(k);
        c.walkers.push_back({{-0.5f, -8 - back_m}, {-0.5f, 8 - 0.9f * static_cast<float>(k)}});
      }
      cases->push_back(c);
    }
  }
}

std::vector<Case> AllCases() {
  std::vector<Case> cases;
  AddHeadOn(&cases), AddCrossing(&cases), AddOvertaking(&cases), AddDoorways(&cases), AddGroups(&cases);
  AddCircles(&cases), AddSurprises(&cases);
  return cases;
}

TEST(ClassicCases, NobodyTouchesOrIsStuckAndAllGetOn) {
  const std::vector<Case> cases = AllCases();
  double time = 0, effort = 0;
  int clean = 0;
  std::printf("%-44s %6s %6s %8s %5s\n", "case", "time", "effort", "touch cm", "stuck");
  for (const Case& c : cases) {
    const Outcome o = Play(c);
    std::printf("%-44s %6.3f %6.3f %8.1f %5d\n", c.name.c_str(), o.time, o.effort,
                100 * static_cast<double>(o.deepest_touch_m), o.stuck);
    time += o.time / static_cast<double>(cases.size());
    effort += o.effort / static_cast<double>(cases.size());
    clean += o.deepest_touch_m <= 0.02f && o.stuck == 0 ? 1 : 0;
    EXPECT_LE(o.deepest_touch_m, 0.02f) << c.name;
    EXPECT_EQ(o.stuck, 0) << c.name;
  }
  std::printf("%zu cases, %d clean, time over ideal %.3f, effort over ideal %.3f\n", cases.size(), clean, time, effort);
  EXPECT_LE(time, 1.06);
  EXPECT_LE(effort, 1.04);
}

}  // namespace
}  // namespace flaneur
