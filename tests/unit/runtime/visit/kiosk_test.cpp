// A kiosk from visitor to visitor, its PIN and its locks, without a window.
#include "runtime/visit/kiosk.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "runtime/base/file.h"

namespace flaneur {
namespace {

constexpr float kPicture_s = 0.1f;

WindowInput Holding(const std::string& name) {
  WindowInput hands;
  hands.down.set(static_cast<size_t>(InputCode(name)));
  return hands;
}

WindowInput Touching(Vec2 place) {
  WindowInput hands;
  hands.pressed = true;
  hands.pointer = place;
  return hands;
}

struct Hall {
  Hall() {
    kiosk.settings.pin = "4711";
    kiosk.settings.idle_s = 60;
  }
  // What happens in so many seconds of the same; one thing at most.
  KioskEvent Pass(const WindowInput& hands, float seconds, bool is_led = false) {
    KioskEvent seen = KioskEvent::kNothing;
    for (float t = 0; t < seconds; t += kPicture_s) {
      const KioskEvent event = FollowKiosk(hands, kPicture_s, is_led, settings, &kiosk);
      if (event == KioskEvent::kNothing) continue;
      EXPECT_EQ(seen, KioskEvent::kNothing);
      seen = event;
    }
    return seen;
  }
  KioskEvent Tap(const std::string& key) {
    const KioskEvent event = Pass(Holding(key), kPicture_s);
    Pass({}, kPicture_s);
    return event;
  }
  void Type(const std::string& digits) {
    for (char digit : digits) Tap(std::string(1, digit));
  }
  void OpenKeypad() {
    Pass(Holding("f10"), kSign_s + 1);
    Pass({}, kPicture_s);
  }
  PlayerSettings settings;
  Kiosk kiosk;
};

TEST(Kiosk, ShowsItselfUntilSomebodyTouchesIt) {
  Hall hall;
  EXPECT_EQ(hall.Pass({}, 1000), KioskEvent::kNothing);
  WindowInput brushed;
  brushed.turned_px = {30, 0};
  EXPECT_EQ(hall.Pass(brushed, 1), KioskEvent::kNothing) << "a mouse that is pushed is nobody yet";
  EXPECT_EQ(hall.Pass(Touching({0.5f, 0.5f}), 0.3f), KioskEvent::kVisitBegins);
  EXPECT_EQ(hall.kiosk.state, KioskState::kVisit);
}

TEST(Kiosk, BeginsByKeyAndGamepadToo) {
  for (const char* name : {"w", "space", "pad_a"}) {
    Hall hall;
    EXPECT_EQ(hall.Tap(name), KioskEvent::kVisitBegins) << name;
  }
}

TEST(Kiosk, ShowsItselfAgainOnceNobodyIsThere) {
  Hall hall;
  hall.Tap("w");
  EXPECT_EQ(hall.Pass({}, 55), KioskEvent::kNothing);
  hall.Tap("w");
  EXPECT_EQ(hall.Pass({}, 55), KioskEvent::kNothing) << "counts from the last touch";
  EXPECT_EQ(hall.Pass({}, 10), KioskEvent::kVisitEnds);
  EXPECT_EQ(hall.kiosk.state, KioskState::kAttract);
  EXPECT_EQ(hall.Pass({}, 1000), KioskEvent::kNothing);
}

TEST(Kiosk, LeavesAloneWhomTheTourLeads) {
  Hall hall;
  hall.Tap("w");
  EXPECT_EQ(hall.Pass({}, 600, true), KioskEvent::kNothing);
  EXPECT_EQ(hall.Pass({}, 61), KioskEvent::kVisitEnds);
}

TEST(Kiosk, IsNotHeldByWhatLiesOnTheKeyboardOrByAStickThatRestsAside) {
  Hall hall;
  hall.Tap("w");
  WindowInput lying = Holding("k");
  lying.left_stick = {0.8f, 0};
  EXPECT_EQ(hall.Pass(lying, 65), KioskEvent::kVisitEnds);
  EXPECT_EQ(hall.Pass(lying, 600), KioskEvent::kNothing) << "nor does that begin a visit";
  WindowInput trembles = lying;
  trembles.left_stick.x = 0.85f;
  for (int k = 0; k < 100; ++k) EXPECT_EQ(hall.Pass(k % 2 == 0 ? trembles : lying, kPicture_s), KioskEvent::kNothing);
}

TEST(Kiosk, AsksForThePinWhereTheOperatorGivesTheirSign) {
  WindowInput pad = Holding("pad_back");
  pad.down.set(static_cast<size_t>(InputCode("pad_start")));
  for (const WindowInput& sign : {Holding("f10"), Touching({0.03f, 0.05f}), pad}) {
    Hall hall;
    hall.Pass(sign, kSign_s - 0.5f);
    EXPECT_EQ(hall.kiosk.page, OperatorPage::kNone);
    hall.Pass(sign, 1);
    EXPECT_EQ(hall.kiosk.page, OperatorPage::kKeypad);
    hall.Type("4711");
    EXPECT_EQ(hall.kiosk.page, OperatorPage::kChoices);
  }
  Hall hall;
  WindowInput closing;
  closing.close = true;
  hall.Pass(closing, kPicture_s);
  EXPECT_EQ(hall.kiosk.page, OperatorPage::kKeypad);
}

TEST(Kiosk, WithoutAPinNobodyGetsToTheOperatorsPage) {
  Hall hall;
  hall.kiosk.settings.pin.clear();
  hall.OpenKeypad();
  WindowInput closing;
  closing.close = true;
  hall.Pass(closing, 1);
  EXPECT_EQ(hall.kiosk.page, OperatorPage::kNone);
}

TEST(Kiosk, AKeypadThatNobodyUsesCloses) {
  Hall hall;
  hall.Tap("w");
  hall.OpenKeypad();
  hall.Type("47");
  hall.Pass({}, kPageCloses_s + 1);
  EXPECT_EQ(hall.kiosk.page, OperatorPage::kNone);
  hall.OpenKeypad();
  hall.Type("11");
  EXPECT_EQ(hall.kiosk.page, OperatorPage::kKeypad) << "the digits of somebody else are forgotten";
  hall.Tap("escape");
  EXPECT_EQ(hall.kiosk.page, OperatorPage::kNone);
}

TEST(Kiosk, GuessingPinsIsSlow) {
  Hall hall;
  hall.OpenKeypad();
  int tries = 0;
  for (float t = 0; t < 3600; t += 1) {  // a digit a second for an hour
    if (hall.kiosk.page == OperatorPage::kNone) hall.OpenKeypad();
    const bool counts = hall.kiosk.pin.wait_s <= 0 && hall.kiosk.pin.typed.size() == 3;
    hall.Type("9");
    hall.Pass({}, 0.8f);
    tries += counts;
  }
  EXPECT_LT(tries, 15);
  EXPECT_GT(tries, 3);
}

TEST(Kiosk, TheRightPinIsTakenOnceTheWaitIsOverAndForgivesGuesses) {
  Hall hall;
  hall.OpenKeypad();
  for (int k = 0; k < kFreeTries; ++k) hall.Type("9999");
  hall.Type("4711");
  EXPECT_EQ(hall.kiosk.page, OperatorPage::kKeypad) << "no PIN counts while one waits";
  hall.Pass({}, kFirstWait_s + 1);
  hall.OpenKeypad();
  hall.Type("4711");
  EXPECT_EQ(hall.kiosk.page, OperatorPage::kChoices);
  EXPECT_EQ(hall.kiosk.pin.wrong, 0);
}

TEST(KioskSettings, AreReadAndWrongOnesNamed) {
  const auto path = std::filesystem::temp_directory_path() / "flaneur_kiosk_test.toml";
  const auto read = [&](const std::string& text, KioskSettings* settings) {
    EXPECT_FALSE(WriteTextFile(path, text));
    return ReadKioskSettings(path, settings).message;
  };
  KioskSettings s;
  EXPECT_EQ(read("tour = \"town.glb\"\npin = \"0815\"\nidle_s = 45\nlanguages = [\"fr\", \"de\"]\nhang_s = 8\n", &s),
            "");
  EXPECT_EQ(s.tour, path.parent_path() / "town.glb") << "beside the file";
  EXPECT_EQ(s.pin, "0815");
  EXPECT_EQ(s.idle_s, 45);
  EXPECT_EQ(s.languages, (std::vector<std::string>{"fr", "de"}));
  EXPECT_EQ(s.hang_s, 8);
  for (const char* pin : {"\"123\"", "\"12345678901234\"", "\"47a1\"", "4711"})
    EXPECT_NE(read(std::string("pin = ") + pin + "\n", &s).find("pin"), std::string::npos) << pin;
  EXPECT_NE(read("idle_s = 1\n", &s).find("kiosk_test.toml:1: idle_s"), std::string::npos);
  EXPECT_NE(read("idl_s = 60\n", &s).find("did you mean 'idle_s'"), std::string::npos);
  EXPECT_EQ(s.pin, "0815") << "nothing of a wrong file is taken";
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace flaneur
