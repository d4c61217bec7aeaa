#include "pipeline/io/choose_clips.h"

#include <gtest/gtest.h>

#include <map>

namespace flaneur {
namespace {

DocumentClip Moving(const std::string& name) {
  DocumentChannel channel;
  channel.times = {0, 1};
  channel.values = {{0, 0, 0, 1}, {0, 0, 1, 0}};
  DocumentClip clip;
  clip.name = name;
  clip.channels = {channel};
  return clip;
}

// What walk and idle become of clips with these names.
std::map<std::string, std::string> Chosen(const std::vector<std::string>& names) {
  GltfDocument document;
  for (const std::string& name : names) document.clips.push_back(Moving(name));
  ClipChoice choice;
  EXPECT_EQ(ChooseClips(document, ReadAvatarOptions(), &choice).message, "");
  std::map<std::string, std::string> chosen;
  for (const ChosenClip& clip : choice.clips)
    if (clip.file < 0) chosen[clip.name] = names[clip.index];
  return chosen;
}

TEST(ChooseClips, WhoHangsInTheAirOrSitsDoesNotStand) {
  // KayKit's movement clips: the only name with "idle" is that of somebody in the air.
  EXPECT_EQ(Chosen({"Rig|Jump_Idle", "Rig|Walking_B", "Rig|Running_A"}),
            (std::map<std::string, std::string>{{"walk", "Rig|Walking_B"}}));
  EXPECT_EQ(Chosen({"Sit_Chair_Idle", "2H_Melee_Idle", "Walk"}),
            (std::map<std::string, std::string>{{"walk", "Walk"}}));
  EXPECT_EQ(Chosen({"Sit_Idle", "Idle_Standing_Relaxed", "Walk"}).at("idle"), "Idle_Standing_Relaxed");
}

TEST(ChooseClips, ThePlainWalkIsTaken) {
  EXPECT_EQ(Chosen({"WalkBack", "WalkLeft", "CombatWalk", "Walking_Casual"}).at("walk"), "Walking_Casual");
  EXPECT_EQ(Chosen({"walkJump", "Walking"}).at("walk"), "Walking");
  EXPECT_EQ(Chosen({"Sword_Walk", "Sword_Idle"}), (std::map<std::string, std::string>{{"walk", "Sword_Walk"}}))
      << "better than none of its own";
  EXPECT_EQ(Chosen({"mixamo.com|walk", "Walk2"}).at("walk"), "mixamo.com|walk");
}

}  // namespace
}  // namespace flaneur
