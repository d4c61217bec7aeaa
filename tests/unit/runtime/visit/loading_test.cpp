// The demo's pack, read beside the pictures or between them: all of it comes, and the same, however many threads there
// are.
#include "runtime/visit/loading.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "runtime/base/clock.h"
#include "runtime/desktop/context.h"
#include "runtime/show/frame_from_simulation.h"
#include "runtime/show/guide_figure.h"

namespace flaneur {
namespace {

constexpr int kWidth_px = 160, kHeight_px = 90;
constexpr double kSome_ms = 4, kLongest_s = 240;

class LoaderOfTheDemo : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path << ": bake the demo tour with ./demo";
    if (const Error error = context.Create()) GTEST_SKIP() << error.message;
  }
  void Start(Loader* loader) {
    PackFile file;
    ASSERT_EQ(file.Open(path, &pack).message, "");
    AddGuideFigure(&pack);
    loader->Start(std::move(file), pack);
  }
  FrameInput Frame() {
    Simulation s;
    EXPECT_EQ(StartSimulation(&pack, ScenarioOf(pack), &s).message, "");
    PersonLooks looks;
    FrameInput frame;
    FrameFromSimulation(pack, s, &looks, &frame);
    return frame;
  }
  std::vector<uint8_t> Picture(Renderer* renderer) {
    FrameStatistics statistics;
    std::vector<uint8_t> rgb;
    renderer->Draw(Frame(), kWidth_px, kHeight_px, &statistics);
    EXPECT_EQ(statistics.people_not_loaded, 0);
    renderer->Read(&rgb);
    return rgb;
  }

  const std::filesystem::path path =
      std::filesystem::path(FLANEUR_SOURCE_DIR) / "build_assets/wolfenbuettel/wolfenbuettel.glb";
  HeadlessContext context;
  TourPack pack;
};

TEST_F(LoaderOfTheDemo, BringsTheSamePictureWithAnyNumberOfThreads) {
  std::vector<uint8_t> first;
  for (size_t threads : {0, 1, 4}) {
    Jobs jobs(threads);
    Loader loader(&jobs);
    pack = {};
    ASSERT_NO_FATAL_FAILURE(Start(&loader));
    Renderer renderer;
    ASSERT_EQ(renderer.Begin(pack, {.samples = 1}).message, "");
    loader.PrepareFor(renderer);
    ASSERT_EQ(loader.UploadAll(&renderer).message, "");
    EXPECT_TRUE(loader.Done());
    const std::vector<uint8_t> rgb = Picture(&renderer);
    EXPECT_GT(std::set<uint8_t>(rgb.begin(), rgb.end()).size(), 100u) << "nothing is to be seen";
    if (first.empty()) first = rgb;
    EXPECT_EQ(rgb, first) << threads << " threads";
  }
}

TEST_F(LoaderOfTheDemo, ReadsWithoutThreadsBetweenPicturesAndNothingBeforeItsTime) {
  Loader loader;
  ASSERT_NO_FATAL_FAILURE(Start(&loader));
  Renderer renderer;
  ASSERT_EQ(renderer.Begin(pack, {.samples = 1}).message, "");
  loader.PrepareFor(renderer);
  const double end_s = Now_s() + kLongest_s;
  while (!loader.TownIsThere() && Now_s() < end_s) ASSERT_EQ(loader.Upload(kSome_ms, &renderer).message, "");
  ASSERT_TRUE(loader.TownIsThere());
  for (int k = 0; k < 20; ++k) ASSERT_EQ(loader.Upload(kSome_ms, &renderer).message, "");
  EXPECT_FALSE(loader.LikenessesAreThere()) << "before the first picture nothing is read that it does not show";
  loader.GoOn();
  while (!loader.Done() && Now_s() < end_s) ASSERT_EQ(loader.Upload(kSome_ms, &renderer).message, "");
  EXPECT_TRUE(loader.Done());
  EXPECT_TRUE(loader.LikenessesAreThere());
}

TEST_F(LoaderOfTheDemo, BringsForAStillWhatItShowsAndNoMore) {
  for (size_t threads : {0, 2}) {
    std::vector<uint8_t> whole;
    for (const bool all : {true, false}) {
      Jobs jobs(threads);
      Loader loader(&jobs);
      pack = {};
      ASSERT_NO_FATAL_FAILURE(Start(&loader));
      Renderer renderer;
      ASSERT_EQ(renderer.Begin(pack, {.samples = 1}).message, "");
      loader.PrepareFor(renderer);
      if (all) {
        ASSERT_EQ(loader.UploadAll(&renderer).message, "");
        whole = Picture(&renderer);
        continue;
      }
      ASSERT_EQ(loader.UploadTown(&renderer).message, "");
      ASSERT_EQ(loader.UploadThese(renderer.AssetsFor(Frame(), kWidth_px, kHeight_px), &renderer).message, "");
      EXPECT_EQ(Picture(&renderer), whole);
      EXPECT_FALSE(loader.Done());
    }
  }
}

TEST_F(LoaderOfTheDemo, MayGoAtAnyTime) {
  for (size_t threads : {0, 1, 4}) {
    Jobs jobs(threads);
    for (int uploads : {0, 1, 30}) {
      Loader loader(&jobs);
      pack = {};
      ASSERT_NO_FATAL_FAILURE(Start(&loader));
      Renderer renderer;
      ASSERT_EQ(renderer.Begin(pack, {.samples = 1}).message, "");
      loader.PrepareFor(renderer);
      for (int k = 0; k < uploads; ++k) ASSERT_EQ(loader.Upload(kSome_ms, &renderer).message, "");
    }
  }
}

}  // namespace
}  // namespace flaneur
