// The demo's guided tour from its first picture to its end and begun anew, as behind a window: pictures of a visit,
// most of them hidden as those of a minimized window are, so that it takes seconds.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "runtime/base/file.h"
#include "runtime/crowd/fast_math.h"
#include "runtime/desktop/context.h"
#include "runtime/show/guide_figure.h"
#include "runtime/simulation/scenario.h"
#include "runtime/visit/visit.h"
#include "tests/unit/runtime/visit/silent_shell.h"

namespace flaneur {
namespace {

constexpr int kWidth_px = 320, kHeight_px = 180;
constexpr float kLongest_s = 400, kStep_s = 1.0f / 30;
constexpr float kFreeView_m = 5;     // at a halt there is more to see than a wall
constexpr float kLongestWait_s = 8;  // on the way
constexpr float kLooks_s = 1;        // before a halt's end: whoever arrives with their back to it has turned by then

struct Window {
  // The tour ends at its stop of this number.
  explicit Window(const std::filesystem::path& path, const PlayerSettings& settings = {}, size_t last_stop = 1000) {
    PackFile file;
    error = file.Open(path, &pack);
    pack.path.resize(std::min(pack.path.size(), last_stop + 1));
    AddGuideFigure(&pack);
    if (!error) error = StartSimulation(&pack, ScenarioOf(pack), &s, &jobs);
    if (!error) error = context.Create();
    if (error) return;
    loader.Start(std::move(file), pack);
    visit = std::make_unique<Visit>(pack, &loader, settings, silent.shell(), &s);
    error = visit->Begin();
    for (bool there = false; !there && !error;) error = visit->Load(&there);
    if (!error) error = visit->Enter(false);
    while (!error && !loader.Done()) Picture({}, 0, false);
  }
  void Picture(const WindowInput& hands, float passed_s, bool shown) {
    error = visit->Picture(hands, shown ? kWidth_px : 0, shown ? kHeight_px : 0, passed_s, &records);
    ASSERT_EQ(error.message, "");
  }
  void Tap(const char* key) {
    WindowInput hands;
    hands.down.set(static_cast<size_t>(InputCode(key)));
    Picture(hands, kStep_s, true);
    for (int k = 0; k < 3; ++k) Picture({}, kStep_s, true);
  }
  // Of a page's rows.
  void ChooseFirst() {
    for (int k = 0; k < 3; ++k) Picture({}, kStep_s, true);
    Tap("enter");
  }
  // What the last picture shows, roughly: how many colours.
  size_t Colours() const {
    std::vector<uint8_t> rgb;
    visit->Read(&rgb);
    std::set<int> colours;
    for (size_t k = 0; k + 2 < rgb.size(); k += 3) colours.insert(rgb[k] << 16 | rgb[k + 1] << 8 | rgb[k + 2]);
    return colours.size();
  }

