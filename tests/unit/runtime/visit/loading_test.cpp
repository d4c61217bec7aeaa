// The demo's pack, read beside the pictures or between them: all of it comes, and the same, however many threads there
// are.
#include "runtime/visit/loading.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "runtime/base/clock.h"
#include "runtime/base/file.h"
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
  for (int k = 0; k < 300; ++k) ASSERT_EQ(loader.ReadOn(kSome_ms).message, "");
  EXPECT_FALSE(loader.LikenessesAreThere()) << "what is read waits for its upload";
  while (!loader.Done() && Now_s() < end_s) {
    ASSERT_EQ(loader.ReadOn(kSome_ms).message, "");
    ASSERT_EQ(loader.Upload(kSome_ms, &renderer).message, "");
  }
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
      ASSERT_EQ(loader.UploadThese({}, &renderer).message, "");
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

// All but the bulk is there at first, and the town's first half with it.
TEST_F(LoaderOfTheDemo, BringsTheSamePictureOfAPackThatArrivesInPieces) {
  std::vector<uint8_t> bytes;
  ASSERT_EQ(ReadFile(path, &bytes).message, "");
  PackFile whole;
  ASSERT_EQ(whole.Open(bytes, "whole", &pack).message, "");
  std::vector<ByteRange> later;
  ByteRanges of_later, there;
  const auto leave_out = [&](const std::vector<ByteRange>& ranges, size_t kept) {
    for (const ByteRange& r : ranges) {
      if (r.bytes <= kept) continue;
      later.push_back({r.offset + kept, r.bytes - kept});
      of_later.Add(later.back());
    }
  };
  for (size_t k = 0; k < pack.meshes.size(); k += k < 600 ? 2 : 1)
    leave_out(whole.RangesOfMesh(static_cast<int>(k)), 0);
  for (size_t k = 0; k < pack.images.size(); ++k) leave_out(whole.RangesOfImage(static_cast<int>(k)), 2048);
  for (size_t k = 0; k < pack.avatars.size(); ++k) {
    const std::vector<ByteRange> all = whole.RangesOfAtlas(static_cast<int>(k)),
                                 coarse = whole.RangesOfAtlas(static_cast<int>(k), kCoarsestAtlasLevel);
    for (size_t view = 0; view < all.size(); ++view) {
      ASSERT_LT(coarse[view].bytes, all[view].bytes / 2);
      leave_out({all[view]}, coarse[view].bytes);
    }
  }
  std::vector<uint8_t> begun(bytes.size());
  for (size_t at = 0; at < bytes.size(); ++at) {
    if (const size_t skipped = of_later.HeldFrom(at)) {
      at += skipped - 1;
      continue;
    }
    begun[at] = bytes[at];
    there.Add({at, 1});
  }

  pack = {};
  PackFile file;
  ASSERT_EQ(file.Open(std::move(begun), there, "in pieces", &pack).message, "");
  EXPECT_FALSE(file.IsWhole());
  PackMesh missing;
  EXPECT_NE(file.ReadMesh(0, &missing).message.find("has not arrived"), std::string::npos);
  AddGuideFigure(&pack);
  Loader loader;
  loader.Start(std::move(file), pack);
  Renderer renderer;
  ASSERT_EQ(renderer.Begin(pack, {.samples = 1}).message, "");
  loader.PrepareFor(renderer);
  loader.GoOn();
  const double end_s = Now_s() + kLongest_s;
  while (!loader.LikenessesAreThere() && Now_s() < end_s) ASSERT_EQ(loader.Upload(kSome_ms, &renderer).message, "");
  EXPECT_TRUE(loader.LikenessesAreThere()) << "people's coarsest pictures are there";
  EXPECT_FALSE(loader.Done());
  FrameStatistics statistics;
  renderer.Draw(Frame(), kWidth_px, kHeight_px, &statistics);
  EXPECT_GT(statistics.people_drawn, 0);
  EXPECT_NE(loader.Arrive(bytes.size() - 1, std::vector<uint8_t>(2)).message, "");
  for (auto range = later.rbegin(); range != later.rend(); ++range)  // from the end on: in any order
    ASSERT_EQ(loader.Arrive(range->offset, std::span(bytes).subspan(range->offset, range->bytes)).message, "");
  while (!loader.Done() && Now_s() < end_s) ASSERT_EQ(loader.Upload(kSome_ms, &renderer).message, "");
  ASSERT_TRUE(loader.Done());
  renderer.StartAnew();
  const std::vector<uint8_t> in_pieces = Picture(&renderer);

  Loader at_once;
  pack = {};
  ASSERT_NO_FATAL_FAILURE(Start(&at_once));
  Renderer other;
  ASSERT_EQ(other.Begin(pack, {.samples = 1}).message, "");
  at_once.PrepareFor(other);
  ASSERT_EQ(at_once.UploadAll(&other).message, "");
  EXPECT_EQ(in_pieces, Picture(&other));
}

