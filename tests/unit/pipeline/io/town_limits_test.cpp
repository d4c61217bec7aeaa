// Small files of towns that would make large ones: each comes to an end in one line.
#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "pipeline/core/temporary_folder.h"
#include "pipeline/io/scene_reader.h"
#include "pipeline/io/scene_tiles.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace {

using Json = nlohmann::json;

class TownLimits : public testing::Test {
 protected:
  void SetUp() override { ASSERT_FALSE(folder_.Create("flaneur_test_")); }

  std::string Read(const std::string& name, const std::string& text) {
    EXPECT_FALSE(WriteTextFile(folder_.path() / name, text));
    const auto start = std::chrono::steady_clock::now();
    std::vector<std::string> warnings;
    const std::string message = ReadScene(folder_.path() / name, &scene_, &warnings).message;
    took_ = std::chrono::steady_clock::now() - start;
    EXPECT_EQ(message.find('\n'), std::string::npos);
    return message;
  }

  static std::string Triangle(const std::string& id) {
    return "<gml:Polygon gml:id=\"" + id +
           "\"><gml:exterior><gml:LinearRing><gml:posList>0 0 0 9 0 0 9 9 3 0 0 0"
           "</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>";
  }

  // A building of so many triangles, and `rest`.
  static std::string CityGml(int triangles, const std::string& rest) {
    std::string text =
        R"(<CityModel xmlns="http://www.opengis.net/citygml/2.0" xmlns:gml="http://www.opengis.net/gml")"
        R"( xmlns:bldg="http://www.opengis.net/citygml/building/2.0" xmlns:app="http://www.opengis.net/citygml/appearance/2.0")"
        R"( xmlns:xlink="http://www.w3.org/1999/xlink">)"
        R"(<cityObjectMember><bldg:Building gml:id="a"><bldg:lod2MultiSurface><gml:MultiSurface gml:id="all">)";
    for (int k = 0; k < triangles; ++k)
      text += "<gml:surfaceMember>" + Triangle("p" + std::to_string(k)) + "</gml:surfaceMember>";
    return text + "</gml:MultiSurface></bldg:lod2MultiSurface></bldg:Building></cityObjectMember>" + rest +
           "</CityModel>";
  }

  TemporaryFolder folder_;
  Scene scene_;
  std::chrono::duration<double> took_{};
};

TEST_F(TownLimits, WallsOfANeighbourMayNotBeTakenOverForever) {
  std::string rest = R"(<cityObjectMember><bldg:Building gml:id="b"><bldg:lod2MultiSurface><gml:MultiSurface>)";
  for (int k = 0; k < 5000; ++k) rest += R"(<gml:surfaceMember xlink:href="#all"/>)";
  rest += "</gml:MultiSurface></bldg:lod2MultiSurface></bldg:Building></cityObjectMember>";
  EXPECT_EQ(Read("few.gml", CityGml(3, rest)), "");
  EXPECT_NE(Read("many.gml", CityGml(5000, rest)).find("larger than the file is worth"), std::string::npos);
}

TEST_F(TownLimits, ManyLooksOfOneTownAreFoundAtOnce) {
  std::string rest;
  for (int k = 0; k < 20000; ++k)
    rest +=
        "<app:appearanceMember><app:X3DMaterial><app:diffuseColor>1 0 0</app:diffuseColor><app:target>#all</app:target>"
        "</app:X3DMaterial></app:appearanceMember>";
  EXPECT_EQ(Read("looks.gml", CityGml(20000, rest)), "");
  EXPECT_LT(took_.count(), 10) << "seconds";
}

Json CityJson() {
  return {{"type", "CityJSON"},
          {"version", "2.0"},
          {"transform", {{"scale", {1, 1, 1}}, {"translate", {0, 0, 0}}}},
          {"vertices", {{0, 0, 0}, {9, 0, 0}, {9, 9, 3}}},
          {"CityObjects", Json::object()}};
}

