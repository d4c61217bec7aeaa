// The visitor's pages, driven as in the window but without one.
#include "runtime/visit/menu.h"

#include <gtest/gtest.h>
#include <imgui/imgui.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <set>
#include <sstream>

#include "runtime/desktop/context.h"
#include "runtime/show/frame_from_simulation.h"
#include "runtime/visit/attract_page.h"
#include "runtime/visit/home.h"
#include "runtime/visit/hotspot_view.h"
#include "runtime/visit/map_page.h"
#include "runtime/visit/menu_view.h"
#include "runtime/visit/notices.h"
#include "runtime/visit/operator_page.h"
#include "runtime/visit/photo_page.h"
#include "runtime/visit/phrases.h"
#include "tests/unit/runtime/simulation/tour_town.h"

namespace flaneur {
namespace {

constexpr int kWidth_px = 1280, kHeight_px = 720;

struct Pages {
  Pages() {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NavEnableGamepad;
    ImGui::GetIO().BackendFlags |= ImGuiBackendFlags_HasGamepad;
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
    TourPack pack = TourTown(0);
    pack.path[1].captions["de"] = "Etwas zu sehen.";
    s = Started(pack);
    controls = MakeControls({}, {}, s);
    OpenPage(Page::kMain, &menu);
    Picture({});
    Picture({});
  }
  MenuChoice Picture(const WindowInput& input) {
    TakePageInput(input, &menu, &controls);
    overlay.Begin(kWidth_px, kHeight_px, OverlayInputFrom(input, menu, controls, kWidth_px, kHeight_px, 1.0f / 30));
    MenuChoice choice = ShowMenu("town", s, kWidth_px, kHeight_px, &menu, &controls, &overlay.text());
    ImGui::Render();
    return choice;
  }
  MenuChoice Tap(const char* name) {
    WindowInput input;
    input.down.set(static_cast<size_t>(InputCode(name)));
    MenuChoice choice = Picture(input);
    for (int k = 0; k < 3; ++k) {
      const MenuChoice later = Picture({});
      if (later.ends || later.stop) choice = later;
    }
    return choice;
  }
  // Moves there, presses and releases, as a finger does.
  MenuChoice Click(float x, float y) {
    WindowInput input;
    input.pointer = {x, y};
    Picture(input);
    input.pressed = true;
    Picture(input);
    input.pressed = false;
    MenuChoice choice = Picture(input);
    Picture({});
    return choice;
  }