  Jobs jobs{2};
  TourPack pack;
  Simulation s;
  SilentShell silent;
  HeadlessContext context;
  Loader loader{&jobs};
  Records records;
  std::unique_ptr<Visit> visit;
  Error error;
};

float FromVisitor_m(const Simulation& s, Vec2 p) { return Length(p - s.visitor.camera.view.position); }

float FreeView_m(const Simulation& s) {
  float far_m = 0;
  while (far_m < kFreeView_m &&
         !InsideObstacle(s.town.walkable,
                         s.visitor.camera.view.position + DirectionOf(s.visitor.camera.view.yaw_rad) * far_m))
    far_m += 0.1f;
  return far_m;
}

void ExpectHalt(Window* w) {
  const Simulation& s = w->s;
  const size_t halt = HaltOf(s.visitor.tour);
  SCOPED_TRACE(s.visitor.tour.words[halt].caption);
  w->Picture({}, 0, true);
  EXPECT_GT(w->Colours(), 500u);
  EXPECT_GT(w->visit->statistics().people_drawn, 0);
  EXPECT_LT(std::abs(WrapAngle(s.visitor.camera.view.yaw_rad - s.visitor.tour.stops[halt].yaw_rad.value_or(0))), 0.1f);
  EXPECT_GE(FreeView_m(s), kFreeView_m);
  EXPECT_EQ(s.town.crowd.view[s.visitor.guide.index], ViewClass::kVisible);
  EXPECT_LT(FromVisitor_m(s, s.town.crowd.position[s.visitor.guide.index]), 8);
}

TEST(VisitOfTheDemo, FollowsTheGuideToTheToursEndAndBeginsAnew) {
  const std::filesystem::path path =
      std::filesystem::path(FLANEUR_SOURCE_DIR) / "build_assets/wolfenbuettel/wolfenbuettel.glb";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path << ": bake the demo tour with ./demo";
  if (HeadlessContext context; const Error error = context.Create()) GTEST_SKIP() << error.message;
  Window w(path);
  ASSERT_EQ(w.error.message, "");
  const Simulation& s = w.s;
  ASSERT_GE(s.visitor.guide.id, 0);
  std::vector<size_t> halts, seen;
  for (size_t k = 0; k < s.visitor.tour.stops.size(); ++k) {
    if (RestOf_s(s.visitor.tour, k) > 0) halts.push_back(k);
  }
  float waited_s = 0, longest_wait_s = 0, farthest_m = 0;
  while (!s.visitor.tour.over && static_cast<float>(s.town.step) * kStep_s < kLongest_s) {
    w.Picture({}, kStep_s, false);
    ASSERT_FALSE(InsideObstacle(s.town.walkable, s.visitor.camera.view.position)) << s.town.step;
    farthest_m = std::max(farthest_m, FromVisitor_m(s, s.town.crowd.position[s.visitor.guide.index]));
    waited_s = s.visitor.tour.resting || s.visitor.camera.actual_mps > 0.05f ? 0 : waited_s + kStep_s;
    longest_wait_s = std::max(longest_wait_s, waited_s);
    const bool looks =
        s.visitor.tour.resting && s.visitor.tour.rested_s > RestOf_s(s.visitor.tour, HaltOf(s.visitor.tour)) - kLooks_s;
    if (!looks || (!seen.empty() && seen.back() == HaltOf(s.visitor.tour))) continue;
    seen.push_back(HaltOf(s.visitor.tour));
    ExpectHalt(&w);
  }
  EXPECT_EQ(seen, halts);
  EXPECT_LT(farthest_m, 10);
  EXPECT_LT(longest_wait_s, kLongestWait_s);
  ASSERT_TRUE(s.visitor.tour.over);
  for (int k = 0; k < 60; ++k) w.Picture({}, kStep_s, false);
  EXPECT_EQ(s.town.crowd.view[s.visitor.guide.index], ViewClass::kVisible) << "takes leave";
  std::printf("%.0f s to the end; the guide at most %.1f m away; %.1f s of waiting on the way\n",
              static_cast<double>(s.town.step) * kStep_s, farthest_m, longest_wait_s);

  for (int k = 0; k < 60; ++k) w.Picture({}, kStep_s, false);
  ASSERT_TRUE(w.visit->shows_pages()) << "is asked what next";
  w.ChooseFirst();  // again
  EXPECT_FALSE(w.visit->shows_pages());
  EXPECT_FALSE(s.visitor.tour.over);
  EXPECT_LT(FromVisitor_m(s, s.visitor.tour.stops.front().position_m), 2);
  EXPECT_LT(FromVisitor_m(s, s.town.crowd.position[s.visitor.guide.index]), 9);
}

// Who says nothing any more at the tour's end has left: the next visitor finds everything as at the start.
TEST(VisitOfTheDemo, GoesHomeByItselfFromTheToursEnd) {
  const std::filesystem::path path =
      std::filesystem::path(FLANEUR_SOURCE_DIR) / "build_assets/wolfenbuettel/wolfenbuettel.glb";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path << ": bake the demo tour with ./demo";
  if (HeadlessContext context; const Error error = context.Create()) GTEST_SKIP() << error.message;
  Window w(path, {}, 1);
  ASSERT_EQ(w.error.message, "");
  w.pack.home_after_s = 5;
  const Simulation& s = w.s;
  const Vec2 start = s.visitor.camera.view.position;
  for (float left_s = kLongest_s; left_s > 0 && !s.visitor.tour.over; left_s -= kStep_s) w.Picture({}, kStep_s, false);
  ASSERT_TRUE(s.visitor.tour.over);
  for (int k = 0; k < 4 * 30; ++k) w.Picture({}, kStep_s, false);
  ASSERT_TRUE(w.visit->shows_pages());
  EXPECT_TRUE(s.visitor.tour.over);
  for (int k = 0; k < 4 * 30; ++k) w.Picture({}, kStep_s, false);
  EXPECT_FALSE(s.visitor.tour.over);
  EXPECT_FALSE(s.visitor.tour.begun);
  EXPECT_TRUE(w.visit->shows_pages());
  EXPECT_LT(FromVisitor_m(s, start), 0.01f);
  const int64_t step = s.town.step;
  for (int k = 0; k < 60; ++k) w.Picture({}, kStep_s, false);
  EXPECT_GT(s.town.step, step + 30) << "the town goes on behind the page";
  EXPECT_LT(FromVisitor_m(s, start), 0.01f);
  w.ChooseFirst();
  EXPECT_FALSE(w.visit->shows_pages());
  for (int k = 0; k < 30 * 20; ++k) w.Picture({}, kStep_s, false);
  EXPECT_GT(FromVisitor_m(s, start), 2);
}

TEST(VisitOfTheDemo, OpensTheMapAndKeepsAPhotoByKeys) {
  namespace fs = std::filesystem;
  const fs::path path = fs::path(FLANEUR_SOURCE_DIR) / "build_assets/wolfenbuettel/wolfenbuettel.glb";
  if (!fs::exists(path)) GTEST_SKIP() << "no " << path << ": bake the demo tour with ./demo";
  if (HeadlessContext context; const Error error = context.Create()) GTEST_SKIP() << error.message;
  const fs::path folder = fs::temp_directory_path() / ("flaneur_visit_photos_" + std::to_string(::getpid()));
  PlayerSettings settings;
  settings.photos = folder.string();
  Window w(path, settings);
  ASSERT_EQ(w.error.message, "");
  w.Tap("t");
  EXPECT_TRUE(w.visit->shows_pages());
  w.Tap("escape");
  EXPECT_FALSE(w.visit->shows_pages());
  w.Tap("p");
  EXPECT_TRUE(w.visit->shows_pages());
  ASSERT_TRUE(fs::exists(folder));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
  EXPECT_TRUE(w.silent.warnings.all.empty());
  w.Tap("enter");
  EXPECT_FALSE(w.visit->shows_pages());
  fs::remove_all(folder);
  ASSERT_FALSE(WriteTextFile(folder, "no folder"));
  w.Tap("p");
  EXPECT_EQ(w.silent.warnings.all.size(), 1u) << "and the visit goes on";
  w.Tap("enter");
  EXPECT_FALSE(w.visit->shows_pages());
  fs::remove(folder);
}

}  // namespace
}  // namespace flaneur
