#include "runtime/crowd/groups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "runtime/crowd/crowd.h"
#include "runtime/crowd/fast_math.h"

namespace flaneur {
namespace {

CrowdScratch scratch;
constexpr float kStep_s = 1.0f / 30;

// A square of 60 m; with a doorway, a wall across its middle leaves an opening so wide.
Walkable Square(float doorway_m = 0) {
  Walkable w;
  w.ground = Share({{-30, -30}, 0.5f, 120, 120, std::vector<float>(14400, 0), std::vector<uint8_t>(14400, 3)});
  if (doorway_m > 0) {
    const float half = doorway_m / 2;
    w.polygons.push_back({{{0, -30}, {0.4f, -30}, {0.4f, -half}, {0, -half}}, {}});
    w.polygons.push_back({{{0, half}, {0.4f, half}, {0.4f, 30}, {0, 30}}, {}});
  }
  BuildWalkable(0.3f, &w);
  return w;
}

// People one behind the other on the way from `from` to `to`, all in view, as a group.
void AddWalkers(int count, Vec2 from, Vec2 to, Crowd* c) {
  std::vector<int> members;
  const Vec2 back = (from - to) * (1 / Length(to - from));
  for (int k = 0; k < count; ++k) {
    Person p;
    p.position = from + back * (0.8f * static_cast<float>(k));
    p.heading_rad = std::atan2(-back.y, -back.x);
    p.preferred_mps = 1.4f - 0.1f * static_cast<float>(k);
    p.field = FieldFor(to, c);
    members.push_back(static_cast<int>(c->size()));
    AddPerson(p, c);
    c->view.back() = ViewClass::kVisible;
  }
  AddGroup(members, c);
}

float MostApart_m(const Crowd& c, size_t first, size_t count) {
  float most_m = 0;
  for (size_t i = first; i < first + count; ++i) {
    for (size_t j = first; j < i; ++j) most_m = std::max(most_m, Length(c.position[i] - c.position[j]));
  }
  return most_m;
}

void ExpectNobodyTouches(const Crowd& c) {
  for (size_t i = 0; i < c.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      ASSERT_GT(Length(c.position[i] - c.position[j]), c.radius_m[i] + c.radius_m[j] - 0.02f) << i << " and " << j;
    }
  }
}

TEST(Groups, APairWalksAbreast) {
  const Walkable w = Square();
  Crowd c;
  AddWalkers(2, {-25, 0}, {25, 3}, &c);
  int steps = 0, close = 0, abreast = 0;
  while (c.position[0].x < 18 && steps < 3000) {
    StepCrowd(w, {}, kStep_s, &scratch, &c);
    const Vec2 apart = c.position[0] - c.position[1], ahead = DirectionOf(c.heading_rad[0]);
    close += Length(apart) < 1.5f ? 1 : 0;
    abreast += std::abs(Cross(ahead, apart)) > std::abs(Dot(ahead, apart)) ? 1 : 0;
    ++steps;
  }
  ASSERT_LT(steps, 3000);
  EXPECT_EQ(close, steps);
  EXPECT_GT(abreast, 0.8 * steps);
  const float elbow_m = Length(c.position[0] - c.position[1]) - c.radius_m[0] - c.radius_m[1];
  EXPECT_GT(elbow_m, 0.2f);
  EXPECT_LT(elbow_m, 0.6f);
}

TEST(Groups, FourBendIntoAShallowU) {
  const Walkable w = Square();
  Crowd c;
  AddWalkers(4, {-25, 0}, {25, 0}, &c);
  for (int step = 0; step < 600; ++step) StepCrowd(w, {}, kStep_s, &scratch, &c);
  std::vector<Vec2> row = c.position;
  std::sort(row.begin(), row.end(), [](Vec2 a, Vec2 b) { return a.y < b.y; });
  EXPECT_GT(row[3].y - row[0].y, 2.0f);
  EXPECT_LT(std::max(row[1].x, row[2].x), std::min(row[0].x, row[3].x)) << "the inner ones walk slightly back";
  EXPECT_LT(MostApart_m(c, 0, 4), 3.5f);
}

TEST(Groups, GoThroughADoorwayInFileAndMeetAgain) {
  const Walkable w = Square(0.9f);
  for (int count = 2; count <= kMaxGroupSize; ++count) {
    Crowd c;
    AddWalkers(count, {-10, 1}, {25, 0}, &c);
    const size_t people = c.size();
    const auto last_x = [&] {
      float x = 1e9f;
      for (Vec2 p : c.position) x = std::min(x, p.x);
      return x;
    };
    int step = 0;
    for (; last_x() < 0.5f && step < 900; ++step) {
      StepCrowd(w, {}, kStep_s, &scratch, &c);
      ExpectNobodyTouches(c);
    }
    ASSERT_LT(step, 750) << count << " people within 25 s through the door";
    for (step = 0; step < 240; ++step) StepCrowd(w, {}, kStep_s, &scratch, &c);
    EXPECT_LT(MostApart_m(c, 0, people), 1.05f * static_cast<float>(count - 1))
        << count << " are together 8 s behind the door";
  }
}

TEST(Groups, MeetOthersWithoutTouching) {
  const Walkable w = Square(3);
  Crowd c;
  AddWalkers(4, {-15, 0}, {15, 0}, &c);
  AddWalkers(3, {15, 1}, {-15, 1}, &c);
  AddWalkers(2, {-15, 8}, {15, 8}, &c);
  AddWalkers(2, {15, -8}, {-15, -8}, &c);
  std::vector<int> arrived(c.size(), 0);
  for (int step = 0; step < 1500; ++step) {
    StepCrowd(w, {}, kStep_s, &scratch, &c);
    ExpectNobodyTouches(c);
    for (size_t i = 0; i < c.size(); ++i) arrived[i] |= c.arrived[i] == Arrival::kThere ? 1 : 0;
  }
  EXPECT_EQ(std::count(arrived.begin(), arrived.end(), 1), static_cast<int>(c.size()));
}

TEST(Groups, TheOneAheadWaits) {
  const Walkable w = Square();
  Crowd c;
  AddWalkers(2, {-15, 0}, {25, 0}, &c);
  c.position[1] = {-25, 0};
  for (int step = 0; step < 600; ++step) StepCrowd(w, {}, kStep_s, &scratch, &c);
  EXPECT_LT(MostApart_m(c, 0, 2), 1.5f);
  EXPECT_LT(c.position[0].x, 22) << "met on the way, not at its end";
}

TEST(Groups, ADetourComesFirst) {
  const Walkable w = Square();
  Crowd c;
  AddWalkers(2, {-20, 0}, {25, 0}, &c);
  for (int step = 0; step < 90; ++step) StepCrowd(w, {}, kStep_s, &scratch, &c);
  c.detour[0] = {0, 1.2f};
  c.detour_s[0] = 3;
  for (int step = 0; step < 85; ++step) StepCrowd(w, {}, kStep_s, &scratch, &c);
  EXPECT_GT(c.position[0].y, 2.0f);
  for (int step = 0; step < 450; ++step) StepCrowd(w, {}, kStep_s, &scratch, &c);
  EXPECT_LT(MostApart_m(c, 0, 2), 1.5f);
}

// Who is left when others are removed, in whatever order, still is in the right group.
TEST(Groups, StayTheSamePeopleWhenOthersGo) {
  Crowd c;
  Random random{3};
  for (int g = 0; g < 30; ++g) AddWalkers(2 + g % 3, {-20, static_cast<float>(g)}, {20, static_cast<float>(g)}, &c);
  std::vector<float> row_of_id;
  for (Vec2 p : c.position) row_of_id.push_back(p.y);
  while (c.size() > 0) {
    RemovePerson(static_cast<size_t>(random.Below(static_cast<int>(c.size()))), &c);
    size_t in_groups = 0;
    for (size_t g = 0; g < c.groups.size(); ++g) {
      const Group& group = c.groups[g];
      ASSERT_GE(group.size, 2);
      for (int k = 0; k < group.size; ++k) {
        const size_t i = static_cast<size_t>(group.member[k]);
        ASSERT_LT(i, c.size());
        ASSERT_EQ(c.group[i], static_cast<int>(g));
        ASSERT_EQ(row_of_id[static_cast<size_t>(c.id[i])],
                  row_of_id[static_cast<size_t>(c.id[static_cast<size_t>(group.member[0])])]);
      }
      in_groups += static_cast<size_t>(group.size);
    }
    ASSERT_EQ(in_groups,
              static_cast<size_t>(std::count_if(c.group.begin(), c.group.end(), [](int g) { return g >= 0; })));
  }
}

}  // namespace
}  // namespace flaneur