  Overlay overlay;  // ends ImGui
  Simulation s;
  Controls controls;
  Menu menu;
};

TEST(Pages, AreAllReachedByKeyboardAndByGamepad) {
  const struct {
    const char *down, *accept, *back, *one_handed;
  } hands[] = {{"down", "enter", "escape", "off"},
               {"pad_down", "pad_a", "pad_b", "off"},
               {"s", "space", "escape", "left_keys"},
               {"k", "space", "backspace", "right_keys"},
               {"pad_down", "pad_left_stick", "pad_back", "left_pad"}};
  for (const auto& hand : hands) {
    std::set<Page> seen;
    bool ends = false;
    for (int row = 0; row < 9; ++row) {
      Pages p;
      p.controls.settings.one_handed = hand.one_handed;
      TakeKeys(&p.controls);
      for (int k = 0; k < row; ++k) p.Tap(hand.down);
      ends = ends || p.Tap(hand.accept).ends;
      seen.insert(p.menu.page);
      if (p.menu.page == Page::kNone || p.menu.page == Page::kMain) continue;
      const bool of_town = IsOfTown(p.menu.page);
      p.Tap(hand.back);
      if (of_town) {
        EXPECT_EQ(p.menu.page, Page::kNone);
        continue;
      }
      EXPECT_EQ(p.menu.page, Page::kMain);
      p.Tap(hand.back);
      EXPECT_EQ(p.menu.page, Page::kNone);
    }
    EXPECT_EQ(seen, (std::set<Page>{Page::kNone, Page::kMain, Page::kStops, Page::kLanguages, Page::kSettings,
                                    Page::kKeys, Page::kMap}))
        << hand.down;
    EXPECT_TRUE(ends) << hand.down;
  }
}

TEST(Pages, BeginAtTheirFirstRow) {
  Pages p;
  for (int k = 0; k < 3; ++k) p.Tap("down");
  p.Tap("enter");
  EXPECT_EQ(p.menu.page, Page::kStops);
  p.Tap("down");
  EXPECT_EQ(p.Tap("enter").stop, 3u);
}

// A row as high as that has the colour of those that are marked.
bool IsMarked(const ImDrawData& data, Vec2 at_px) {
  const ImU32 marked = IM_COL32(250, 204, 107, 255);  // the outline of who goes by keys
  for (int l = 0; l < data.CmdListsCount; ++l) {
    const ImDrawList& list = *data.CmdLists[l];
    float left = 1e9f, top = 1e9f, right = 0, bottom = 0;
    for (const ImDrawVert& v : list.VtxBuffer) {
      if ((v.col & 0xffffff) != (marked & 0xffffff)) continue;
      left = std::min(left, v.pos.x), right = std::max(right, v.pos.x);
      top = std::min(top, v.pos.y), bottom = std::max(bottom, v.pos.y);
    }
    if (at_px.x > left && at_px.x < right && at_px.y > top && at_px.y < bottom) return true;
  }
  return false;
}

bool MarksRow(Pages& p, const char* text) {
  for (const DrawnText& t : p.overlay.text().drawn()) {
    if (t.text == text) return IsMarked(*ImGui::GetDrawData(), {t.box.left_px + 5, t.box.top_px + t.box.height_px / 2});
  }
  ADD_FAILURE() << text;
  return false;
}

bool MarksAny(Pages& p) {
  const auto& drawn = p.overlay.text().drawn();
  return std::any_of(drawn.begin(), drawn.end(), [&](const DrawnText& t) { return MarksRow(p, t.text.c_str()); });
}

TEST(Pages, MarkTheirFirstRowForWhoComesByKeys) {
  for (const char* accept : {"enter", "pad_a"}) {
    Pages p;
    EXPECT_TRUE(MarksRow(p, "Continue")) << "at once";
    for (int k = 0; k < 3; ++k) p.Tap("down");
    EXPECT_TRUE(MarksRow(p, "Stops of the tour"));
    p.Tap(accept);
    ASSERT_EQ(p.menu.page, Page::kStops);
    EXPECT_TRUE(MarksAny(p));
    EXPECT_EQ(p.Tap(accept).stop, 1u) << "the first, by nothing but accepting it";
  }
}

TEST(Pages, MarkNothingForWhoComesByPointerUntilAKeyIsPressed) {
  Pages p;
  p.Click(0.98f, 0.02f);  // beside all rows
  OpenPage(Page::kLanguages, &p.menu);
  p.Picture({});
  p.Picture({});
  EXPECT_FALSE(MarksAny(p));
  p.Tap("down");
  EXPECT_TRUE(MarksRow(p, "English"));
  p.Tap("down");
  EXPECT_TRUE(MarksRow(p, "Deutsch"));
}

TEST(Pages, AreAllReachedByPointerAlone) {
  std::set<Page> seen;
  std::set<std::string> languages;
  bool ends = false;
  Pages p;
  for (float y = 0; y < 1; y += 0.02f) {
    OpenPage(Page::kMain, &p.menu);
    p.Picture({});
    p.Picture({});
    ends = p.Click(0.5f, y).ends || ends;
    seen.insert(p.menu.page);
    OpenPage(Page::kLanguages, &p.menu);
    p.Picture({});
    p.Picture({});
    p.Click(0.5f, y);
    languages.insert(PageLanguage(p.controls, p.s));
  }
  EXPECT_EQ(seen.size(), 7u);
  EXPECT_EQ(languages, (std::set<std::string>{"en", "de", "es", "fr", "it"}));
  EXPECT_TRUE(ends);
}

TEST(Pages, ForAnExhibitionHaveNoEnd) {
  Pages p;
  p.controls.settings.kiosk = true;
  for (float y = 0; y < 1; y += 0.02f) {
    OpenPage(Page::kMain, &p.menu);
    p.Picture({});
    p.Picture({});
    EXPECT_FALSE(p.Click(0.5f, y).ends);
  }
}

TEST(Pages, ForAnExhibitionChangeNothingButLanguageTextAndSound) {
  Pages p;
  p.controls.settings.kiosk = true;
  const PlayerSettings before = p.controls.settings;
  std::set<float> volumes;
  for (const Page page : {Page::kMain, Page::kLanguages, Page::kSettings}) {
    for (float y = 0; y < 1; y += 0.02f) {
      for (const float x : {0.3f, 0.5f, 0.55f, 0.77f}) {
        OpenPage(page, &p.menu);
        p.Picture({});
        p.Picture({});
        p.Click(x, y);
        EXPECT_NE(p.menu.page, Page::kKeys);
        volumes.insert(p.controls.settings.sound_volume);
      }
    }
  }
  EXPECT_GT(volumes.size(), 1u);
  PlayerSettings others = p.controls.settings;
  others.sound_volume = before.sound_volume;
  others.language = before.language;
  others.text_size = before.text_size;
  others.high_contrast = before.high_contrast;
  EXPECT_EQ(PlayerSettingsText(others), PlayerSettingsText(before));
}

TEST(Pages, LeadToEveryHaltOfTheTour) {
  Pages p;
  std::set<size_t> stops;
  for (float y = 0; y < 1; y += 0.02f) {
    OpenPage(Page::kStops, &p.menu);
    p.Picture({});
    p.Picture({});
    if (const MenuChoice choice = p.Click(0.5f, y); choice.stop) stops.insert(*choice.stop);
  }
  EXPECT_EQ(stops, (std::set<size_t>{1, 3, 5}));
}

TEST(Pages, AtTheToursEndOfferTheTourAgainOnesOwnWayAndHome) {
  const struct { const char *down, *up, *accept; } hands[] = {{"down", "up", "enter"}, {"pad_down", "pad_up", "pad_a"}};
  for (const auto& hand : hands) {
    for (int row = 0; row < 3; ++row) {
      Pages p;
      p.s.visitor.tour.over = p.s.visitor.finished = true;
      OpenEndOfTour("Thank you.", &p.menu);
      EXPECT_FALSE(HoldsTown(p.menu));
      p.Picture({});
      p.Picture({});
      p.Tap(hand.down);  // shows which row is meant
      p.Tap(hand.up);
      for (int k = 0; k < row; ++k) p.Tap(hand.down);
      WindowInput accept;
      accept.down.set(static_cast<size_t>(InputCode(hand.accept)));
      MenuChoice choice = p.Picture(accept);
      for (int k = 0; k < 3; ++k) {
        const MenuChoice later = p.Picture({});
        if (later.stop || later.home) choice = later;
      }
      EXPECT_EQ(choice.stop.has_value(), row == 0) << hand.down;
      EXPECT_EQ(p.controls.follows_tour, row != 1) << hand.down;
      EXPECT_EQ(choice.home, row == 2) << hand.down;
    }
  }
  std::set<int> reached;  // by a finger
  for (float y = 0.2f; y < 0.9f; y += 0.02f) {
    Pages p;
    p.s.visitor.tour.over = p.s.visitor.finished = true;
    OpenEndOfTour("Thank you.", &p.menu);
    p.Picture({});
    p.Picture({});
    const MenuChoice choice = p.Click(0.5f, y);
    if (choice.stop) reached.insert(0);
    if (!p.controls.follows_tour) reached.insert(1);
    if (choice.home) reached.insert(2);
  }
  EXPECT_EQ(reached, (std::set<int>{0, 1, 2}));
}

// Whoever just then held a button that accepts meant something else by it.
TEST(Pages, AtTheToursEndWaitUntilWhatIsHeldIsLetGo) {
  Pages p;
  p.s.visitor.tour.over = p.s.visitor.finished = true;
  WindowInput held;
  held.down.set(static_cast<size_t>(InputCode("space")));
  OpenPage(Page::kNone, &p.menu);
  p.Picture(held);
  OpenEndOfTour("Thank you.", &p.menu);
  for (int k = 0; k < 5; ++k) EXPECT_FALSE(p.Picture(held).stop);
  EXPECT_EQ(p.menu.page, Page::kEnd);
}

TEST(Home, IsTheBeginningWhileTheCrowdGoesOn) {
  Simulation s = Started(TourTown(40));
  PlayerSettings settings;
  Controls controls = MakeControls(settings, {}, s);
  CameraInput wishes;
  Notices notices;
  const ViewCamera start = s.visitor.camera.view;
  for (int k = 0; k < 30 * 60; ++k) StepSimulation({}, 0, &s);
  ASSERT_GT(Length(s.visitor.camera.view.position - start.position), 5);
  controls.follows_tour = false;
  controls.settings.language = "de";
  const int64_t step = s.town.step;
  GoHome(settings, {s, controls, wishes, notices});
  EXPECT_EQ(s.town.step, step) << "nobody but the visitor is where they were before";
  EXPECT_TRUE(controls.follows_tour);
  EXPECT_EQ(controls.settings.language, settings.language);
  for (int k = 0; k < 30 * 20; ++k) StepSimulation(NextStep(wishes, s, &controls), 0, &s);
  EXPECT_LT(Length(s.visitor.camera.view.position - start.position), 0.01f) << "the tour waits to be begun";
  EXPECT_LT(std::abs(s.visitor.camera.view.yaw_rad - start.yaw_rad), 0.01f);
  EXPECT_LT(Length(s.town.crowd.position[s.visitor.guide.index] - start.position), 9);
  BeginVisit({s, controls, wishes, notices});
  for (int k = 0; k < 30 * 20; ++k) StepSimulation(NextStep(wishes, s, &controls), 0, &s);
  EXPECT_GT(Length(s.visitor.camera.view.position - start.position), 3);
}

TEST(Pages, EverySettingCanBeChangedAndStaysInItsRange) {
  Pages p;
  std::set<std::string> changed;
  const auto note_changes = [&](const std::string& before) {
    std::istringstream was(before), is(PlayerSettingsText(p.controls.settings));
    for (std::string old_line, line; std::getline(was, old_line) && std::getline(is, line);) {
      if (line != old_line) changed.insert(line.substr(0, line.find(' ')));
    }
  };
  for (size_t first : {0, 5, 9, 13}) {  // not all rows fit at once
    for (float x : {0.3f, 0.55f, 0.78f}) {
      for (float y = 0.05f; y < 0.9f; y += 0.02f) {
        OpenPage(Page::kSettings, &p.menu);
        p.menu.first = first;
        p.Picture({});
        p.Picture({});
        const std::string before = PlayerSettingsText(p.controls.settings);
        p.Click(x, y);
        note_changes(before);
      }
    }
  }
  for (const char* name :
       {"pointer", "walk_speed_mps", "turn_speed_dps", "mouse_speed", "field_of_view_deg", "snap_turn_deg",
        "invert_look", "reduced_motion", "sound_volume", "frames_per_s", "least_resolution_scale", "text_size",
        "high_contrast", "captions_always", "pace", "eye_height_m", "one_handed"}) {
    EXPECT_EQ(changed.count(name), 1u) << name;
  }
  EXPECT_TRUE(p.controls.changed && p.controls.applies);
  PlayerSettings read;
  std::vector<std::string> warnings;
  const auto path = std::filesystem::temp_directory_path() / ("flaneur_pages_" + std::to_string(::getpid()) + ".toml");
  ASSERT_FALSE(WritePlayerSettings(path, p.controls.settings));
  ASSERT_FALSE(ReadPlayerSettings(path, &read, &warnings));
  std::filesystem::remove(path);
  EXPECT_TRUE(warnings.empty()) << warnings.front();
}

TEST(Pages, TakeANewKeyFromWhoeverHadIt) {
  Pages p;
  OpenPage(Page::kKeys, &p.menu);
  p.menu.rebinds = Action::kWalkAhead;
  p.Picture({});
  p.Tap("pad_a");
  EXPECT_TRUE(p.menu.rebinds) << "waits for a key, not for a button";
  p.Tap("space");
  EXPECT_FALSE(p.menu.rebinds);
  const auto& keys = p.controls.settings.keys;
  EXPECT_EQ(keys[static_cast<size_t>(Action::kWalkAhead)], std::vector<std::string>{"space"});
  EXPECT_EQ(keys[static_cast<size_t>(Action::kPause)], std::vector<std::string>{"pad_a"});
  EXPECT_EQ(p.menu.page, Page::kKeys);
  p.menu.rebinds = Action::kWalkAhead;
  p.Picture({});
  p.Tap("escape");
  EXPECT_FALSE(p.menu.rebinds) << "the pages' own key gives it up";
  EXPECT_EQ(keys[static_cast<size_t>(Action::kWalkAhead)], std::vector<std::string>{"space"});
  EXPECT_EQ(p.menu.page, Page::kKeys);
  ResetKeys(&p.controls);
  EXPECT_EQ(keys, PlayerSettings{}.keys);
}

TEST(Pages, HaveEveryWordInEveryLanguage) {
  EXPECT_EQ(PhraseLanguages(), (std::vector<std::string>{"en", "de", "es", "fr", "it"}));
  for (const std::string& language : PhraseLanguages()) {
    EXPECT_EQ(FaultsOfWords(language), std::vector<std::string>{}) << language;
    EXPECT_NE(LanguageName(language), language);
  }
  EXPECT_STREQ(Say(Phrase::kEnd, "sv"), Say(Phrase::kEnd, "en"));
  EXPECT_STREQ(Say(Phrase::kEnd, "de-AT"), Say(Phrase::kEnd, "de"));
  EXPECT_EQ(Say(Phrase::kPair, "en", {"100 %s", "b"}), "100 %s: b") << "what is put in is not looked at again";
}

TEST(Pages, HaveNoWordThatIsEnglishByOversight) {
  for (const std::string& language : PhraseLanguages()) {
    if (language == "en") continue;
    int same = 0;
    for (int k = 0; k < static_cast<int>(Phrase::kCount); ++k) {
      const auto phrase = static_cast<Phrase>(k);
      same += std::string(Say(phrase, language)) == Say(phrase, "en");
    }
    EXPECT_LT(same, 9) << language << ": such as no, Volume, stick are alike";
  }
}

// What a page writes, all of it: page after page where not all rows fit at once.
std::vector<DrawnText> WrittenOn(Page page, int width_px, int height_px, Overlay* overlay, Controls* controls,
                                 const Simulation& s, const std::string& title = "Town") {
  Menu menu;
  std::vector<DrawnText> written;
  for (size_t first = 0, last = 1; first != last && first < 2 * kActions;) {
    OpenPage(page, &menu);
    if (page == Page::kEnd) OpenEndOfTour(Say(Phrase::kThanks, PageLanguage(*controls, s)), &menu);
    menu.first = first;
    for (int round = 0; round < 2; ++round) {  // ImGui knows a window's size only after its first picture
      overlay->Begin(width_px, height_px, {});
      ShowMenu(title, s, width_px, height_px, &menu, controls, &overlay->text());
      overlay->Draw();
    }
    const auto& drawn = overlay->text().drawn();
    written.insert(written.end(), drawn.begin(), drawn.end());
    last = first++;
  }
  return written;
}

// Every text is whole, in its box, and in the picture.
void ExpectWhole(const std::vector<DrawnText>& written, int width_px, int height_px, const std::string& where) {
  constexpr float kRounding_px = 1.01f;
  EXPECT_GE(written.size(), 2u) << where;
  for (const DrawnText& t : written) {
    EXPECT_FALSE(t.cut) << where << t.text;
    EXPECT_FALSE(t.broken_words) << where << t.text;
    const TextBox &box = t.box, &covers = t.covers;
    EXPECT_GE(covers.left_px, box.left_px - kRounding_px) << where << t.text;
    EXPECT_LE(covers.left_px + covers.width_px, box.left_px + box.width_px + kRounding_px) << where << t.text;
    EXPECT_GE(covers.top_px, box.top_px - kRounding_px) << where << t.text;
    EXPECT_LE(covers.top_px + covers.height_px, box.top_px + box.height_px + kRounding_px) << where << t.text;
    EXPECT_GE(box.left_px, 0) << where << t.text;
    EXPECT_GE(box.top_px, 0) << where << t.text;
    EXPECT_LE(box.left_px + box.width_px, static_cast<float>(width_px)) << where << t.text;
    EXPECT_LE(box.top_px + box.height_px, static_cast<float>(height_px)) << where << t.text;
  }
}

Simulation TownWithStops() {
  TourPack pack = TourTown(0);
  pack.path[1].captions["de"] = "Etwas zu sehen.";
  Simulation s = Started(pack);
  s.visitor.tour.words[1].caption = "Under the town hall: its arcade is open to all who trade.";
  return s;
}

TEST(Pages, CutNothingInAnyLanguageTextSizeOrWindow) {
  HeadlessContext context;
  if (const Error error = context.Create()) GTEST_SKIP() << error.message;
  Overlay overlay;
  ASSERT_EQ(overlay.Create().message, "");
  const Simulation s = TownWithStops();
  const int sizes[][2] = {{800, 600}, {1280, 720}, {720, 1280}, {1920, 1080}};
  for (const std::string& language : PhraseLanguages()) {
    for (const char* text_size : {"normal", "large", "largest"}) {
      PlayerSettings settings;
      settings.language = language;
      settings.text_size = text_size;
      settings.high_contrast = language == "de";
      Controls controls = MakeControls(settings, {}, s);
      for (const auto& size : sizes) {
        for (const Page page :
             {Page::kMain, Page::kStops, Page::kLanguages, Page::kSettings, Page::kKeys, Page::kEnd}) {
          const std::string where = language + ", " + text_size + ", " + std::to_string(size[0]) + " px, page " +
                                    std::to_string(static_cast<int>(page)) + ": ";
          ExpectWhole(WrittenOn(page, size[0], size[1], &overlay, &controls, s), size[0], size[1], where);
        }
      }
    }
  }
}

TEST(Pages, HaveRoomForEveryValueThatASettingCanTake) {
  HeadlessContext context;
  if (const Error error = context.Create()) GTEST_SKIP() << error.message;
  Overlay overlay;
  ASSERT_EQ(overlay.Create().message, "");
  const Simulation s = TownWithStops();
  for (const std::string& language : PhraseLanguages()) {
    for (const char* hand : {"off", "left_keys", "right_keys", "left_pad", "right_pad"}) {
      PlayerSettings settings;
      settings.language = language;
      settings.text_size = "largest";
      settings.one_handed = hand;
      settings.walk_speed_mps = 2.8f;
      settings.turn_speed_dps = settings.field_of_view_deg = 120;
      settings.snap_turn_deg = 90;
      settings.eye_height_m = 1.25f;
      settings.reduced_motion = settings.invert_look = true;
      settings.pointer = "point";
      Controls controls = MakeControls(settings, {}, s);
      for (const Page page : {Page::kSettings, Page::kKeys})
        ExpectWhole(WrittenOn(page, 720, 1280, &overlay, &controls, s), 720, 1280, language + ", " + hand + ": ");
    }
  }
}

TEST(Pages, ShowAllTheirRowsPageByPage) {
  HeadlessContext context;
  if (const Error error = context.Create()) GTEST_SKIP() << error.message;
  Overlay overlay;
  ASSERT_EQ(overlay.Create().message, "");
  const Simulation s = TownWithStops();
  PlayerSettings settings;
  settings.text_size = "largest";
  Controls controls = MakeControls(settings, {}, s);
  std::set<std::string> names;
  for (const DrawnText& t : WrittenOn(Page::kKeys, 800, 600, &overlay, &controls, s)) names.insert(t.text);
  for (size_t k = 0; k < kActions; ++k) {
    const auto action = static_cast<Action>(k);
    if (action == Action::kMenu) continue;
    EXPECT_EQ(names.count(NameOf(action, "en")), 1u) << kActionNames[k];
  }
  EXPECT_EQ(names.count("More"), 1u);
}

TEST(OperatorPage, IsWholeInEveryLanguageTextSizeAndWindow) {
  HeadlessContext context;
  if (const Error error = context.Create()) GTEST_SKIP() << error.message;
  Overlay overlay;
  ASSERT_EQ(overlay.Create().message, "");
  const Simulation s = TownWithStops();
  for (const std::string& language : PhraseLanguages()) {
    for (const auto& [width_px, height_px] : {std::pair{800, 600}, std::pair{1280, 720}, std::pair{720, 1280}}) {
      for (const OperatorPage page : {OperatorPage::kKeypad, OperatorPage::kChoices}) {
        PlayerSettings settings;
        settings.language = language;
        settings.text_size = "largest";
        const PageLook look = LookOf(MakeControls(settings, {}, s), s, width_px, height_px);
        Kiosk kiosk;
        kiosk.page = page;
        kiosk.pin.wrong = 1;
        KeyMark mark;
        for (int round = 0; round < 2; ++round) {
          overlay.Begin(width_px, height_px, {});
          ShowOperatorPage(look, page == OperatorPage::kChoices ? "12" : "", width_px, height_px, &kiosk, &mark,
                           &overlay.text());
          overlay.Draw();
        }
        ExpectWhole(overlay.text().drawn(), width_px, height_px, language + " " + std::to_string(width_px) + ": ");
      }
    }
  }
}

// For each language, text size and window what `show` draws is whole.
void ExpectWholeEverywhere(const Simulation& s, Overlay* overlay,
                           const std::function<void(const PageLook&, int width_px, int height_px)>& show) {
  for (const std::string& language : PhraseLanguages()) {
    for (const char* size : {"normal", "large", "largest"}) {
      for (const auto& [width_px, height_px] : {std::pair{800, 600}, std::pair{1280, 720}, std::pair{720, 1280}}) {
        PlayerSettings settings;
        settings.language = language;
        settings.text_size = size;
        const PageLook look = LookOf(MakeControls(settings, {}, s), s, width_px, height_px);
        for (int round = 0; round < 2; ++round) {
          overlay->Begin(width_px, height_px, {});
          show(look, width_px, height_px);
          overlay->Draw();
        }
        ExpectWhole(overlay->text().drawn(), width_px, height_px,
                    language + " " + size + " " + std::to_string(width_px) + ": ");
      }
    }
  }
}

TEST(MapOnThePages, IsWholeInEveryLanguageTextSizeAndWindow) {
  HeadlessContext context;
  if (const Error error = context.Create()) GTEST_SKIP() << error.message;
  Overlay overlay;
  ASSERT_EQ(overlay.Create().message, "");
  const Simulation s = TownWithStops();
  TourPack pack = TourTown(0);
  for (const char* name : {"Breite Herzogstraße", "Kanzleistraße", "Kirchplatz", "Reichsstraße"})
    pack.streets.push_back({{{"en", name}}, {{10, 10}, {40, 10}}});
  MapPage page;
  for (size_t first = 0; first < 8; ++first) {
    ExpectWholeEverywhere(s, &overlay, [&](const PageLook& look, int width_px, int height_px) {
      Menu menu;
      OpenPage(Page::kMap, &menu);
      menu.first = first;
      ShowMapPage(pack, s, look, width_px, height_px, &menu, &overlay, &page);
    });
  }
}

TEST(PhotoOnThePages, IsWholeWhateverBecameOfIt) {
  HeadlessContext context;
  if (const Error error = context.Create()) GTEST_SKIP() << error.message;
  Overlay overlay;
  ASSERT_EQ(overlay.Create().message, "");
  const Simulation s = TownWithStops();
  for (const auto& [fails, has_code] : {std::pair{false, false}, std::pair{false, true}, std::pair{true, false}}) {
    TakenPhoto taken;
    taken.photo = {1280, 720, {}};
    taken.id = "abcdefghij";
    if (fails) taken.error = Fail("the disk is full");
    if (has_code) taken.code = overlay.AddPicture(1, 1, {0, 0, 0, 255});
    for (const bool names_file : {false, true}) {
      ExpectWholeEverywhere(s, &overlay, [&](const PageLook& look, int width_px, int height_px) {
        Menu menu;
        OpenPage(Page::kPhoto, &menu);
        ShowPhotoPage(taken, "/home/visitor/Pictures/Flaneur", names_file, look, width_px, height_px, &menu, &overlay);
      });
    }
  }
}

TEST(HotspotPanelsOfTheDemo, AreWholeInEveryLanguageTextSizeAndWindow) {
  const std::filesystem::path path =
      std::filesystem::path(FLANEUR_SOURCE_DIR) / "build_assets/wolfenbuettel/wolfenbuettel.glb";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path << ": bake the demo tour with ./demo";
  HeadlessContext context;
  if (const Error error = context.Create()) GTEST_SKIP() << error.message;
  Overlay overlay;
  ASSERT_EQ(overlay.Create().message, "");
  TourPack pack;
  PackFile file;
  ASSERT_EQ(file.Open(path, &pack).message, "");
  const Simulation s = TownWithStops();
  HotspotPicture picture;
  for (size_t k = 0; k < pack.hotspots.size(); ++k) {
    for (const std::string& language : PhraseLanguages()) {
      EXPECT_EQ(pack.hotspots[k].titles.count(language), 1u) << k << language;
      EXPECT_EQ(pack.hotspots[k].texts.count(language), 1u) << k << language;
    }
    for (const float x : {0.3f, 0.7f}) {
      Hotspots seen;
      seen.open = static_cast<int>(k);
      seen.seen.push_back({static_cast<int>(k), {x, 0.5f}, 5, 0, 1});
      ExpectWholeEverywhere(s, &overlay, [&](const PageLook& look, int width_px, int height_px) {
        ShowHotspotPanel(pack, seen, look, width_px, height_px, &overlay, &picture);
      });
    }
  }
}

TEST(AttractPage, IsWholeInEveryLanguageTextSizeAndWindow) {
  HeadlessContext context;
  if (const Error error = context.Create()) GTEST_SKIP() << error.message;
  Overlay overlay;
  ASSERT_EQ(overlay.Create().message, "");
  const Simulation s = TownWithStops();
  std::vector<std::string> languages = PhraseLanguages();
  for (const char* size : {"normal", "large", "largest"}) {
    for (const auto& [width_px, height_px] : {std::pair{800, 600}, std::pair{1280, 720}, std::pair{720, 1280}}) {
      std::rotate(languages.begin(), languages.begin() + 1, languages.end());  // another one calls
      for (size_t k = 0; k < languages.size(); ++k) {
        PlayerSettings settings;
        settings.text_size = size;
        const PageLook look = LookOf(MakeControls(settings, {}, s), s, width_px, height_px);
        std::rotate(languages.begin(), languages.begin() + 1, languages.end());
        overlay.Begin(width_px, height_px, {});
        ShowAttractPage("Wolfenbüttel im Abendlicht", languages, 0, false, look, width_px, height_px, &overlay.text());
        overlay.Draw();
        ExpectWhole(overlay.text().drawn(), width_px, height_px,
                    languages.front() + " " + size + " " + std::to_string(width_px) + ": ");
      }
    }
  }
}

TEST(Pages, ShowATourInAnyScript) {
  HeadlessContext context;
  if (const Error error = context.Create()) GTEST_SKIP() << error.message;
  Overlay overlay;
  ASSERT_EQ(overlay.Create().message, "");
  Simulation s = TownWithStops();
  s.visitor.tour.words[1].caption = "ساحة السوق. تفتح الأكشاك في الساعة السادسة.";
  s.visitor.tour.languages = {"ar", "he", "ja", "de"};
  Controls controls = MakeControls({}, {}, s);
  std::set<std::string> names;
  for (const DrawnText& t : WrittenOn(Page::kLanguages, 1280, 720, &overlay, &controls, s)) names.insert(t.text);
  for (const char* name : {"العربية", "עברית", "Deutsch", "Français"}) EXPECT_EQ(names.count(name), 1u) << name;
  ExpectWhole(WrittenOn(Page::kStops, 1280, 720, &overlay, &controls, s, "מקום"), 1280, 720, "ar: ");
}

TEST(Pages, WriteNumbersAsTheLanguageDoes) {
  HeadlessContext context;
  if (const Error error = context.Create()) GTEST_SKIP() << error.message;
  Overlay overlay;
  ASSERT_EQ(overlay.Create().message, "");
  const Simulation s = Started(TourTown(0));
  PlayerSettings settings;
  Controls controls = MakeControls(settings, {}, s);
  const auto writes = [&](const char* text) {
    const auto written = WrittenOn(Page::kSettings, 1280, 720, &overlay, &controls, s);
    return std::any_of(written.begin(), written.end(), [&](const DrawnText& t) { return t.text == text; });
  };
  EXPECT_TRUE(writes("1.5 m/s"));
  EXPECT_TRUE(writes("100%"));
  controls.settings.language = "de";
  EXPECT_TRUE(writes("1,5 m/s"));
  EXPECT_TRUE(writes("100\u00a0%"));
}

TEST(Jump, BringsVisitorAndGuideToTheStopAndTheTourOn) {
  Simulation s = Started(TourTown(60));
  for (int k = 0; k < 60; ++k) StepSimulation({}, 0, &s);
  for (const size_t stop : {size_t{5}, size_t{1}, size_t{3}}) {
    s.visitor.tour.paused = true;
    JumpToStop(stop, InTown(&s));
    for (int k = 0; k < 15; ++k) StepSimulation({}, 0, &s);
    EXPECT_TRUE(s.visitor.tour.resting) << stop;
    EXPECT_EQ(HaltOf(s.visitor.tour), stop);
    EXPECT_LT(Length(s.visitor.camera.view.position - s.visitor.tour.stops[stop].position_m), 0.6f);
    const Vec2 guide = s.town.crowd.position[s.visitor.guide.index];
    EXPECT_LT(Length(guide - s.visitor.camera.view.position), 7) << stop;
    for (size_t i = 0; i < s.town.crowd.size(); ++i) {
      EXPECT_GT(Length(s.town.crowd.position[i] - s.visitor.camera.view.position),
                s.control.settings.r_personal_m * 0.9f)
          << stop << " " << s.town.crowd.id[i];
    }
  }
  JumpToStop(99, InTown(&s));
  EXPECT_EQ(HaltOf(s.visitor.tour), 3u);
}

TEST(Notices, TellHowToWalkAndGoByThemselves) {
  Simulation s = Started(TourTown(0));
  Controls c = MakeControls({}, {}, s);
  Notices n;
  BeginHint(c, s, &n);
  FrameInput frame;
  ShowNotice(n, true, false, &frame);
  EXPECT_NE(frame.caption.find("W, A, S, D"), std::string::npos) << frame.caption;
  EXPECT_NE(frame.caption.find("Esc"), std::string::npos);
  for (int k = 0; k < 30 * 20; ++k) FollowNotices(c, s, 1.0f / 30, &n);
  frame.caption.clear();
  ShowNotice(n, true, false, &frame);
  EXPECT_EQ(frame.caption, "");
}

TEST(Notices, LeaveACaptionThatIsToStayWhereItIs) {
  Notices n;
  n.text = "The tour waits.";
  n.left_s = 3;
  FrameInput frame;
  frame.caption = "What stands here.";
  ShowNotice(n, true, true, &frame);
  EXPECT_EQ(frame.caption, "The tour waits.\nWhat stands here.");
  frame.caption.clear();
  ShowNotice(n, true, true, &frame);
  EXPECT_EQ(frame.caption, "The tour waits.");
}

TEST(Notices, TellThatTheTourWaitsAndHowToComeBack) {
  Simulation s = Started(TourTown(0));
  PlayerSettings settings;
  settings.language = "de";
  Controls c = MakeControls(settings, {}, s);
  Notices n;
  FollowNotices(c, s, 0.03f, &n);
  c.follows_tour = false;
  FollowNotices(c, s, 0.03f, &n);
  FrameInput frame;
  frame.caption = "What stands here.";
  ShowNotice(n, false, false, &frame);
  EXPECT_NE(frame.caption.find("Zurück zur Führung: Tab"), std::string::npos) << frame.caption;
  s.visitor.tour.paused = true;
  FollowNotices(c, s, 0.03f, &n);
  ShowNotice(n, false, false, &frame);
  EXPECT_NE(frame.caption.find("Leertaste"), std::string::npos) << frame.caption;
}

std::string Shown(const Notices& n) {
  FrameInput frame;
  ShowNotice(n, false, false, &frame);
  return frame.caption;
}

TEST(Notices, TellWhoLeadsAndWhatIsNext) {
  Simulation s = Started(TourTown(0));
  Controls c = MakeControls({}, {}, s);
  Notices n;
  BeginHint(c, s, &n);
  EXPECT_NE(Shown(n).find("tour leads you"), std::string::npos) << Shown(n);
  c.follows_tour = false;
  BeginHint(c, s, &n);
  EXPECT_EQ(Shown(n).find("tour leads you"), std::string::npos) << Shown(n);
  c.follows_tour = true;
  s.visitor.tour.words[3].caption = "The gate. It was shut at night.";
  BeginHint(c, s, &n);
  StepTour({true, false, false}, true, InTown(&s));
  ASSERT_EQ(HaltOf(s.visitor.tour), 3u);
  FollowNotices(c, s, 0.03f, &n);
  EXPECT_EQ(Shown(n), "Next: The gate");
  FrameInput frame;
  frame.caption = "What stands here.";
  ShowNotice(n, false, false, &frame);
  EXPECT_EQ(frame.caption, "What stands here.") << "a caption is more";
}

TEST(Notices, NameNoKeyToWhomHasNone) {
  Simulation s = Started(TourTown(0));
  PlayerSettings settings;
  settings.pointer = "point";
  Controls c = MakeControls(settings, {}, s);
  Notices n;
  BeginHint(c, s, &n);
  EXPECT_EQ(Shown(n).find("Esc"), std::string::npos) << Shown(n);
  c.follows_tour = false;
  FollowNotices(c, s, 0.03f, &n);
  EXPECT_EQ(Shown(n), "You walk on your own. Back to the tour: the button in the corner");
}

TEST(Pages, BeginForSomebodyNewAndGoOnLater) {
  Menu menu;
  MeetSomebodyNew(&menu);
  OpenPage(Page::kSettings, &menu);
  OpenPage(Page::kMain, &menu);
  EXPECT_TRUE(menu.begins) << "whoever looks at the settings first is still new";
  OpenPage(Page::kNone, &menu);
  OpenPage(Page::kMain, &menu);
  EXPECT_FALSE(menu.begins);
}

TEST(Notices, NameTheLanguageThatWasChosen) {
  TourPack pack = TourTown(0);
  pack.path[1].captions["de"] = "Etwas zu sehen.";
  Simulation s = Started(pack);
  Controls c = MakeControls({}, {}, s);
  Notices n;
  BeginHint(c, s, &n);
  for (int k = 0; k < 30 * 20; ++k) FollowNotices(c, s, 1.0f / 30, &n);
  n.is_hint = false;
  SetLanguage("de", &s.visitor.tour);
  FollowNotices(c, s, 0.03f, &n);
  EXPECT_EQ(Shown(n), "Sprache: Deutsch");
}

TEST(GroundMark, StandsWhereOneIsOnTheWayToAndGoesOnArrival) {
  TourPack pack = TourTown(0);
  pack.path.clear();
  Simulation s = Started(pack);
  s.visitor.camera.view.position = {20, 24};
  CameraInput input;
  input.active = true;
  input.walk_to = Vec2{24, 28};
  StepSimulation(input, 0, &s);
  input.walk_to.reset();
  FrameInput frame;
  PersonLooks looks;
  FrameFromSimulation(pack, s, &looks, &frame);
  ASSERT_GT(frame.ground_mark.size(), 20u);
  for (const Vec3& p : frame.ground_mark) EXPECT_LT(Length(Vec2{p.x, p.y} - Vec2{24, 28}), 0.5f);
  for (int k = 0; k < 30 * 8; ++k) StepSimulation(input, 0, &s);
  FrameFromSimulation(pack, s, &looks, &frame);
  EXPECT_TRUE(frame.ground_mark.empty());
}

}  // namespace
}  // namespace flaneur
