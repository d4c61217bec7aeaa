// What tour.toml says to visitors, and the media that come of it.
#include "pipeline/cli/visitor_settings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/cli/assemble_town.h"
#include "pipeline/cli/tour_settings.h"
#include "pipeline/cli/visitor_media.h"
#include "pipeline/core/temporary_folder.h"
#include "pipeline/pictures/picture_files.h"
#include "runtime/base/file.h"
#include "runtime/base/pixels.h"
#include "runtime/base/png.h"
#include "tests/unit/pipeline/cli/reads_tour.h"

namespace flaneur {
namespace {

const std::string kTour = "[town]\nfile = \"town.glb\"\n[[avatar]]\nfile = \"person.glb\"\n";

struct VisitorSettings : ReadsTour {
  VisitorSettings() : ReadsTour(kTour) {}
  std::vector<uint8_t> PictureOf(int width_px, int height_px, int channels) {
    std::vector<uint8_t> pixels(static_cast<size_t>(width_px * height_px * channels), 200);
    return EncodePng(width_px, height_px, channels, pixels);
  }
};

TEST_F(VisitorSettings, AHotspotHasAPlaceATitleAndWhatItTells) {
  ASSERT_EQ(Read("[[hotspot]]\nposition_m = [3, 4]\ntitle = { en = \"Well\", de = \"Brunnen\" }\ntext = \"Deep.\"\n"
                 "picture = \"well.jpg\"\nsound = { de = \"well.ogg\" }\nspeak = true\nradius_m = 7\n"),
            "");
  ASSERT_EQ(settings.hotspots.size(), 1u);
  EXPECT_EQ(settings.hotspots[0].position_m.y, 4);
  EXPECT_EQ(settings.hotspots[0].radius_m, 7);
  EXPECT_EQ(settings.hotspots[0].titles.at("de"), "Brunnen");
  EXPECT_EQ(settings.hotspots[0].texts.at("en"), "Deep.");
  EXPECT_EQ(settings.visitor_files.hotspots[0].picture, folder.path() / "well.jpg");
  EXPECT_EQ(settings.visitor_files.hotspots[0].sounds.at("de"), folder.path() / "well.ogg");
  EXPECT_TRUE(settings.visitor_files.hotspots[0].speak);
  EXPECT_EQ(FilesOf(settings.visitor_files).size(), 2u);
}

TEST_F(VisitorSettings, WhatIsMissingOrWrongIsSaidInOneLine) {
  EXPECT_TRUE(Refuses("[[hotspot]]\ntitle = \"Well\"\n", "a [[hotspot]] needs position_m"));
  EXPECT_TRUE(Refuses("[[hotspot]]\nposition_m = [0, 0]\n", "a [[hotspot]] needs a title"));
  EXPECT_TRUE(Refuses("[[hotspot]]\nposition_m = [0, 0]\ntitle = { de = \"Brunnen\" }\n", "tour's own language"));
  EXPECT_TRUE(Refuses("[[hotspot]]\nposition_m = [0, 0]\ntitle = \"W\"\nradius_m = 0\n", "hotspot.radius_m"));
  EXPECT_TRUE(
      Refuses("[[hotspot]]\nposition_m = [0, 0]\ntitle = \"W\"\npicure = \"w.png\"\n", "did you mean 'picture'"));
  EXPECT_TRUE(Refuses("[[street]]\nname = \"A\"\npoints_m = [[0, 0]]\n", "two at least"));
  EXPECT_TRUE(Refuses("[[street]]\npoints_m = [[0, 0], [1, 1]]\n", "a [[street]] needs a name"));
  EXPECT_TRUE(Refuses("[[sound]]\nkind = \"horn\"\nposition_m = [0, 0]\n", "must be one of: steps, murmur"));
  EXPECT_TRUE(Refuses("[[sound]]\nkind = \"water\"\n", "a [[sound]] needs position_m"));
  EXPECT_TRUE(Refuses("[[sound]]\nposition_m = [0, 0]\n", "of kind \"loop\" needs a file"));
  EXPECT_TRUE(Refuses("[photo]\nlink = \"https://example.org\"\n", "put {file} or {id}"));
  EXPECT_TRUE(Refuses("[speech]\nwords_per_minute = 5\n", "speech.words_per_minute"));
}

TEST_F(VisitorSettings, StepsNeedNoPlace) {
  ASSERT_EQ(Read("[[sound]]\nkind = \"steps\"\nvolume = 0\n"), "");
  ASSERT_EQ(settings.sound_places.size(), 1u);
  EXPECT_EQ(settings.sound_places[0].kind, SoundKind::kSteps);
  EXPECT_EQ(settings.sound_places[0].volume, 0);
}

TEST_F(VisitorSettings, PicturesAreScaledAndKeepTheirShape) {
  const auto file = folder.path() / "wide.png";
  ASSERT_FALSE(WriteFile(file, PictureOf(3000, 1500, 3)));
  std::vector<uint8_t> bytes;
  ASSERT_EQ(ScaledPicture(file, kMaxPictureSide_px, &bytes).message, "");
  const auto picture = Decoded(bytes);
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->width, kMaxPictureSide_px);
  EXPECT_EQ(picture->height, kMaxPictureSide_px / 2);
  EXPECT_NEAR(picture->rgba[0], 200, 3);
  ASSERT_FALSE(WriteFile(file, PictureOf(40, 30, 4)));
  ASSERT_EQ(ScaledPicture(file, kMaxPictureSide_px, &bytes).message, "");
  EXPECT_EQ(Decoded(bytes)->height, 30);
  EXPECT_NEAR(Decoded(bytes)->rgba[3], 200, 1);
  ASSERT_FALSE(WriteTextFile(file, "no picture"));
  EXPECT_EQ(ScaledPicture(file, kMaxPictureSide_px, &bytes).message.find(file.string()), 0u);
}

TEST_F(VisitorSettings, WhatIsToBeSpokenIsInEveryLanguageAndARecordingStaysAsItIs) {
  ASSERT_EQ(Read("[[stop]]\nposition_m = [0, 0]\ncaption = { en = \"Good day.\", de = \"Guten Tag.\" }\nspeak = true\n"
                 "[[stop]]\nposition_m = [1, 0]\ncaption = \"Silent.\"\n"),
            "");
  TourParts parts;
  static_cast<TourData&>(parts) = settings;
  ASSERT_EQ(MakeVisitorMedia(settings, Store{folder.path()}, &parts).message, "");
  EXPECT_TRUE(parts.path[1].sounds.empty());
  ASSERT_EQ(parts.path[0].sounds.size(), 2u);
  EXPECT_EQ(parts.sounds.size(), 2u);
  const StopSound english = parts.path[0].sounds.at("en"), german = parts.path[0].sounds.at("de");
  EXPECT_NE(parts.sounds[static_cast<size_t>(english.sound)], parts.sounds[static_cast<size_t>(german.sound)]);
  EXPECT_GT(english.duration_s, 0.3f);
  EXPECT_LT(english.duration_s, 4);
  EXPECT_LT(parts.sounds[0].size(), 30000u);

  settings.sounds[0]["de"] = folder.path() / "own.wav";
  std::vector<uint8_t> own;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    if (entry.path().extension() != ".ogg") continue;
    ASSERT_FALSE(ReadFile(entry.path(), &own));
  }
  ASSERT_FALSE(WriteFile(folder.path() / "own.wav", own));
  TourParts again;
  static_cast<TourData&>(again) = settings;
  ASSERT_EQ(MakeVisitorMedia(settings, Store{folder.path()}, &again).message, "");
  EXPECT_EQ(again.sounds[static_cast<size_t>(again.path[0].sounds.at("de").sound)], own);
}

