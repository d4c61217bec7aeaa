#include "runtime/visit/player_settings.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "runtime/base/file.h"
#include "runtime/visit/window_input.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

class Settings : public ::testing::Test {
 protected:
  void SetUp() override { folder_ = fs::temp_directory_path() / ("flaneur_settings_" + std::to_string(::getpid())); }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path Path() const { return folder_ / "flaneur" / "player.toml"; }
  void Write(const std::string& text) { ASSERT_EQ(WriteTextFile(Path(), text).message, ""); }

  fs::path folder_;
};

TEST_F(Settings, ComeBackAsTheyWereSaved) {
  PlayerSettings saved, read;
  saved.language = "de \"Harz\"";
  saved.pointer = "point";
  saved.turn_speed_dps = 47.5f;
  saved.snap_turn_deg = 30;
  saved.reduced_motion = true;
  saved.keys[static_cast<size_t>(Action::kPause)] = {"p", "pad_x"};
  saved.keys[static_cast<size_t>(Action::kQuit)] = {};
  ASSERT_EQ(WritePlayerSettings(Path(), saved).message, "");
  std::vector<std::string> warnings;
  ASSERT_EQ(ReadPlayerSettings(Path(), &read, &warnings).message, "");
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(PlayerSettingsText(read), PlayerSettingsText(saved));
  EXPECT_EQ(read.turn_speed_dps, 47.5f);
  EXPECT_EQ(read.keys, saved.keys);
}

TEST_F(Settings, AFileThatIsNotThereIsAllDefaults) {
  PlayerSettings settings;
  std::vector<std::string> warnings;
  EXPECT_EQ(ReadPlayerSettings(Path(), &settings, &warnings).message, "");
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(PlayerSettingsText(settings), PlayerSettingsText(PlayerSettings{}));
}

TEST_F(Settings, WhatIsWrongIsNamedWithItsLineAndTheRestIsUsed) {
  Write(
      "walk_sped_mps = 1\nturn_speed_dps = 1e9\npointer = \"finger\"\nreduced_motion = 1\n"
      "walk_speed_mps = 1.25\n[keys]\npause = [\"spac\"]\nnext = \"n\"\njump = [\"j\"]\nback = [\"x\"]\n");
  PlayerSettings settings;
  std::vector<std::string> warnings;
  ASSERT_EQ(ReadPlayerSettings(Path(), &settings, &warnings).message, "");
  ASSERT_EQ(warnings.size(), 7u);
  const auto named = [&](const char* line, const char* word) {
    for (const std::string& w : warnings) {
      EXPECT_EQ(w.find('\n'), std::string::npos);
      if (w.find(std::string(":") + line + ": ") != std::string::npos && w.find(word) != std::string::npos) return true;
    }
    return false;
  };
  EXPECT_TRUE(named("1", "did you mean 'walk_speed_mps'"));
  EXPECT_TRUE(named("2", "10 to 360"));
  EXPECT_TRUE(named("3", "look or point"));
  EXPECT_TRUE(named("4", "true or false"));
  EXPECT_TRUE(named("7", "did you mean 'space'"));
  EXPECT_TRUE(named("8", "list of keys"));
  EXPECT_TRUE(named("9", "keys.jump"));
  EXPECT_EQ(settings.walk_speed_mps, 1.25f);
  EXPECT_EQ(settings.turn_speed_dps, PlayerSettings{}.turn_speed_dps);
  EXPECT_EQ(settings.keys[static_cast<size_t>(Action::kPause)],
            PlayerSettings{}.keys[static_cast<size_t>(Action::kPause)]);
  EXPECT_EQ(settings.keys[static_cast<size_t>(Action::kBack)], std::vector<std::string>{"x"});
}

TEST_F(Settings, WhatIsNotTomlIsRefusedByItsLine) {
  Write("walk_speed_mps = 1\n[keys\n");
  PlayerSettings settings;
  std::vector<std::string> warnings;
  EXPECT_NE(ReadPlayerSettings(Path(), &settings, &warnings).message.find("player.toml:2: not TOML"),
            std::string::npos);
}

