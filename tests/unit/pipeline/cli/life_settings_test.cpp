// What tour.toml says of a town's life besides its people.
#include "pipeline/cli/life_settings.h"

#include <gtest/gtest.h>

#include "pipeline/cli/tour_settings.h"
#include "pipeline/cli/work_clips.h"
#include "pipeline/core/temporary_folder.h"
#include "runtime/base/file.h"
#include "tests/unit/pipeline/cli/reads_tour.h"

namespace flaneur {
namespace {

const std::string kTour =
    "[town]\nfile = \"town.glb\"\n[[avatar]]\nname = \"dove\"\nshare = 0\nfile = \"dove.glb\"\n"
    "[[avatar]]\nfile = \"person.glb\"\n";

struct LifeSettings : ReadsTour {
  LifeSettings() : ReadsTour(kTour) {}
};

TEST_F(LifeSettings, AFlockHasAPlaceAndItsBirdsTheClipThatTheyFlyBy) {
  ASSERT_EQ(Read("[[flock]]\navatar = \"dove\"\nposition_m = [3, 4]\nbirds = 7\nclip = \"soar\"\n"), "");
  ASSERT_EQ(settings.flocks.size(), 1u);
  EXPECT_EQ(settings.flocks[0].position_m.y, 4);
  EXPECT_EQ(settings.flocks[0].birds, 7);
  EXPECT_EQ(settings.flocks[0].radius_m, Flock{}.radius_m);
  std::vector<std::string> warnings;
  ASSERT_FALSE(ChooseWorkClips({}, settings.flocks, &settings.avatars, &warnings));
  ASSERT_EQ(settings.avatars[0].clips.size(), 1u);
  EXPECT_EQ(settings.avatars[0].clips[0].name, "soar");
  EXPECT_TRUE(settings.avatars[1].clips.empty());
}

TEST_F(LifeSettings, WhatIsMissingOrWrongOfAFlockIsSaidInOneLine) {
  EXPECT_TRUE(Refuses("[[flock]]\navatar = \"dove\"\n", "a [[flock]] needs position_m"));
  EXPECT_TRUE(Refuses("[[flock]]\nposition_m = [0, 0]\n", "needs the name of an [[avatar]]"));
  EXPECT_TRUE(Refuses("[[flock]]\navatar = \"owl\"\nposition_m = [0, 0]\n", "no [[avatar]] has that name"));
  EXPECT_TRUE(Refuses("[[flock]]\navatar = \"dove\"\nposition_m = [0, 0]\nclip = \"walk\"\n", "a clip of its own"));
  EXPECT_TRUE(Refuses("[[flock]]\navatar = \"dove\"\nposition_m = [0, 0]\nbirds = 0\n", "flock.birds"));
  EXPECT_TRUE(
      Refuses("[[flock]]\navatar = \"dove\"\nposition_m = [0, 0]\nbirds = 150\n"
              "[[flock]]\navatar = \"dove\"\nposition_m = [9, 0]\nbirds = 51\n",
              "more than 200 birds"));
}

TEST_F(LifeSettings, SmokeHasAPlaceInTheTownsHeightAndTheTourItsWind) {
  ASSERT_EQ(Read("[[smoke]]\nposition_m = [3, -4, 12.5]\nwidth_m = 0.8\n[wind]\nyaw_deg = 90\nspeed_mps = 3\n"), "");
  ASSERT_EQ(settings.smokes.size(), 1u);
  EXPECT_EQ(settings.smokes[0].position_m.z, 12.5f);
  EXPECT_EQ(settings.smokes[0].width_m, 0.8f);
  EXPECT_EQ(settings.smokes[0].density, Smoke{}.density);
  EXPECT_NEAR(settings.wind.yaw_rad, kPi / 2, 1e-6f);
  EXPECT_EQ(settings.wind.speed_mps, 3);
}

TEST_F(LifeSettings, WhatIsMissingOrWrongOfSmokeIsSaidInOneLine) {
  EXPECT_TRUE(Refuses("[[smoke]]\n", "a [[smoke]] needs position_m = [x, y, z]"));
  EXPECT_TRUE(Refuses("[[smoke]]\nposition_m = [1, 2]\n", "a [[smoke]] needs position_m = [x, y, z]"));
  EXPECT_TRUE(Refuses("[[smoke]]\nposition_m = [1, 2, 3]\nwidth_m = 0\n", "smoke.width_m"));
  EXPECT_EQ(Read("[[smoke]]\nposition_m = [1, 2, 3]\nwidth_m = 0.1\n"), "") << "the least that the message names";
  EXPECT_TRUE(Refuses("[[smoke]]\nposition_m = [1, 2, 3]\ncolor = 2\n", "unknown key 'color' in [smoke]"));
  EXPECT_TRUE(Refuses("[wind]\nspeed_mps = -1\n", "wind.speed_mps"));
}

TEST_F(LifeSettings, APlaceOfPlayHasItsOwnDefaultsAndItsClipIsTakenWithItsSpeed) {
  ASSERT_EQ(
      Read("[[avatar]]\nname = \"child\"\nfile = \"child.glb\"\n[[avatar.clip]]\nname = \"run\"\nspeed_mps = 2.5\n"
           "[[place]]\nkind = \"play\"\nposition_m = [1, 2]\navatars = [\"child\"]\n"),
      "");
  const Place& place = settings.places.at(0);
  EXPECT_EQ(place.clip, "run");
  EXPECT_EQ(place.people, 3);
  EXPECT_EQ(place.width_m, 10);
  std::vector<std::string> warnings;
  ASSERT_FALSE(ChooseWorkClips(settings.places, {}, &settings.avatars, &warnings));
  EXPECT_TRUE(settings.avatars[1].clips.empty());
  ASSERT_EQ(settings.avatars[2].clips.size(), 1u);
  EXPECT_EQ(settings.avatars[2].clips[0].speed_mps, 2.5f);
  EXPECT_TRUE(Refuses("[[place]]\nposition_m = [0, 0]\npeople = 3\n", "people is for a [[place]] of kind \"play\""));
  EXPECT_TRUE(Refuses("[[place]]\nkind = \"play\"\nposition_m = [0, 0]\nwidth_m = 2\n", "width_m of 4 to 60"));
  EXPECT_TRUE(Refuses("[[place]]\nkind = \"play\"\nposition_m = [0, 0]\nseat_m = 1\n", "seat_m is for"));
}

}  // namespace
}  // namespace flaneur
