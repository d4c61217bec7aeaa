#include "pipeline/cli/work_clips.h"

#include <gtest/gtest.h>

namespace flaneur {
namespace {

TourAvatar Person(const std::string& name, float share, const std::vector<TourClip>& clips) {
  TourAvatar person;
  person.levels.avatar.name = name;
  person.share = share;
  person.levels.avatar.clips = {{"walk", 1, 2, {}}};
  for (const TourClip& clip : clips) person.levels.avatar.clips.push_back({clip.name, 1, 2, {}});
  person.clips = clips;
  return person;
}

Place At(const std::string& name, const std::string& kind, const std::string& clip,
         std::vector<std::string> avatars = {}) {
  Place place;
  place.name = name, place.kind = kind;
  place.clip = clip;
  place.avatars = std::move(avatars);
  return place;
}

TEST(WarningsOfWork, PlacesThatNobodyCanWorkOrPlayAtAreNamedByTheirClip) {
  TourParts tour;
  tour.avatars.push_back(Person("farmer", 1, {{"sweep"}, {"run"}}));
  tour.avatars.push_back(Person("child", 0, {{"run", 0, 2.5f}}));
  tour.places = {At("yard", "work", "sweep"),
                 At("bench", "work", "sit"),
                 At("step", "work", "sit"),
                 At("post", "work", ""),
                 At("green", "play", "run"),
                 At("lawn", "play", "run", {"child"}),
                 At("mine", "work", "sweep", {"child"}),
                 At("well", "goal", "")};
  const std::vector<std::string> warnings = WarningsOfWork(tour);
  ASSERT_EQ(warnings.size(), 3u);
  EXPECT_NE(warnings[0].find("play at 'green':"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("speed_mps"), std::string::npos);
  EXPECT_NE(warnings[1].find("work at 'bench', 'step':"), std::string::npos) << warnings[1];
  EXPECT_NE(warnings[2].find("work at 'mine':"), std::string::npos) << warnings[2];
}

}  // namespace
}  // namespace flaneur