TEST_F(Settings, CanBeSetByAssignment) {
  PlayerSettings s;
  EXPECT_FALSE(SetPlayerSetting("snap_turn_deg=30", &s));
  EXPECT_FALSE(SetPlayerSetting("language=de", &s));
  EXPECT_FALSE(SetPlayerSetting("reduced_motion=true", &s));
  EXPECT_FALSE(SetPlayerSetting("keys.pause=p,pad_x", &s));
  EXPECT_EQ(s.snap_turn_deg, 30);
  EXPECT_EQ(s.language, "de");
  EXPECT_TRUE(s.reduced_motion);
  EXPECT_EQ(s.keys[static_cast<size_t>(Action::kPause)], (std::vector<std::string>{"p", "pad_x"}));
  for (const char* wrong : {"snap_turn=30", "snap_turn_deg", "snap_turn_deg=wide", "snap_turn_deg=", "keys.pause=spac",
                            "=", "", "mouse_speed=nan"}) {
    const std::string message = SetPlayerSetting(wrong, &s).message;
    EXPECT_NE(message, "") << wrong;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST_F(Settings, KeepOnlyWhatWasChanged) {
  PlayerSettings kept, before, now;
  kept.mouse_speed = 2;
  before.reduced_motion = now.reduced_motion = true;  // by the command line
  now.language = "de";
  now.sound_volume = 0.4f;
  now.keys[static_cast<size_t>(Action::kNext)] = {"x"};
  KeepChanges(before, now, &kept);
  EXPECT_EQ(kept.language, "de");
  EXPECT_EQ(kept.sound_volume, 0.4f);
  EXPECT_EQ(kept.mouse_speed, 2);
  EXPECT_FALSE(kept.reduced_motion);
  EXPECT_EQ(kept.keys[static_cast<size_t>(Action::kNext)], std::vector<std::string>{"x"});
  EXPECT_EQ(kept.keys[static_cast<size_t>(Action::kBack)], before.keys[static_cast<size_t>(Action::kBack)]);
}

TEST_F(Settings, StandWhereTheBaseDirectorySpecificationSays) {
  ::setenv("HOME", "/home/visitor", 1);
  ::setenv("XDG_CONFIG_HOME", "/etc/kiosk", 1);
  EXPECT_EQ(PlayerSettingsPath(), "/etc/kiosk/flaneur/player.toml");
  ::setenv("XDG_CONFIG_HOME", "relative", 1);
  EXPECT_EQ(PlayerSettingsPath(), "/home/visitor/.config/flaneur/player.toml");
  ::unsetenv("XDG_CONFIG_HOME");
  ::unsetenv("HOME");
  EXPECT_TRUE(PlayerSettingsPath().empty());
}

TEST(InputNames, LeadToACodeAndBack) {
  const std::vector<std::string> names = InputNames();
  EXPECT_GT(names.size(), 90u);
  for (const std::string& name : names) EXPECT_EQ(InputName(InputCode(name)), name);
  EXPECT_EQ(InputCode("nothing"), -1);
  EXPECT_EQ(InputCode(""), -1);
  for (const auto& keys : PlayerSettings{}.keys) {
    for (const std::string& key : keys) EXPECT_GE(InputCode(key), 0) << key;
  }
}

// docs/player.md is where people look for names.
TEST(InputNames, SettingsAndActionsStandInTheDocument) {
  std::string text;
  ASSERT_FALSE(ReadTextFile(fs::path(FLANEUR_SOURCE_DIR) / "docs/player.md", &text));
  for (const char* action : kActionNames)
    EXPECT_NE(text.find("`" + std::string(action) + "`"), std::string::npos) << action;
  std::istringstream lines(PlayerSettingsText({}));
  for (std::string line; std::getline(lines, line) && line != "[keys]";) {
    const std::string name = line.substr(0, line.find(' '));
    const bool is_setting = line.find(" = ") != std::string::npos && line[0] != '#';
    EXPECT_TRUE(!is_setting || text.find("`" + name + "`") != std::string::npos) << name;
  }
}

}  // namespace
}  // namespace flaneur
