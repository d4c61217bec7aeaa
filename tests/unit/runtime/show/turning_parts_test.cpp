// Weathercocks and the hands of clocks.
#include "runtime/show/turning_parts.h"

#include <gtest/gtest.h>

#include "runtime/crowd/fast_math.h"
#include "runtime/show/wind.h"

namespace flaneur {
namespace {

std::vector<float> Turned(const TourPack& pack, float time_s, float hour) {
  FrameInput frame;
  TurnParts(pack, time_s, hour, &frame);
  return frame.turns_rad;
}

TEST(TurningParts, HandsShowTheHour) {
  TourPack pack;
  pack.turning = {{TurnsBy::kHourHand, {}, {1, 0, 0}, 0}, {TurnsBy::kMinuteHand, {}, {1, 0, 0}, 0}};
  struct Case {
    float hour, hour_deg, minute_deg;
  };
  for (const Case& c : {Case{0, 0, 0}, {3, 90, 0}, {15, 90, 0}, {18.5f, 195, 180}, {23.75f, 352.5f, 270}}) {
    const std::vector<float> turns = Turned(pack, 0, c.hour);
    ASSERT_EQ(turns.size(), 2u);
    EXPECT_NEAR(WrapAngle(turns[0] + c.hour_deg * kPi / 180), 0, 1e-4f) << c.hour;
    EXPECT_NEAR(WrapAngle(turns[1] + c.minute_deg * kPi / 180), 0, 1e-4f) << c.hour;
  }
}

TEST(TurningParts, AWeathercockLooksIntoTheWindWhereverItIsModelledTo) {
  TourPack pack;
  pack.wind.yaw_rad = 2;
  pack.wind.speed_mps = 3;
  for (float yaw_rad = -3; yaw_rad <= 3; yaw_rad += 1.5f) {
    pack.turning = {{TurnsBy::kWind, {5, 5, 20}, {0, 0, 1}, yaw_rad}};
    float least = 10, most = -10;
    for (float time_s = 0; time_s < 120; time_s += 0.5f) {
      const float into = WrapAngle(Turned(pack, time_s, 12)[0] + yaw_rad - (pack.wind.yaw_rad + kPi));
      least = std::min(least, into);
      most = std::max(most, into);
    }
    EXPECT_GT(least, -0.5f);
    EXPECT_LT(most, 0.5f);
    EXPECT_GT(most - least, 0.2f) << "gusts move it";
  }
  pack.wind.speed_mps = 0;
  EXPECT_EQ(Turned(pack, 7, 12)[0], 0) << "as it is modelled";
}

}  // namespace
}  // namespace flaneur
