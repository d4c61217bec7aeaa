// No jam lasts: rooms full of people empty through every door that is wider than a body.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/unit/runtime/crowd/rooms.h"

namespace flaneur {
namespace {

constexpr float kMost_s = 900;

RoomPlan PlainRoom(float radius_m, float door_m) {
  RoomPlan plan;
  plan.radius_m.assign(100, radius_m);
  plan.door_m = door_m;
  plan.width_m = plan.depth_m = std::sqrt(100 * kPi * radius_m * radius_m / 0.35f);
  plan.wall_m = 0.3f;
  return plan;
}

// Large people before doors of ordinary houses, and doors that hold one body and a hand's breadth.
TEST(Rooms, DoorsWiderThanABodyEmptyThemWhateverTheBodies) {
  const struct {
    float radius_m, door_m;
  } rooms[] = {{0.33f, 1.0f}, {0.5f, 1.4f}, {0.4f, 1.2f}, {0.2f, 0.42f}, {0.5f, 1.05f}};
  for (const auto& r : rooms) {
    Room room = MakeRoom(PlainRoom(r.radius_m, r.door_m));
    const RoomOutcome o = EmptyRoom(&room, kMost_s);
    std::printf("radius %.2f m, door %.2f m: empty after %.0f s\n", static_cast<double>(r.radius_m),
                static_cast<double>(r.door_m), static_cast<double>(o.empty_s));
    EXPECT_EQ(o.left, 0) << r.radius_m << " m before " << r.door_m << " m";
    EXPECT_LE(o.longest_s, 60) << r.radius_m << " m before " << r.door_m << " m";
  }
}

TEST(Rooms, RandomOnesEmpty) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const RoomPlan plan = RandomRoom(seed);
    Room room = MakeRoom(plan);
    EXPECT_EQ(EmptyRoom(&room, kMost_s).left, 0) << Described(plan);
  }
}

// In the first three the last one stood beside the door, pushed off its far jamb; the fourth had no way through its
// door, whose cells met those of the room at a corner only.
TEST(Rooms, WhoStandsBesideADoorFindsItAndWaysThroughDoorsAreWhole) {
  for (uint64_t seed : {120, 295, 547, 681, 848}) {
    const RoomPlan plan = RandomRoom(seed);
    Room room = MakeRoom(plan);
    EXPECT_EQ(EmptyRoom(&room, kMost_s).left, 0) << Described(plan);
  }
}

// Everybody to one place, and from there to a place of their own: who leaves has to get through who comes.
TEST(Rooms, LargePeopleReachACommonGoalAndLeaveIt) {
  constexpr int kPeople = 100;
  Room room;
  room.walkable.ground =
      Share({{-36, -36}, 0.5f, 144, 144, std::vector<float>(144 * 144, 0), std::vector<uint8_t>(144 * 144, 3)});
  BuildWalkable(0.55f, &room.walkable, 0.5f);
  Crowd& c = room.crowd;
  for (int k = 0; k < kPeople; ++k) {
    Person p;
    p.position = Vec2{std::cos(0.44f * static_cast<float>(k)), std::sin(0.44f * static_cast<float>(k))} *
                 (9 + 1.6f * static_cast<float>(k % 10));
    p.radius_m = 0.5f;
    p.field = FieldFor({}, &c);
    AddPerson(p, &c);
    c.view.back() = ViewClass::kVisible;
  }
  std::vector<bool> was_there(kPeople, false);
  for (int step = 0; step < 30 * 240 && c.size() > 0; ++step) {
    StepCrowd(room.walkable, {}, kRoomStep_s, &room.scratch, &c);
    for (size_t i = c.size(); i-- > 0;) {
      const size_t id = static_cast<size_t>(c.id[i]);
      if (was_there[id] && c.arrived[i] == Arrival::kThere) {
        RemovePerson(i, &c);
      } else if (!was_there[id] && c.arrived[i] != Arrival::kNot) {
        was_there[id] = true;
        const float angle = 2.4f * static_cast<float>(id);
        SetGoal(i, FieldFor(Vec2{std::cos(angle), std::sin(angle)} * 30, &c), &c);
      }
    }
  }
  EXPECT_EQ(c.size(), 0u);
}

}  // namespace
}  // namespace flaneur