// The small tour's person eight times, each with thirty levels of two meshes that all of them share.
std::vector<uint8_t> PackOfSharedMeshes() {
  std::vector<uint8_t> bytes;
  EXPECT_EQ(ReadFile(std::filesystem::path(FLANEUR_SOURCE_DIR) / "tests/data/fuzz/pack/small.glb", &bytes).message, "");
  const auto word = [&](size_t at) -> uint32_t& { return *reinterpret_cast<uint32_t*>(bytes.data() + at); };
  const std::ptrdiff_t json_bytes = word(12);
  nlohmann::json json = nlohmann::json::parse(bytes.begin() + 20, bytes.begin() + 20 + json_bytes);
  nlohmann::json& avatars = json["extensions"]["FLANEUR_tour"]["avatars"];
  nlohmann::json avatar = avatars[0];
  nlohmann::json levels = nlohmann::json::array();
  for (size_t k = 0; k < 30; ++k) levels.push_back(avatar["levels"][k / 15]);
  avatar["levels"] = levels;
  avatars.clear();
  for (int k = 0; k < 8; ++k) {
    avatars.push_back(avatar);
    if (k > 0) avatars.back()["name"] = "made " + std::to_string(k);
  }
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  bytes.erase(bytes.begin() + 20, bytes.begin() + 20 + json_bytes);
  bytes.insert(bytes.begin() + 20, text.begin(), text.end());
  word(8) = static_cast<uint32_t>(bytes.size());
  word(12) = static_cast<uint32_t>(text.size());
  return bytes;
}

TEST(Loader, BringsAMeshToAllWhoShareItWithAnyNumberOfThreads) {
  HeadlessContext context;
  if (const Error error = context.Create()) GTEST_SKIP() << error.message;
  const std::vector<uint8_t> bytes = PackOfSharedMeshes();
  std::vector<uint8_t> first;
  for (size_t threads : {0, 1, 8, 8, 8}) {
    Jobs jobs(threads);
    Loader loader(&jobs);
    TourPack pack;
    PackFile file;
    ASSERT_EQ(file.Open(bytes, "shared.glb", &pack).message, "");
    loader.Start(std::move(file), pack);
    Renderer renderer;
    ASSERT_EQ(renderer.Begin(pack, {.samples = 1}).message, "");
    loader.PrepareFor(renderer);
    ASSERT_EQ(loader.UploadAll(&renderer).message, "");
    FrameInput frame;
    frame.eye = {-8, 0, 1.6f};
    for (int k = 0; k < 8; ++k) {
      for (int level : {0, 29}) {
        DrawnPerson person;
        person.avatar = k;
        person.position = {level == 0 ? 0.0f : 2.0f, static_cast<float>(k) - 3.5f, 0};
        person.level = MeshLevel(level);
        frame.people.push_back(person);
      }
    }
    FrameStatistics statistics;
    std::vector<uint8_t> rgb;
    renderer.Draw(frame, kWidth_px, kHeight_px, &statistics);
    renderer.Read(&rgb);
    if (first.empty()) first = rgb;
    EXPECT_EQ(rgb, first) << threads << " threads";
  }
}

}  // namespace
}  // namespace flaneur
