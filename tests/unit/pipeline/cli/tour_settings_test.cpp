#include "pipeline/cli/tour_settings.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "pipeline/core/temporary_folder.h"
#include "runtime/base/file.h"
#include "runtime/tour_data/settings.h"

namespace flaneur {
namespace {

const std::filesystem::path kReference = std::filesystem::path(FLANEUR_SOURCE_DIR) / "assets_src/reference/tour.toml";
constexpr const char* kMinimalTour = "[town]\nfile = \"town.glb\"\n[[avatar]]\nfile = \"person.glb\"\n";

// Reads tour.toml with this text; returns the error's message behind the file's name.
std::string Read(const std::string& text, TourSettings* settings) {
  TemporaryFolder folder;
  EXPECT_FALSE(folder.Create("flaneur_test_"));
  const auto path = folder.path() / "tour.toml";
  EXPECT_FALSE(WriteTextFile(path, text));
  const std::string message = ReadTourSettings(path, settings).message;
  if (message.empty()) return "";
  EXPECT_EQ(message.rfind(path.string(), 0), 0u) << message;
  return message.substr(path.string().size());
}

std::string Refusal(const std::string& text) {
  TourSettings settings;
  return Read(text, &settings);
}

// Every value of a settings struct as text.
struct Dump {
  std::ostringstream out;
  template <typename T>
  void Number(const char* name, T* value, double, double) {
    out << name << '=' << *value << '\n';
  }
  void Angle(const char* name, float* value, double, double) { out << name << '=' << *value << '\n'; }
  void Choice(const char* name, std::string* value, std::initializer_list<const char*>) {
    out << name << '=' << *value << '\n';
  }
};

template <typename T>
std::string Dumped(T settings) {
  Dump dump;
  VisitFields(dump, &settings);
  return dump.out.str();
}

TEST(TourSettings, TheReferenceFileHoldsTheDefaults) {
  TourSettings reference, least;
  ASSERT_EQ(ReadTourSettings(kReference, &reference).message, "");
  ASSERT_EQ(Read(kMinimalTour, &least), "");
  EXPECT_EQ(reference.name, "reference");
  EXPECT_TRUE(reference.thanks.empty());
  EXPECT_EQ(reference.home_after_s, least.home_after_s);
  EXPECT_EQ(Dumped(reference.crowd), Dumped(CrowdSettings{}));
  EXPECT_EQ(Dumped(reference.control), Dumped(ControlSettings{}));
  EXPECT_EQ(Dumped(reference.light), Dumped(LightSettings{}));
  EXPECT_EQ(Dumped(reference.wind), Dumped(WindSettings{}));
  const LevelsOptions levels;
  EXPECT_EQ(reference.levels.ratios, levels.ratios);
  EXPECT_EQ(reference.levels.error_px, levels.error_px);
  EXPECT_EQ(reference.levels.max_triangles, levels.max_triangles);
  EXPECT_EQ(reference.levels.min_triangles, levels.min_triangles);
  const ImpostorOptions impostor;
  EXPECT_EQ(reference.impostor.directions, impostor.directions);
  EXPECT_EQ(reference.impostor.elevations_deg, impostor.elevations_deg);
  EXPECT_EQ(reference.impostor.height_px, impostor.height_px);
  EXPECT_EQ(reference.impostor.border_px, impostor.border_px);
  EXPECT_EQ(reference.impostor.samples, impostor.samples);
  ASSERT_EQ(reference.impostor.clips.size(), impostor.clips.size());
  for (size_t i = 0; i < impostor.clips.size(); ++i) {
    EXPECT_EQ(reference.impostor.clips[i].phases, impostor.clips[i].phases);
  }
  const FootprintOptions footprints;
  EXPECT_DOUBLE_EQ(reference.footprints.clearance_m, footprints.clearance_m);
  EXPECT_EQ(reference.footprints.band_m, footprints.band_m);
  EXPECT_DOUBLE_EQ(reference.footprints.tolerance_m, footprints.tolerance_m);
  EXPECT_DOUBLE_EQ(reference.footprints.bridge_m, footprints.bridge_m);
  EXPECT_DOUBLE_EQ(reference.footprints.open_yard_m2, footprints.open_yard_m2);
  EXPECT_EQ(reference.footprints.merge_blocks, footprints.merge_blocks);
  EXPECT_DOUBLE_EQ(reference.ground.cell_m, GroundRasterOptions{}.cell_m);
  EXPECT_EQ(reference.town_scale, least.town_scale);
  EXPECT_EQ(reference.town.seed, least.town.seed);
}

TEST(TourSettings, TintsAreColoursAndSaySoWhereTheyAreNot) {
  const std::string tint = std::string(kMinimalTour) + "[[avatar.tint]]\n";
  TourSettings settings;
  ASSERT_EQ(Read(tint + "color = \"#336699\"\ncolors = [\"#ff0000\", \"#00ff00\"]\n", &settings), "");
  ASSERT_EQ(settings.avatars[0].tints.size(), 1u);
  EXPECT_NEAR(settings.avatars[0].tints[0].color.y, 0.4f, 1e-6f);
  EXPECT_EQ(settings.avatars[0].tints[0].colors.size(), 2u);
  TourSettings bound;
  ASSERT_EQ(Read(tint + "color = \"#336699\"\ncolors = [\"#ff0000\"]\nmaterials = [\"coat\"]\n", &bound), "");
  EXPECT_EQ(bound.avatars[0].tint_materials, (std::vector<std::vector<std::string>>{{"coat"}}));
  const auto has = [](const std::string& message, const char* what) { return message.find(what) != std::string::npos; };
  EXPECT_TRUE(
      has(Refusal(tint + "color = \"blue\"\ncolors = [\"#ff0000\"]\n"), "must be a colour such as \"#2f4f8f\""));
  EXPECT_TRUE(has(Refusal(tint + "color = \"#336699\"\ncolors = [\"#ff0000\", \"red\"]\n"), "'red' must be a colour"));
  EXPECT_TRUE(has(Refusal(tint + "color = \"#336699\"\n"), "needs the color of a cloth"));
  EXPECT_TRUE(has(Refusal(tint + "color = \"#336699\"\ncolors = [\"#ff0000\"]\nreach = 0\n"), "reach"));
  std::string four = kMinimalTour;
  for (int k = 0; k < 4; ++k) four += "[[avatar.tint]]\ncolor = \"#336699\"\ncolors = [\"#ff0000\"]\n";
  EXPECT_TRUE(has(Refusal(four), "three [[avatar.tint]] at most"));
}

TEST(TourSettings, PropsNameTheirNodeAndShareASlotAtMostOnce) {
  const std::string prop = std::string(kMinimalTour) + "[[avatar.prop]]\n";
  TourSettings settings;
  ASSERT_EQ(
      Read(prop + "node = \"basket\"\nslot = \"hand\"\n[[avatar.prop]]\nnode = \"jug\"\nslot = \"hand\"\n", &settings),
      "");
  ASSERT_EQ(settings.avatars[0].props.size(), 2u);
  EXPECT_EQ(settings.avatars[0].props[1].name, "jug");
  const auto has = [](const std::string& message, const char* what) { return message.find(what) != std::string::npos; };
  EXPECT_TRUE(has(Refusal(prop + "share = 0.5\n"), "needs the node"));
  EXPECT_TRUE(has(Refusal(prop + "node = \"a\"\n[[avatar.prop]]\nnode = \"a\"\n"), "two props are the node 'a'"));
  EXPECT_TRUE(
      has(Refusal(prop + "node = \"a\"\nslot = \"s\"\n[[avatar.prop]]\nnode = \"b\"\nshare = 0.6\nslot = \"s\"\n"),
          "more than 1 together"));
  std::string eight = kMinimalTour;
  for (int k = 0; k < 8; ++k) eight += "[[avatar.prop]]\nnode = \"p" + std::to_string(k) + "\"\n";
  EXPECT_TRUE(has(Refusal(eight), "seven [[avatar.prop]] at most"));
}

TEST(TourSettings, PlacesOfWorkSayWhatIsDoneThereAndByWhom) {
  const std::string work = std::string(kMinimalTour) + "[[place]]\nkind = \"work\"\nposition_m = [1, 2]\n";
  TourSettings settings;
  ASSERT_EQ(Read(work + "clip = \"sit\"\navatars = [\"person\"]\nseat_m = 0.4\nstay_s = 30\n", &settings), "");
  ASSERT_EQ(settings.places.size(), 1u);
  EXPECT_EQ(settings.places[0].clip, "sit");
  EXPECT_EQ(settings.places[0].avatars, std::vector<std::string>{"person"});
  EXPECT_EQ(settings.places[0].seat_m, 0.4f);
  EXPECT_EQ(settings.places[0].stay_s, 30);
  const auto has = [](const std::string& message, const char* what) { return message.find(what) != std::string::npos; };
  EXPECT_TRUE(has(Refusal(work + "avatars = [\"maid\"]\n"), "no [[avatar]] has the name 'maid'"));
  EXPECT_TRUE(has(Refusal(work + "seat_m = -1\n"), "seat_m"));
  EXPECT_TRUE(has(Refusal(std::string(kMinimalTour) + "[[place]]\nposition_m = [1, 2]\nclip = \"sit\"\n"),
                  "clip is for a [[place]] of kind \"work\""));
  const std::string clip = std::string(kMinimalTour) + "[[avatar.clip]]\n";
  EXPECT_TRUE(has(Refusal(clip + "name = \"walk\"\n"), "needs the file that it is in"));
  EXPECT_TRUE(has(Refusal(clip + "seat_m = 0.4\n"), "needs a name"));
  EXPECT_TRUE(has(Refusal(std::string(kMinimalTour) + "scale = 0.01\nheight_m = 1.7\n"), "not both"));
  EXPECT_TRUE(has(Refusal(std::string(kMinimalTour) + "[[avatar.part]]\n"), "needs a file"));
  EXPECT_TRUE(has(Refusal(clip + "name = \"a\"\n[[avatar.clip]]\nname = \"a\"\n"), "two clips are named 'a'"));
}

TEST(TourSettings, TheReferenceFileHoldsTheDefaultsOfEveryList) {
  TourSettings reference, least;
  ASSERT_EQ(ReadTourSettings(kReference, &reference).message, "");
  ASSERT_EQ(Read(std::string(kMinimalTour) + "[[town.part]]\nfile = \"house.gltf\"\n", &least), "");
  ASSERT_EQ(reference.avatars.size(), 1u);
  const AvatarSettings &a = reference.avatars[0], &b = least.avatars[0];
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.source.seed, b.source.seed);
  EXPECT_EQ(nlohmann::json::parse(a.source.options_json), nlohmann::json::parse(b.source.options_json));
  EXPECT_EQ(a.share, b.share);
  EXPECT_EQ(a.height_m, b.height_m);
  EXPECT_EQ(a.walk + a.idle + a.talk, "");
  EXPECT_TRUE(a.hide.empty());
  ASSERT_EQ(reference.parts.size(), 1u);
  EXPECT_EQ(reference.parts[0].scale, least.parts[0].scale);
  EXPECT_EQ(reference.parts[0].yaw_deg, least.parts[0].yaw_deg);
  ASSERT_EQ(reference.places.size(), 3u);
  EXPECT_EQ(reference.places[0].width_m, Place{}.width_m);
  EXPECT_EQ(reference.places[1].seat_m, Place{}.seat_m);
  EXPECT_EQ(reference.places[1].stay_s, Place{}.stay_s);
  EXPECT_EQ(reference.impostor.work_phases, least.impostor.work_phases);
  ASSERT_EQ(reference.path.size(), 1u);
  EXPECT_EQ(reference.path[0].pause_s, TourStop{}.pause_s);
}

TEST(TourSettings, TheReferenceFileNamesEveryKnownSetting) {
  std::ifstream file(kReference);
  std::set<std::string> named;
  std::string section;
  const std::regex header(R"(\[+([a-z._]+)\]+.*)"), key(R"(([a-z0-9_]+) = .*)");
  for (std::string line; std::getline(file, line);) {
    std::smatch match;
    if (std::regex_match(line, match, header)) section = match[1];
    else if (std::regex_match(line, match, key)) named.insert(section + "." + match[1].str());
  }
  const std::vector<std::string> known = KnownSettings();
  EXPECT_EQ(named, std::set<std::string>(known.begin(), known.end()));
}

TEST(TourSettings, AGeoreferenceKeepsItsDigits) {
  const auto with = [](const std::string& more) {
    return "[town]\nfile = \"town.glb\"\n" + more + "\n[[avatar]]\nfile = \"person.glb\"\n";
  };
  TourSettings s;
  ASSERT_EQ(Read(with("georeference = { crs = \"EPSG:25832\", origin_m = [603900.125, 5780000] }"), &s), "");
  EXPECT_EQ(s.georeference.crs, "EPSG:25832");
  EXPECT_EQ(s.georeference.origin_m.x, 603900.125);
  EXPECT_EQ(s.georeference.origin_m.y, 5780000);
  for (const char* origin : {"[1]", "[1, 2, 3]", "5", "[1, \"b\"]", "[nan, 0]", "[1e9, 0]"}) {
    const std::string message = Refusal(with(std::string("georeference = { origin_m = ") + origin + " }"));
    EXPECT_EQ(message.find(":3: town.georeference.origin_m must be"), 0u) << message;
  }
  EXPECT_NE(Refusal(with("georeference = { srs = \"EPSG:25832\" }")).find("unknown key 'srs' in [town.georeference]"),
            std::string::npos);
}

TEST(TourSettings, TheDemoTourIsUnderstood) {
  TourSettings demo;
  ASSERT_EQ(
      ReadTourSettings(std::filesystem::path(FLANEUR_SOURCE_DIR) / "assets_src/wolfenbuettel/tour.toml", &demo).message,
      "");
  EXPECT_GE(demo.avatars.size(), 8u);
  for (const AvatarSettings& avatar : demo.avatars) EXPECT_TRUE(std::filesystem::exists(avatar.source.file));
  EXPECT_TRUE(std::filesystem::exists(demo.town.file));
}

TEST(TourSettings, FilesAreTakenFromTheTourFilesFolder) {
  TourSettings settings;
  ASSERT_EQ(Read(kMinimalTour, &settings), "");
  EXPECT_TRUE(settings.town.file.is_absolute());
  EXPECT_EQ(settings.town.file.filename(), "town.glb");
}

TEST(TourSettings, AnglesBecomeRadians) {
  TourSettings settings;
  ASSERT_EQ(Read(std::string(kMinimalTour) + "[control]\nfov_deg = 90\n[[stop]]\nposition_m = [1, 2]\nyaw_deg = -180\n",
                 &settings),
            "");
  EXPECT_FLOAT_EQ(settings.control.fov_rad, kPi / 2);
  EXPECT_FLOAT_EQ(settings.path.at(0).yaw_rad.value(), -kPi);
}

// Each with the line it must name and words it must hold.
TEST(TourSettings, RefusalsNameTheLineAndWhatToDo) {
  struct Case {
    const char* more;
    const char* line;
    std::vector<const char*> words;
  };
  const Case cases[] = {
      {"[control]\nhihg_limit = 3\n", ":6:", {"hihg_limit", "did you mean 'high_limit'"}},
      {"[contrl]\n", ":5:", {"contrl", "did you mean 'control'"}},
      {"[crowd]\npeople = \"many\"\n", ":6:", {"crowd.people", "whole number"}},
      {"[crowd]\npeople = 3.5\n", ":6:", {"crowd.people", "whole number"}},
      {"[crowd]\npeople = -1\n", ":6:", {"crowd.people", "-1", "0", "200000"}},
      {"[control]\nmethod = \"guess\"\n", ":6:", {"control.method", "count", "frame_time"}},
      {"[light]\nday_length_s = nan\n", ":6:", {"light.day_length_s"}},
      {"[stop]\nposition_m = [0, 0]\n", ":5:", {"[[stop]]", "two brackets"}},
      {"[[stop]]\nposition_m = [0]\n", ":6:", {"stop.position_m", "[x, y]"}},
      {"[[place]]\nkind = \"door\"\n", ":5:", {"position_m"}},
      {"[[place]]\nposition_m = [0, 0]\nkind = \"window\"\n", ":7:", {"place.kind", "window", "loiter"}},
      {"[footprints]\nband_m = [2, 1]\n", ":5:", {"band_m", "low", "high"}},
      {"[control]\nr_high_m = 100\n", ":", {"r_high_m", "r_unimportant_m"}},
      {"[[avatar]]\nname = \"person\"\nfile = \"other.glb\"\n", ":5:", {"person", "own name"}},
      {"[[avatar]]\nshare = 1\n", ":5:", {"avatar", "file"}},
      {"[[avatar]]\nname = \"../up\"\nfile = \"x.glb\"\n", ":5:", {"../up", "file name"}},
      {"[[stop]]\nposition_m = [0, 0]\ncaption = 3\n", ":7:", {"stop.caption", "by language"}},
      {"[[stop]]\nposition_m = [0, 0]\ncaption = { de = \"Hier\" }\n", ":5:", {"'en'", "tour.language"}},
      {"[tour]\ntitle = { de = \"Markt\" }\n", ":", {"tour.title", "'en'", "tour.language"}},
      {"[tour]\nguide = \"monk\"\n", ":", {"tour.guide", "monk", "[[avatar]]"}},
      {"[control\n", ":5:", {"TOML"}},
  };
  for (const Case& c : cases) {
    const std::string message = Refusal(std::string(kMinimalTour) + c.more);
    EXPECT_EQ(message.rfind(c.line, 0), 0u) << c.more << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
    for (const char* word : c.words) EXPECT_NE(message.find(word), std::string::npos) << c.more << message;
  }
  EXPECT_NE(Refusal("[[avatar]]\nfile = \"a.glb\"\n").find("town"), std::string::npos);
  EXPECT_NE(Refusal("[town]\nfile = \"a.glb\"\n").find("avatar"), std::string::npos);
}

// The pack's schema is written by hand; the settings in it are those of VisitFields, with their ranges.
struct SchemaCheck {
  nlohmann::json properties;
  std::set<std::string> seen;
  template <typename T>
  void Number(const char* name, T*, double least, double most) {
    ASSERT_TRUE(properties.contains(name)) << name;
    EXPECT_EQ(properties[name]["type"], std::is_integral_v<T> ? "integer" : "number") << name;
    EXPECT_EQ(properties[name]["minimum"].get<double>(), least) << name;
    EXPECT_EQ(properties[name]["maximum"].get<double>(), most) << name;
    seen.insert(name);
  }
  void Angle(const char* stem, float*, double least_deg, double most_deg) {
    const std::string name = std::string(stem) + "_rad";
    ASSERT_TRUE(properties.contains(name)) << name;
    EXPECT_NEAR(properties[name]["minimum"].get<double>(), least_deg * static_cast<double>(kPi) / 180, 0.01) << name;
    EXPECT_NEAR(properties[name]["maximum"].get<double>(), most_deg * static_cast<double>(kPi) / 180, 0.01) << name;
    seen.insert(name);
  }
  void Choice(const char* name, std::string*, std::initializer_list<const char*> allowed) {
    ASSERT_TRUE(properties.contains(name)) << name;
    EXPECT_EQ(properties[name]["enum"], std::vector<std::string>(allowed.begin(), allowed.end())) << name;
    seen.insert(name);
  }
};

// optional: what older packs lack.
template <typename Settings>
void ExpectInSchema(const nlohmann::json& definition, const std::set<std::string>& optional = {}) {
  Settings settings;
  SchemaCheck check{definition["properties"], {}};
  VisitFields(check, &settings);
  EXPECT_EQ(check.seen.size(), definition["properties"].size());
  std::set<std::string> required = definition["required"];
  required.insert(optional.begin(), optional.end());
  EXPECT_EQ(required, check.seen);
}

TEST(TourSettings, AKeyWithoutEndIsNotRepeatedWhole) {
  EXPECT_LT(Refusal(std::string(kMinimalTour) + std::string(100'000, 'k') + " = 1\n").size(), 5'000u);
}

TEST(TourSettings, ThePacksSchemaKnowsThem) {
  std::string text;
  ASSERT_FALSE(
      ReadTextFile(std::filesystem::path(FLANEUR_SOURCE_DIR) / "runtime/pack/FLANEUR_tour.schema.json", &text));
  const nlohmann::json definitions = nlohmann::json::parse(text)["$defs"];
  ExpectInSchema<CrowdSettings>(definitions["crowd"]);
  ExpectInSchema<ControlSettings>(definitions["control"], {"discretion"});
  ExpectInSchema<LightSettings>(definitions["light"], {"exposure"});
  ExpectInSchema<WindSettings>(definitions["wind"]);
}

}  // namespace
}  // namespace flaneur