TEST_F(VisitorSettings, TextsOfAnyLengthInAnyLetterAreSpoken) {
  const std::string letters = "Türme", ones = "Das sind nun schon zwei Dutzend ";
  for (size_t more = 0; more < 6; ++more) {  // wherever the letter of two bytes stands
    settings = {};
    const std::string text = ones + std::string(more, 'a') + " " + letters;
    ASSERT_EQ(Read("[[stop]]\nposition_m = [0, 0]\ncaption = { en = \"A\", de = \"" + text + "\" }\nspeak = true\n"),
              "");
    TourParts parts;
    static_cast<TourData&>(parts) = settings;
    EXPECT_EQ(MakeVisitorMedia(settings, Store{folder.path()}, &parts).message, "");
  }
}

TEST_F(VisitorSettings, AVoiceThatThereIsNotIsNamed) {
  ASSERT_EQ(
      Read("[speech]\nvoice = { en = \"nobody\" }\n[[stop]]\nposition_m = [0, 0]\ncaption = \"Hear\"\nspeak = true\n"),
      "");
  TourParts parts;
  static_cast<TourData&>(parts) = settings;
  const std::string message = MakeVisitorMedia(settings, Store{folder.path()}, &parts).message;
  EXPECT_NE(message.find("'nobody'"), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

// A street of two pieces, 30 m long and 4 m wide, that runs to the north-east.
TEST(TaggedStreets, RunAlongTheirGround) {
  Scene town;
  for (int k = 0; k < 2; ++k) {
    Mesh mesh;
    for (float along : {0.0f, 15.0f}) {
      for (float side : {-2.0f, 2.0f}) {
        const float x = along + 15.0f * static_cast<float>(k);
        mesh.positions.push_back(GltfFromGround({(x - side) * std::sqrt(0.5f), (x + side) * std::sqrt(0.5f), 0}));
      }
    }
    SceneNode node;
    node.kind = NodeKind::kGround;
    node.street = "Long Street";
    node.meshes = {k};
    town.meshes.push_back(mesh);
    town.nodes.push_back(node);
  }
  const std::vector<Street> streets = TaggedStreets(town, "en");
  ASSERT_EQ(streets.size(), 1u);
  EXPECT_EQ(streets[0].names.at("en"), "Long Street");
  ASSERT_EQ(streets[0].points.size(), 2u);
  const Vec2 way = streets[0].points[1] - streets[0].points[0];
  EXPECT_NEAR(Length(way), 30, 0.5f);
  EXPECT_NEAR(std::abs(way.x), std::abs(way.y), 1);
  EXPECT_GT(way.x * way.y, 0);
}

}  // namespace
}  // namespace flaneur