TEST_F(TownLimits, ATemplateMayNotBePlacedForever) {
  for (const bool many : {false, true}) {
    Json json = CityJson();
    Json faces = Json::array();
    for (int k = 0; k < (many ? 20000 : 2); ++k) faces.push_back({{0, 1, 2}});
    json["geometry-templates"] = {{"templates", {{{"type", "MultiSurface"}, {"lod", "2"}, {"boundaries", faces}}}},
                                  {"vertices-templates", {{0, 0, 0}, {1, 0, 0}, {0, 1, 2}}}};
    for (int k = 0; k < 3000; ++k)
      json["CityObjects"]["t" + std::to_string(k)] = {
          {"type", "SolitaryVegetationObject"},
          {"geometry",
           {{{"type", "GeometryInstance"},
             {"template", 0},
             {"boundaries", {0}},
             {"transformationMatrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}}}};
    const std::string message = Read("trees.city.json", json.dump());
    if (many) EXPECT_NE(message.find("larger than the file is worth"), std::string::npos) << message;
    else EXPECT_EQ(message, "");
  }
}

TEST_F(TownLimits, ATemplateWithManyMeaningsIsPlacedQuickly) {
  Json json = CityJson();
  Json meanings = Json::array();
  for (int k = 0; k < 100000; ++k) meanings.push_back(Json::object());
  json["geometry-templates"] = {{"templates",
                                 {{{"type", "MultiSurface"},
                                   {"lod", "2"},
                                   {"boundaries", {{{0, 1, 2}}}},
                                   {"semantics", {{"surfaces", meanings}, {"values", {0}}}}}}},
                                {"vertices-templates", {{0, 0, 0}, {1, 0, 0}, {0, 1, 2}}}};
  for (int k = 0; k < 3000; ++k)
    json["CityObjects"]["t" + std::to_string(k)] = {
        {"type", "SolitaryVegetationObject"},
        {"geometry",
         {{{"type", "GeometryInstance"},
           {"template", 0},
           {"boundaries", {0}},
           {"transformationMatrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}}}};
  EXPECT_EQ(Read("trees.city.json", json.dump()), "");
  EXPECT_LT(took_.count(), 5) << "seconds";
}

TEST_F(TownLimits, AChildThatIsNamedOftenIsLookedAtOnce) {
  Json json = CityJson();
  Json geometries = Json::array(), children = Json::array();
  for (int k = 0; k < 20000; ++k) geometries.push_back({{"lod", "2"}, {"type", "MultiPoint"}, {"boundaries", {0}}});
  for (int k = 0; k < 20000; ++k) children.push_back("b");
  const Json face = {{{"type", "MultiSurface"}, {"lod", "2"}, {"boundaries", {{{0, 1, 2}}}}}};
  json["CityObjects"] = {{"a", {{"type", "Building"}, {"geometry", face}, {"children", children}}},
                         {"b", {{"type", "BuildingPart"}, {"geometry", geometries}, {"parents", {"a"}}}}};
  EXPECT_EQ(Read("parts.city.json", json.dump()), "");
  EXPECT_LT(took_.count(), 5) << "seconds";
}

TEST_F(TownLimits, AFaceThatIsAScribbleIsLeftOut) {
  std::string text;
  uint32_t state = 1;
  const auto next = [&state] { return std::to_string((state = state * 1664525u + 1013904223u) >> 20); };
  for (int k = 0; k < 5000; ++k) text += "v " + next() + " " + next() + " 0\n";
  for (int k = 1; k <= 5000; ++k) text += (k == 1 ? "f " : " ") + std::to_string(k);
  EXPECT_NE(Read("scribble.obj", text + "\n").find("no face with an area"), std::string::npos);
  EXPECT_LT(took_.count(), 10) << "seconds";
}

TEST_F(TownLimits, ThingsOfOneNameInTilesAreToldApartQuickly) {
  std::vector<std::filesystem::path> files;
  for (int tile = 0; tile < 2; ++tile) {
    Json json = {{"asset", {{"version", "2.0"}}}};
    const std::string bytes(36, tile == 0 ? 'A' : 'B');
    json["buffers"] = {{{"byteLength", 36}, {"uri", "tile" + std::to_string(tile) + ".bin"}}};
    json["bufferViews"] = {{{"buffer", 0}, {"byteLength", 36}}};
    json["accessors"] = {{{"bufferView", 0}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 3}}};
    json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}};
    for (int k = 0; k < 20000; ++k)
      json["nodes"].push_back(k == 0 ? Json{{"name", "n"}, {"mesh", 0}} : Json{{"name", "n"}});
    const auto name = "tile" + std::to_string(tile);
    EXPECT_FALSE(WriteTextFile(folder_.path() / (name + ".bin"), bytes));
    files.push_back(folder_.path() / (name + ".gltf"));
    EXPECT_FALSE(WriteTextFile(files.back(), json.dump()));
  }
  SceneSource source;
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(ReadTiles(files, {}, &scene_, &source, nullptr).message, "");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

}  // namespace
}  // namespace flaneur
