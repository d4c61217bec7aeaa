#include "pipeline/io/choose_clips.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "pipeline/core/temporary_folder.h"

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
  EXPECT_EQ(ChooseClips(document, ReadAvatarOptions(), LoneClip::kWalk, &choice).message, "");
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

TEST(ChooseClips, AnyLanguageIsUnderstood) {
  using Clips = std::map<std::string, std::string>;
  EXPECT_EQ(Chosen({"Rennen", "Gehen_Schleife", "Stehen", "Reden"}),
            (Clips{{"walk", "Gehen_Schleife"}, {"idle", "Stehen"}, {"talk", "Reden"}}));
  EXPECT_EQ(Chosen({"奔跑", "步行", "待机"}), (Clips{{"walk", "步行"}, {"idle", "待机"}}));
  EXPECT_EQ(Chosen({"Armature|marche", "Armature|attente"}),
            (Clips{{"walk", "Armature|marche"}, {"idle", "Armature|attente"}}));
  EXPECT_EQ(Chosen({"Walk", "Stand_Up", "Standing T-Pose", "Stand To Sit"}), (Clips{{"walk", "Walk"}}));
  EXPECT_EQ(Chosen({"Walk", "Standing", "Idle_long_look_around"}).at("idle"), "Idle_long_look_around");
}

TEST(ChooseClips, WhoOnlyWalksStandsByWhatComesWithTheProgram) {
  GltfDocument document;
  document.clips = {Moving("mixamo.com")};
  ClipChoice choice;
  ASSERT_EQ(ChooseClips(document, ReadAvatarOptions(), LoneClip::kWalk, &choice).message, "");
  ASSERT_EQ(choice.clips.size(), 3u);
  EXPECT_TRUE(choice.shipped_idle && !choice.shipped_walk);
  document.clips.push_back(Moving("idle"));
  choice = {};
  ASSERT_EQ(ChooseClips(document, ReadAvatarOptions(), LoneClip::kWalk, &choice).message, "");
  EXPECT_EQ(choice.clips.size(), 2u) << "who has an idle of their own talks as they stand";
}

// Mixamo calls a stance `mixamo.com` as it does a walk; an Idle says what it is.
TEST(ChooseClips, ALoneClipIsWhatOneSaysItIs) {
  const auto chosen = [](const std::string& name, LoneClip lone) {
    GltfDocument document;
    document.clips = {Moving(name)};
    ClipChoice choice;
    EXPECT_EQ(ChooseClips(document, ReadAvatarOptions(), lone, &choice).message, "");
    std::string own;
    for (const ChosenClip& clip : choice.clips) own += clip.file < 0 ? clip.name : "";
    EXPECT_EQ(choice.shipped_walk, lone != LoneClip::kWalk) << name;
    EXPECT_EQ(choice.lone_walk, lone == LoneClip::kWalk) << name;
    return own;
  };
  EXPECT_EQ(chosen("mixamo.com", LoneClip::kWalk), "walk");
  EXPECT_EQ(chosen("mixamo.com", LoneClip::kIdle), "idle");
  EXPECT_EQ(chosen("mixamo.com", LoneClip::kNone), "");
  EXPECT_EQ(chosen("Idle", LoneClip::kNone), "idle");
  for (const char* name : {"Idle", "Armature|Standing", "Talking", "T-Pose", "Dance_01", "Attack", "run", "待機"})
    EXPECT_TRUE(IsNoWalk(name)) << name;
  for (const char* name : {"mixamo.com", "Take 001", "Armature|ArmatureAction", "animation_0", "Marche", ""})
    EXPECT_FALSE(IsNoWalk(name)) << name;
}

// Who gives a recording wants it walked by, though the figure has a walk; but not where it says that it is a wave.
TEST(ChooseClips, AFilesLoneClipIsTheWalkBeforeTheFiguresOwn) {
  GltfDocument document;
  document.clips = {Moving("Walk"), Moving("Idle")};
  TemporaryFolder folder;
  ASSERT_EQ(folder.Create("choose_clips").message, "");
  const auto given = [&](const char* name) {
    const auto path = folder.path() / name;
    std::ofstream(path) << "HIERARCHY\nROOT Hips\n{\nOFFSET 0 1 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
                           "End Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.5\n0 0 0\n0 30 0\n";
    ReadAvatarOptions options;
    options.clip_files = {path};
    return options;
  };
  const auto walk_of = [&](const ReadAvatarOptions& options, LoneClip lone, std::vector<std::string>* unused) {
    ClipChoice choice;
    EXPECT_EQ(ChooseClips(document, options, lone, &choice).message, "");
    *unused = UnusedFiles(options, choice);
    return choice.clips.at(0).file;
  };
  std::vector<std::string> unused;
  EXPECT_EQ(walk_of(given("take_01.bvh"), LoneClip::kWalk, &unused), 0);
  EXPECT_TRUE(unused.empty());
  EXPECT_EQ(walk_of(given("take_01.bvh"), LoneClip::kIdle, &unused), -1) << "its legs keep still";
  ASSERT_EQ(unused.size(), 1u) << "and the figure stands by its own";
  EXPECT_NE(unused.front().find("take_01.bvh"), std::string::npos);
  EXPECT_EQ(walk_of(given("waving.bvh"), LoneClip::kWalk, &unused), -1);
  EXPECT_EQ(unused.size(), 1u);
  EXPECT_EQ(walk_of(given("walking.bvh"), LoneClip::kWalk, &unused), 0);
}

}  // namespace
}  // namespace flaneur
