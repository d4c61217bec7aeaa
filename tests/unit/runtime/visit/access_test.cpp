// What people need who play with one hand, sit, see or hear little, or like it slower.
#include <gtest/gtest.h>

#include <set>

#include "runtime/show/frame_from_simulation.h"
#include "runtime/visit/controls.h"
#include "runtime/visit/notices.h"
#include "runtime/visit/one_handed.h"
#include "runtime/visit/page_look.h"
#include "tests/unit/runtime/simulation/tour_town.h"

namespace flaneur {
namespace {

// What visitors do; developers' views and ending are the operator's, and on the pages.
constexpr Action kVisitors[] = {
    Action::kWalkAhead, Action::kWalkBack, Action::kWalkLeft, Action::kWalkRight, Action::kTurnLeft, Action::kTurnRight,
    Action::kLookUp,    Action::kLookDown, Action::kTour,     Action::kPause,     Action::kNext,     Action::kBack,
    Action::kLanguage,  Action::kMap,      Action::kPhoto,    Action::kAsk,       Action::kMenu};

PlayerSettings OneHanded(const std::string& half) {
  PlayerSettings settings;
  settings.one_handed = half;
  return settings;
}

std::set<std::string> LeftOfKeyboard() {
  std::set<std::string> keys{"escape", "tab", "space", "left_shift", "left_control", "left_alt", "mouse_right"};
  for (const char key : std::string("qwertasdfgzxcvb12345")) keys.insert(std::string(1, key));
  for (int k = 1; k <= 5; ++k) keys.insert("f" + std::to_string(k));
  return keys;
}

TEST(Keys, AKeyThatIsGivenToAnActionDoesNothingElse) {
  const auto of = [](const PlayerSettings& settings, Action action) {
    return KeysInForce(settings)[static_cast<size_t>(action)];
  };
  PlayerSettings settings;
  const std::string key = settings.keys[static_cast<size_t>(Action::kPhoto)].front();
  settings.keys[static_cast<size_t>(Action::kPause)] = {key};
  EXPECT_EQ(of(settings, Action::kPause), std::vector<std::string>{key});
  for (const std::string& other : of(settings, Action::kPhoto)) EXPECT_NE(other, key);
  settings.keys[static_cast<size_t>(Action::kPhoto)] = {key, "f12"};
  EXPECT_EQ(of(settings, Action::kPhoto).front(), key) << "who asks for both has both";
}

TEST(OneHanded, TheKeyboardsHalvesHaveAKeyOfTheirOwnForEverything) {
  for (const char* half : {"left_keys", "right_keys"}) {
    const auto keys = KeysInForce(OneHanded(half));
    std::set<std::string> used;
    for (const Action action : kVisitors) {
      size_t here = 0;
      for (const std::string& key : keys[static_cast<size_t>(action)]) {
        if (IsGamepadCode(InputCode(key))) continue;
        ASSERT_GE(InputCode(key), 0) << key;
        const bool left = LeftOfKeyboard().count(key) > 0;
        const bool both = key == "space" || key == "mouse_right";
        EXPECT_TRUE(both || left == (std::string(half) == "left_keys")) << half << " " << key;
        EXPECT_TRUE(used.insert(key).second) << half << ": " << key << " has two meanings";
        ++here;
      }
      EXPECT_GE(here, 1u) << half << " " << kActionNames[static_cast<size_t>(action)];
    }
  }
}

TEST(OneHanded, TheOtherKeysDoNothingAndTheGamepadStaysAsItWas) {
  const Simulation s = Started(TourTown(0));
  const Controls c = MakeControls(OneHanded("left_keys"), {}, s);
  for (const auto& codes : c.codes) {
    for (const char* key : {"up", "n", "page_down", "right", "f10"})
      EXPECT_EQ(std::count(codes.begin(), codes.end(), InputCode(key)), 0) << key;
  }
  const auto& pause = c.codes[static_cast<size_t>(Action::kPause)];
  EXPECT_EQ(std::count(pause.begin(), pause.end(), InputCode("pad_a")), 1);
}

CameraInput Hands(const WindowInput& input, const PlayerSettings& settings, Simulation* s, Controls* c) {
  *c = MakeControls(settings, {}, *s);
  CameraInput wish;
  TakeInput(input, 1.0f / 30, 1.6f, false, *s, c, &wish);
  return wish;
}

TEST(OneHanded, AGamepadsHalfWalksTurnsStepsAsideAndLooks) {
  Simulation s = Started(TourTown(0));
  for (const bool left : {true, false}) {
    const PlayerSettings settings = OneHanded(left ? "left_pad" : "right_pad");
    Controls c;
    const auto push = [&](Vec2 stick, bool shoulder) {
      WindowInput input;
      (left ? input.left_stick : input.right_stick) = stick;
      if (shoulder) input.down.set(static_cast<size_t>(InputCode(left ? "pad_left_bumper" : "pad_right_bumper")));
      return Hands(input, settings, &s, &c);
    };
    EXPECT_GT(push({0, 1}, false).speed_mps, 1);
    EXPECT_FLOAT_EQ(c.to_look_rad, 0);
    EXPECT_FLOAT_EQ(push({1, 0}, false).speed_mps, 0);
    EXPECT_LT(c.turn_radps, 0);
    const CameraInput aside = push({1, 0}, true);
    EXPECT_GT(aside.speed_mps, 1);
    EXPECT_FLOAT_EQ(c.turn_radps, 0);
    EXPECT_FLOAT_EQ(push({0, 1}, true).speed_mps, 0);
    EXPECT_GT(c.to_look_rad, 0);
    WindowInput other;
    (left ? other.right_stick : other.left_stick) = {1, 1};
    EXPECT_FLOAT_EQ(Hands(other, settings, &s, &c).speed_mps, 0) << "the other stick rests";
    EXPECT_FLOAT_EQ(c.turn_radps, 0);
  }
}

TEST(OneHanded, BecomesOnesOwnKeysWithTheFirstThatIsChanged) {
  const Simulation s = Started(TourTown(0));
  Controls c = MakeControls(OneHanded("left_keys"), {}, s);
  ASSERT_TRUE(Rebind(Action::kNext, InputCode("v"), &c));
  EXPECT_EQ(c.settings.one_handed, "off");
  EXPECT_EQ(c.settings.keys[static_cast<size_t>(Action::kTurnLeft)].front(), "a");
  EXPECT_EQ(c.settings.keys[static_cast<size_t>(Action::kNext)].back(), "v");
}

TEST(OneHanded, IsToldTheKeysOfTheirHalf) {
  const Simulation s = Started(TourTown(0));
  Notices n;
  BeginHint(MakeControls(OneHanded("left_keys"), {}, s), s, &n);
  EXPECT_EQ(n.text, "W, S walk, A, D turn the view. More: Esc");
}

TEST(OneHanded, AGamepadsHalfHasAButtonForWhatThePagesHaveNot) {
  for (const char* half : {"left_pad", "right_pad"}) {
    const auto keys = KeysInForce(OneHanded(half));
    std::set<std::string> used;
    for (const Action action :
         {Action::kTour, Action::kPause, Action::kNext, Action::kBack, Action::kAsk, Action::kMenu}) {
      size_t here = 0;
      for (const std::string& key : keys[static_cast<size_t>(action)]) {
        if (!IsGamepadCode(InputCode(key))) continue;
        EXPECT_TRUE(used.insert(key).second) << half << ": " << key << " has two meanings";
        ++here;
      }
      EXPECT_GE(here, 1u) << half << " " << kActionNames[static_cast<size_t>(action)];
    }
  }
}

TEST(Pace, IsOnesOwnAndTheTours) {
  PlayerSettings slow;
  slow.pace = 0.5f;
  Simulation s = Started(TourTown(0));
  Controls c;
  WindowInput ahead;
  ahead.down.set(static_cast<size_t>(InputCode("w")));
  EXPECT_NEAR(Hands(ahead, slow, &s, &c).speed_mps, 0.5f * Hands(ahead, {}, &s, &c).speed_mps, 1e-4f);
  float walked_m[2] = {}, rested_s[2] = {};
  for (const int k : {0, 1}) {
    Simulation led = Started(TourTown(0));
    led.visitor.comfort.pace = k == 0 ? 1 : 0.5f;
    for (int step = 0; step < 60; ++step) {
      const Vec2 before = led.visitor.camera.view.position;
      StepSimulation({}, 0, &led);
      walked_m[k] += Length(led.visitor.camera.view.position - before);
    }
    JumpToStop(1, InTown(&led));
    for (int step = 0; step < 45; ++step) StepSimulation({}, 0, &led);
    rested_s[k] = led.visitor.tour.rested_s;
  }
  EXPECT_GT(walked_m[0], 1);
  EXPECT_NEAR(walked_m[1], 0.5f * walked_m[0], 0.2f * walked_m[0]);
  EXPECT_GT(rested_s[0], 0.5f);
  EXPECT_NEAR(rested_s[1], 0.5f * rested_s[0], 0.1f) << "and stops last longer";
}

TEST(EyeHeight, IsThatOfSomebodySeatedWhereOneSaysSo) {
  const TourPack pack = TourTown(0);
  Simulation s = Started(pack);
  PlayerSettings seated;
  seated.eye_height_m = 1.2f;
  float eye_z_m[2] = {};
  for (const int k : {0, 1}) {
    s.visitor.camera.eye_height_m = EyeHeight_m(k == 0 ? PlayerSettings{} : seated, kEyeHeight_m);
    FrameInput frame;
    PersonLooks looks;
    FrameFromSimulation(pack, s, &looks, &frame);
    eye_z_m[k] = frame.eye.z;
  }
  EXPECT_NEAR(eye_z_m[0] - eye_z_m[1], kEyeHeight_m - 1.2f, 1e-4f);
  seated.eye_height_m = 0.01f;
  EXPECT_GE(EyeHeight_m(seated, kEyeHeight_m), 0.5f) << "nobody lies in the ground";
}

TEST(Captions, StayAsLongAsTheStopIsHeardWhereTheyAreAlwaysWished) {
  TourPack pack = TourTown(0);
  Simulation s = Started(pack);
  s.visitor.tour.words[1].caption = "Something to see.";
  JumpToStop(1, InTown(&s));
  for (int k = 0; k < 30; ++k) StepSimulation({}, 0, &s);
  ASSERT_TRUE(s.visitor.tour.resting);
  s.visitor.camera.view.position = s.visitor.camera.view.position + Vec2{4, 0};
  for (const bool stays : {false, true}) {
    s.visitor.comfort.captions_stay = stays;
    FrameInput frame;
    PersonLooks looks;
    FrameFromSimulation(pack, s, &looks, &frame);
    EXPECT_EQ(!frame.caption.empty(), stays);
  }
}

TEST(LessMotion, TurnsInStepsByKeysAndSticks) {
  Simulation s = Started(TourTown(0));
  PlayerSettings settings;
  settings.reduced_motion = true;
  WindowInput input;
  input.right_stick = {1, 0};
  Controls c;
  Hands(input, settings, &s, &c);
  EXPECT_NEAR(c.to_turn_rad, -30 * kPi / 180, 1e-4f);
  EXPECT_FLOAT_EQ(c.turn_radps, 0);
}

TEST(LookOfPages, LettersGrowWithEachStepAndContrastIsOpaque) {
  const Simulation s = Started(TourTown(0));
  float last_px = 0;
  for (const char* size : {"normal", "large", "largest"}) {
    PlayerSettings settings;
    settings.text_size = size;
    settings.high_contrast = true;
    const PageLook look = LookOf(MakeControls(settings, {}, s), s, 1280, 720);
    EXPECT_GT(look.letter_px, last_px * 1.2f) << size;
    last_px = look.letter_px;
    EXPECT_EQ(look.panel[3], 255);
    EXPECT_GT(look.outline_px, 1);
  }
}

}  // namespace
}  // namespace flaneur
