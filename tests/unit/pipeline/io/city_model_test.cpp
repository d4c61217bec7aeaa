#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <set>

#include "pipeline/io/geojson.h"
#include "pipeline/io/map_projection.h"
#include "pipeline/io/scene_reader.h"
#include "pipeline/io/town_builder.h"
#include "runtime/base/array.h"
#include "runtime/base/png.h"

namespace flaneur {
namespace {

class CityModel : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string Read(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    scene_ = {};
    warnings_.clear();
    return ReadScene(folder_ / name, &scene_, &warnings_).message;
  }

  int Triangles(bool foundation) const {
    size_t indices = 0;
    for (const SceneNode& node : scene_.nodes)
      if (node.is_foundation == foundation)
        for (const int mesh : node.meshes) indices += scene_.meshes[static_cast<size_t>(mesh)].indices.size();
    return static_cast<int>(indices / 3);
  }

  // Metres east, north and up of the source.
  Point3 Highest() const {
    Point3 highest{0, 0, -1e9};
    for (const Mesh& mesh : scene_.meshes)
      for (const Vec3 g : mesh.positions)
        if (const Vec3 p = GroundFromGltf(g); p.z > highest.z)
          highest = {p.x + scene_.origin_m.x, p.y + scene_.origin_m.y, p.z};
    return highest;
  }

  std::filesystem::path folder_;
  Scene scene_;
  std::vector<std::string> warnings_;
};

// ---- CityGML ----

std::string Polygon(const std::string& coordinates, const std::string& id = "") {
  return "<gml:Polygon" + (id.empty() ? "" : " gml:id=\"" + id + "\"") +
         "><gml:exterior><gml:LinearRing><gml:posList>" + coordinates +
         "</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>";
}
std::string Surface(const std::string& type, const std::string& polygon, const std::string& lod = "2") {
  return "<bldg:boundedBy><bldg:" + type + "><bldg:lod" + lod + "MultiSurface><gml:MultiSurface><gml:surfaceMember>" +
         polygon + "</gml:surfaceMember></gml:MultiSurface></bldg:lod" + lod + "MultiSurface></bldg:" + type +
         "></bldg:boundedBy>";
}
std::string Gml(const std::string& members, const std::string& version = "2.0", const std::string& before = "") {
  return "<?xml version=\"1.0\"?>" + before + "<core:CityModel xmlns:core=\"http://www.opengis.net/citygml/" + version +
         "\" xmlns:bldg=\"http://www.opengis.net/citygml/building/" + version +
         "\" xmlns:gml=\"http://www.opengis.net/gml\" xmlns:xlink=\"http://www.w3.org/1999/xlink\">"
         "<gml:boundedBy><gml:Envelope srsName=\"urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::5783\"/></gml:boundedBy>" +
         members + "</core:CityModel>";
}
std::string Member(const std::string& inner, const std::string& id = "house") {
  return "<core:cityObjectMember><bldg:Building gml:id=\"" + id + "\">" + inner +
         "</bldg:Building></core:cityObjectMember>";
}
// Without namespaces, as some programs write it: plainly, or with prefixes that nothing explains.
TEST_F(CityModel, CityGmlWithoutItsNamespace) {
  const std::string wall = "603000 5780000 50 603010 5780000 50 603010 5780000 58 603000 5780000 58 603000 5780000 50";
  const std::string whole = Gml(Member(Surface("WallSurface", Polygon(wall))));
  std::string bare = whole, unbound = whole;
  for (const char* prefix : {"core:", "bldg:", "gml:"})
    for (size_t at; (at = bare.find(prefix)) != std::string::npos;) bare.erase(at, std::string(prefix).size());
  for (std::string* text : {&bare, &unbound})
    for (size_t at; (at = text->find(" xmlns:")) != std::string::npos;)
      text->erase(at, text->find('"', text->find('"', at) + 1) + 1 - at);
  for (const std::string& text : {bare, unbound}) {
    ASSERT_EQ(Read("town.gml", text), "");
    EXPECT_EQ(Triangles(false), 2);
    EXPECT_EQ(scene_.nodes.at(0).name, "house");
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_NE(warnings_[0].find("names no namespace"), std::string::npos);
  }
}

const char* const kWall = "603000 5780000 50 603010 5780000 50 603010 5780000 58 603000 5780000 58 603000 5780000 50";
const char* const kGround = "603000 5780000 50 603000 5780008 50 603010 5780008 50 603010 5780000 50 603000 5780000 50";

TEST_F(CityModel, CityGmlKeepsNamesAndMovesNearZero) {
  for (const char* version : {"1.0", "2.0"}) {
    ASSERT_EQ(
        Read("town.gml",
             Gml(Member(Surface("WallSurface", Polygon(kWall)) + Surface("GroundSurface", Polygon(kGround))), version)),
        "");
    ASSERT_EQ(scene_.nodes.size(), 2u);
    EXPECT_EQ(scene_.nodes[0].name, "house");
    EXPECT_EQ(scene_.nodes[0].kind, NodeKind::kBuilding);
    EXPECT_EQ(scene_.reference_system, "EPSG:25832");
    EXPECT_EQ(std::fmod(scene_.origin_m.x, 100), 0);
    EXPECT_NEAR(Highest().y, 5780000, 1e-3);
    EXPECT_NEAR(Highest().z, 58, 1e-3);
    EXPECT_EQ(Triangles(false), 2);
    EXPECT_EQ(Triangles(true), 2) << "the ground surface is the foundation";
  }
}

TEST_F(CityModel, CityGmlTakesTheFinestLevelAndNoRooms) {
  const std::string solid = "<bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface><gml:surfaceMember>" +
                            Polygon(kGround) +
                            "</gml:surfaceMember></gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid>";
  const std::string room = "<bldg:interiorRoom><bldg:Room>" + Surface("InteriorWallSurface", Polygon(kWall), "4") +
                           "</bldg:Room></bldg:interiorRoom>";
  ASSERT_EQ(Read("town.gml", Gml(Member(solid + Surface("WallSurface", Polygon(kWall)) +
                                        Surface("WallSurface", Polygon(kWall), "3") + room))),
            "");
  EXPECT_EQ(Triangles(false), 2);
}

TEST_F(CityModel, CityGmlTellsBridgesByTheirFunction) {
  const std::string wall = Surface("WallSurface", Polygon(kWall));
  for (const auto& [function, is_bridge] :
       {std::pair("53001_1800", true), {"53001_1830", true}, {"31001_1010", false}}) {
    ASSERT_EQ(Read("town.gml", Gml(Member("<bldg:function>" + std::string(function) + "</bldg:function>" + wall))), "");
    EXPECT_EQ(scene_.nodes[0].is_bridge, is_bridge) << function;
  }
}

std::string TexturedWall(const std::string& image) {
  const std::string polygon =
      "<gml:Polygon gml:id=\"wall\"><gml:exterior><gml:LinearRing gml:id=\"ring\"><gml:posList>" + std::string(kWall) +
      "</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>";
  return Gml(
      "<app:appearanceMember xmlns:app=\"http://www.opengis.net/citygml/appearance/2.0\"><app:Appearance>"
      "<app:surfaceDataMember><app:ParameterizedTexture><app:imageURI>" +
      image +
      "</app:imageURI><app:target uri=\"#wall\"><app:TexCoordList><app:textureCoordinates ring=\"#ring\">"
      "0 0 1 0 1 1 0 1 0 0</app:textureCoordinates></app:TexCoordList></app:target></app:ParameterizedTexture>"
      "</app:surfaceDataMember></app:Appearance></app:appearanceMember>" +
      Member(Surface("WallSurface", polygon)));
}

TEST_F(CityModel, CityGmlWearsItsTextures) {
  ASSERT_EQ(Read("wall.png", "\x89PNG").empty(), false);
  ASSERT_EQ(Read("town.gml", TexturedWall("wall.png")), "");
  ASSERT_EQ(scene_.images.size(), 1u);
  EXPECT_EQ(scene_.images[0].mime_type, "image/png");
  const Mesh& mesh = scene_.meshes[0];
  EXPECT_EQ(scene_.materials[static_cast<size_t>(mesh.material)].base_color_image, 0);
  ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
  for (size_t i = 0; i < mesh.uvs.size(); ++i) {
    const Vec3 p = GroundFromGltf(mesh.positions[i]);
    EXPECT_NEAR(mesh.uvs[i].x, p.x > 5 ? 1 : 0, 1e-6);
    EXPECT_NEAR(mesh.uvs[i].y, p.z > 54 ? 0 : 1, 1e-6) << "glTF's pictures begin at the top";
  }
}

TEST_F(CityModel, CityGmlWithoutItsPicturesIsPlain) {
  for (const char* image : {"missing.png", "../outside.png", "/etc/passwd"}) {
    ASSERT_EQ(Read("town.gml", TexturedWall(image)), "");
    EXPECT_TRUE(scene_.images.empty());
    EXPECT_TRUE(scene_.meshes[0].uvs.empty());
  }
}

TEST_F(CityModel, CityGmlLeavesClosureSurfacesOpen) {
  ASSERT_EQ(
      Read("town.gml", Gml(Member(Surface("WallSurface", Polygon(kWall)) + Surface("ClosureSurface", Polygon(kWall))))),
      "");
  EXPECT_EQ(Triangles(false), 2);
}

TEST_F(CityModel, CityGmlReferencesAreTakenOnce) {
  const std::string solid =
      "<bldg:lod2Solid><gml:Solid><gml:exterior><gml:CompositeSurface><gml:surfaceMember xlink:href=\"#w\"/>"
      "</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod2Solid>";
  ASSERT_EQ(
      Read("town.gml", Gml(Member(solid + Surface("WallSurface", Polygon(kWall, "w"))) + Member(solid, "neighbour"))),
      "");
  EXPECT_EQ(Triangles(false), 4) << "two of the house's own, two that the neighbour shares";
}

TEST_F(CityModel, XmlBombsAndOtherXmlAreRefused) {
  const std::string bomb = "<!DOCTYPE b [<!ENTITY a \"xxxxxxxxxx\"><!ENTITY c \"&a;&a;&a;&a;&a;&a;&a;&a;\">]>";
  EXPECT_NE(Read("bomb.gml", Gml(Member(""), "2.0", bomb)).find("DOCTYPE"), std::string::npos);
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  EXPECT_NE(Read("deep.gml", Gml(deep)).find("deep"), std::string::npos);
  EXPECT_NE(Read("page.xml", "<html></html>").find("CityModel"), std::string::npos);
  EXPECT_NE(Read("four.gml", Gml("", "4.0")).find("4.0"), std::string::npos);
  const std::string whole = Gml(Member(Surface("WallSurface", Polygon(kWall))));
  EXPECT_NE(Read("cut.gml", whole.substr(0, whole.size() - 40)).find("well-formed"), std::string::npos);
}

TEST_F(CityModel, BadCityGmlIsNamed) {
  EXPECT_NE(Read("empty.gml", Gml("")).find("no face"), std::string::npos);
  EXPECT_NE(Read("nan.gml", Gml(Member(Surface("WallSurface", Polygon("0 0 nan 1 0 0 1 1 0"))))).find("'house'"),
            std::string::npos);
  EXPECT_NE(Read("odd.gml", Gml(Member(Surface("WallSurface", Polygon("0 0 0 1 0"))))).find("three coordinates"),
            std::string::npos);
  ASSERT_EQ(Read("two.gml",
                 Gml(Member(Surface("WallSurface", Polygon("0 0 0 1 0 0")) + Surface("WallSurface", Polygon(kWall))))),
            "");
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("fewer than three corners"), std::string::npos);
}

// Its spaces hold what stands there and what only people or light go through.
TEST_F(CityModel, CityGml3HasBoundariesAndSpaces) {
  const auto in = [](const std::string& name, const std::string& inner) {
    return "<" + name + ">" + inner + "</" + name.substr(0, name.find(' ')) + ">";
  };
  const auto lod2 = [&](const std::string& ring) {
    return in("core:lod2MultiSurface", in("gml:MultiSurface", in("gml:surfaceMember", Polygon(ring))));
  };
  const auto installation = [&](const std::string& relation) {
    return in("bldg:buildingInstallation",
              in("bldg:BuildingInstallation", lod2(kWall) + in("con:relationToConstruction", relation)));
  };
  const std::string surfaces = in("core:boundary", in("con:WallSurface", lod2(kWall))) +
                               in("core:boundary", in("con:GroundSurface gml:id=\"floor\"", lod2(kGround))) +
                               in("bldg:buildingRoom", in("bldg:BuildingRoom", lod2(kWall)));
  const std::string road =
      in("core:cityObjectMember",
         in("tran:Road",
            in("tran:trafficSpace",
               in("tran:TrafficSpace", lod2(kWall) + in("core:boundary", in("tran:TrafficArea", lod2(kGround)))))));
  std::string text = Gml(Member(surfaces + installation("outside") + installation(" inside\n")) + road, "3.0");
  text.insert(text.find(" xmlns:gml"),
              " xmlns:con=\"http://www.opengis.net/citygml/construction/3.0\" "
              "xmlns:tran=\"http://www.opengis.net/citygml/transportation/3.0\"");
  ASSERT_EQ(Read("town.gml", text), "");
  EXPECT_EQ(Triangles(false), 2 + 2 + 2) << "a wall, what is outside, the road";
  EXPECT_EQ(Triangles(true), 2);
  EXPECT_TRUE(warnings_.empty());
}

// As of houses that no laser has seen; of a square the outline says all.
TEST_F(CityModel, OutlinesAreSquaresButNoHouses) {
  const std::string lod0 = "<bldg:lod0FootPrint><gml:MultiSurface><gml:surfaceMember>" + Polygon(kGround) +
                           "</gml:surfaceMember></gml:MultiSurface></bldg:lod0FootPrint>";
  const std::string square =
      "<core:cityObjectMember><l:LandUse xmlns:l=\"http://www.opengis.net/citygml/landuse/2.0\"><l:lod0MultiSurface>"
      "<gml:MultiSurface><gml:surfaceMember>" +
      Polygon(kGround) +
      "</gml:surfaceMember></gml:MultiSurface></l:lod0MultiSurface></l:LandUse></core:cityObjectMember>";
  ASSERT_EQ(Read("town.gml", Gml(Member(lod0, "unseen") + Member(Surface("WallSurface", Polygon(kWall))) + square)),
            "");
  EXPECT_EQ(Triangles(false), 2 + 2);
  EXPECT_TRUE(std::any_of(scene_.nodes.begin(), scene_.nodes.end(),
                          [](const SceneNode& n) { return n.kind == NodeKind::kGround && !n.meshes.empty(); }));
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("'unseen'"), std::string::npos) << warnings_[0];
  EXPECT_NE(Read("town.gml", Gml(Member(lod0, "unseen"))).find("levels of detail"), std::string::npos);

  const auto city = [](const std::string& type, const std::string& lod) {
    return "{\"type\":\"" + type + R"(","geometry":[{"type":"MultiSurface","lod":")" + lod +
           R"(","boundaries":[[[0,1,2]]]}]})";
  };
  const std::string json = R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},)"
                           R"("vertices":[[0,0,0],[9,0,0],[9,8,0]],"CityObjects":{"unseen":)" +
                           city("Building", "0") + ",\"square\":" + city("LandUse", "0") +
                           ",\"street\":" + city("Road", "0.3") + "}}";
  ASSERT_EQ(Read("town.city.json", json), "");
  EXPECT_EQ(Triangles(false), 2);
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("'unseen'"), std::string::npos) << warnings_[0];
}

TEST_F(CityModel, CityGmlInCodePagesKeepsItsNames) {
  std::string text = Gml(Member(Surface("WallSurface", Polygon(kWall)), "Dom_\xe6"));
  text.replace(text.find("\"1.0\""), 5, "\"1.0\" encoding=\"windows-1250\"");
  ASSERT_EQ(Read("town.gml", text), "");
  EXPECT_EQ(scene_.nodes.at(0).name, "Dom_ć");
  text.replace(text.find("windows-1250"), 12, "Shift_JIS");
  EXPECT_NE(Read("town.gml", text).find("unknown encoding"), std::string::npos);
}

// ---- CityJSON ----

std::string Json(const std::string& version, const std::string& boundaries, const std::string& extra = "") {
  return R"({"type":"CityJSON","version":")" + version +
         R"(","transform":{"scale":[0.001,0.001,0.001],"translate":[603000,5780000,50]},)"
         R"("metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/7415"},)"
         R"("vertices":[[0,0,0],[10000,0,0],[10000,0,8000],[0,0,8000],[0,8000,0],[10000,8000,0]],)" +
         extra +
         R"("CityObjects":{"house":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"2.2","boundaries":)" +
         boundaries +
         R"(,"semantics":{"surfaces":[{"type":"WallSurface"},{"type":"GroundSurface"}],"values":[0,1]}}]}}})";
}

TEST_F(CityModel, CityJsonOfAllVersions) {
  for (const char* version : {"1.0", "1.1", "2.0"}) {
    ASSERT_EQ(Read("town.city.json", Json(version, "[[[0,1,2,3]],[[0,4,5,1]]]")), "");
    EXPECT_EQ(scene_.nodes[0].name, "house");
    EXPECT_EQ(scene_.reference_system, "EPSG:7415");
    EXPECT_EQ(Triangles(false), 2);
    EXPECT_EQ(Triangles(true), 2);
    EXPECT_NEAR(Highest().z, 58, 1e-3);
    EXPECT_NEAR(Highest().y, 5780000, 1e-3);
  }
}

TEST_F(CityModel, CityJsonPartsBelongToTheirBuilding) {
  const std::string text =
      R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},)"
      R"("vertices":[[0,0,0],[9,0,0],[9,0,8],[0,0,8]],"CityObjects":{)"
      R"("house":{"type":"Building","children":["part"],"geometry":[{"type":"MultiSurface","lod":"1.2","boundaries":[[[0,1,2,3]]]}]},)"
      R"("part":{"type":"BuildingPart","parents":["house"],"geometry":[{"type":"Solid","lod":"2.2","boundaries":[[[[0,1,2,3]]]]}]},)"
      R"("oak":{"type":"SolitaryVegetationObject","geometry":[{"type":"GeometryInstance","template":0,"boundaries":[1],)"
      R"("transformationMatrix":[1,0,0,5,0,1,0,0,0,0,1,0,0,0,0,1]}]}},)"
      R"("geometry-templates":{"templates":[{"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2]]]}],)"
      R"("vertices-templates":[[0,0,0],[1,0,0],[0,0,20]]}})";
  ASSERT_EQ(Read("town.json", text), "");
  EXPECT_EQ(Triangles(false), 3) << "the part's two and the tree's one";
  EXPECT_NEAR(Highest().x, 14, 1e-6);
  for (const SceneNode& node : scene_.nodes)
    EXPECT_EQ(node.kind, node.name == "oak" ? NodeKind::kTree : NodeKind::kBuilding);
}

// As towns of simple blocks are, which say nothing of walls and roofs.
TEST_F(CityModel, SurfacesThatSayNothingAreColouredByWhatTheyAre) {
  const auto object = [](const char* type, const char* surface) {
    return std::string("\"") + type + R"(":{"type":")" + type +
           R"(","geometry":[{"type":"MultiSurface","lod":"2","boundaries":[)" + surface + "]}]}";
  };
  const std::string text =
      R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},)"
      R"("vertices":[[0,0,0],[9,0,0],[9,0,8],[0,0,8],[9,5,12],[0,5,12],[9,5,8],[0,5,8]],"CityObjects":{)" +
      object("Building", "[[0,1,2,3]],[[3,2,4,5]],[[3,2,6,7]]") + "," + object("LandUse", "[[3,2,6,7]]") + "," +
      object("Road", "[[3,2,6,7]]") + "," + object("PlantCover", "[[3,2,6,7]]") + "," +
      object("WaterBody", "[[3,2,6,7]]") + "}}";
  ASSERT_EQ(Read("town.json", text), "");
  std::map<std::string, std::set<std::string>> looks;
  for (const SceneNode& node : scene_.nodes)
    for (const int mesh : node.meshes)
      looks[node.name].insert(At(scene_.materials, At(scene_.meshes, mesh).material).name);
  const std::map<std::string, std::set<std::string>> expected{{"Building", {"wall", "roof", "other"}},
                                                              {"LandUse", {"grass"}},
                                                              {"Road", {"paving"}},
                                                              {"PlantCover", {"plants"}},
                                                              {"WaterBody", {"water"}}};
  EXPECT_EQ(looks, expected);
}

TEST_F(CityModel, CityJsonSequence) {
  const std::string head =
      R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},"CityObjects":{},"vertices":[]})";
  const auto feature = [](const std::string& id) {
    return R"({"type":"CityJSONFeature","id":")" + id + R"(","vertices":[[0,0,0],[9,0,0],[9,0,8]],"CityObjects":{")" +
           id + R"(":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2]]]}]}}})";
  };
  ASSERT_EQ(Read("town.city.jsonl", head + "\n" + feature("a") + "\n" + feature("b") + "\n"), "");
  ASSERT_EQ(scene_.nodes.size(), 2u);
  EXPECT_EQ(scene_.nodes[1].name, "b");
  EXPECT_NE(Read("town.city.jsonl", head + "\n{}\n").find("line 2"), std::string::npos);
  EXPECT_NE(Read("town.city.jsonl", head + "\n" + feature("a") + "\n{\"type\":").find("line 3"), std::string::npos);
}

TEST_F(CityModel, BadCityJsonIsNamed) {
  EXPECT_NE(Read("bad.json", Json("2.0", "[[[0,1,99]]]")).find("vertex 99"), std::string::npos);
  EXPECT_NE(Read("bad.json", Json("2.0", "[[[0,1,-1]]]")).find("'house'"), std::string::npos);
  EXPECT_NE(Read("bad.json", Json("2.0", "[[[0,1,1.5]]]")).find("vertex 1.5"), std::string::npos);
  EXPECT_NE(Read("bad.json", Json("3.0", "[[[0,1,2]]]")).find("3.0"), std::string::npos);
  EXPECT_NE(Read("bad.json", Json("2.0", "7")).find("'house'"), std::string::npos);
  EXPECT_NE(Read("bad.json", R"({"type":"CityJSON","version":"2.0","CityObjects":{},"vertices":[]})").find("no face"),
            std::string::npos);
  EXPECT_NE(Read("bad.json", R"({"type":"CityJSON","version":"2.0",)").find("JSON"), std::string::npos);
}

// ---- Degrees from other meridians, and grads ----

// Corners of six houses askew at this place, four each, in this system.
std::vector<Point2> HousesIn(const std::string& system, Point2 place) {
  std::vector<Point2> corners;
  for (int i = 0; i < 6; ++i)
    for (const Point2 p : {Point2{0, 0}, {12, 0}, {12, 8}, {0, 8}})
      corners.push_back({0.8 * (p.x + 20 * i) - 0.6 * p.y, 0.6 * (p.x + 20 * i) + 0.8 * p.y});
  EXPECT_EQ(TransformPoints(LocalMapSystem(place), system, &corners).message, "");
  return corners;
}

std::string InDegrees(Point2 p) {
  char text[80];
  std::snprintf(text, sizeof text, "[%.10f,%.10f", p.x, p.y);
  return text;
}

struct MeridianCase {
  const char* system;
  Point2 place;
};
void PrintTo(const MeridianCase& test, std::ostream* out) { *out << test.system; }

class OtherMeridian : public CityModel, public testing::WithParamInterface<MeridianCase> {
 protected:
  void SetUp() override {
    CityModel::SetUp();
    file_ = folder_ / "town.json";
  }
  std::filesystem::path file_;
};

TEST_P(OtherMeridian, TownsOfEitherOrderOfAxes) {
  const auto& [system, place] = GetParam();
  const std::string local = LocalMapSystem(place);
  std::vector<Point2> truth = HousesIn(local, place), corners = HousesIn(system, place);
  for (const bool swapped : {false, true}) {
    std::string vertices, objects;
    for (size_t i = 0; i < corners.size(); ++i) {
      const Point2 p = swapped ? Point2{corners[i].y, corners[i].x} : corners[i];
      for (const char* z : {",0],", ",5],"}) vertices += InDegrees(p) + z;
    }
    for (int i = 0; i < 6; ++i) {
      std::string walls;
      for (int k = 0; k < 4; ++k) {
        const int a = 8 * i + 2 * k, b = 8 * i + 2 * ((k + 1) % 4);
        for (const int v : {a, b, b + 1, a + 1}) walls += (v == a ? "[[" : ",") + std::to_string(v);
        walls += "]],";
      }
      walls.pop_back();
      objects += "\"house_" + std::to_string(i) +
                 R"(":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"2","boundaries":[)" + walls +
                 "]}]},";
    }
    vertices.pop_back(), objects.pop_back();
    ASSERT_EQ(Read(file_.filename(), R"({"type":"CityJSON","version":"2.0","metadata":{"referenceSystem":")" +
                                         std::string(system) + R"("},"vertices":[)" + vertices +
                                         R"(],"CityObjects":{)" + objects + "}}"),
              "");
    std::vector<Point2> found;
    for (const Mesh& mesh : scene_.meshes)
      for (const Vec3 g : mesh.positions) {
        const Vec3 p = GroundFromGltf(g);
        found.push_back({p.x + scene_.origin_m.x, p.y + scene_.origin_m.y});
      }
    ASSERT_EQ(TransformPoints(scene_.reference_system, local, &found).message, "");
    for (const Point2 p : truth) {
      double nearest_m = 1e9;
      for (const Point2 q : found) nearest_m = std::min(nearest_m, std::hypot(p.x - q.x, p.y - q.y));
      EXPECT_LT(nearest_m, 0.01) << (swapped ? "latitude first" : "longitude first");
    }
  }
}

TEST_P(OtherMeridian, ObstaclesOfEitherOrderOfAxes) {
  const auto& [system, place] = GetParam();
  const std::vector<Point2> corners = HousesIn(system, place);
  for (const bool swapped : {false, true}) {
    std::string features;
    for (size_t i = 0; i < corners.size(); i += 4) {
      features += R"({"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[[)";
      for (size_t k = 0; k <= 4; ++k) {
        const Point2 p = corners[i + k % 4];
        features += InDegrees(swapped ? Point2{p.y, p.x} : p) + (k < 4 ? "]," : "]]]}},");
      }
    }
    features.pop_back();
    std::ofstream(file_) << R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":")" << system
                         << R"("}},"features":[)" << features << "]}";
    GeoJsonFile file;
    ASSERT_EQ(ReadGeoJson(file_, {}, &file).message, "");
    EXPECT_EQ(file.faults.size(), swapped ? 1u : 0u) << (file.faults.empty() ? "" : file.faults[0].message);
    std::vector<Point2> found = file.footprints.obstacles[0].outer;
    ASSERT_EQ(TransformPoints(file.local_system, LocalMapSystem(place), &found).message, "");
    EXPECT_NEAR(std::hypot(found[0].x, found[0].y), 0, 0.01) << (swapped ? "latitude first" : "longitude first");
  }
}
INSTANTIATE_TEST_SUITE_P(Geographic, OtherMeridian,
                         testing::Values(MeridianCase{"EPSG:4815", {23.7, 38}}, MeridianCase{"EPSG:4818", {14.4, 50}},
                                         MeridianCase{"EPSG:5229", {14.4, 50}}, MeridianCase{"EPSG:4801", {8.5, 47.4}},
                                         MeridianCase{"EPSG:4817", {10.8, 59.9}},
                                         MeridianCase{"EPSG:4807", {2.4, 48.9}},
                                         MeridianCase{"EPSG:4819", {7.7, 36.9}}));

// Poland's and Romania's systems lie within their areas both ways round; which it is, closed houses tell.
TEST_F(CityModel, NorthingsFirstAreToldByHousesThatAreNotInsideOut) {
  const double corners[][3] = {{0, 0, 0}, {12, 0, 0}, {12, 7, 0}, {0, 7, 0},
                               {0, 0, 5}, {12, 0, 5}, {12, 7, 5}, {0, 7, 5}};
  const int faces[][4] = {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}};  // open below
  for (const char* system : {"EPSG:2180", "http://www.opengis.net/def/crs/EPSG/0/3844"}) {
    for (const bool north_first : {false, true}) {
      std::string surfaces;
      for (const auto& face : faces) {
        std::string ring;
        for (const int k : {0, 1, 2, 3, 0}) {
          const auto& [x, y, z] = corners[face[k]];
          const double east = 500000 + x, north = 300000 + y;
          for (const double v : {north_first ? north : east, north_first ? east : north, z})
            ring += std::to_string(v) + " ";
        }
        surfaces += Surface("WallSurface", Polygon(ring));
      }
      std::string text = Gml(Member(surfaces));
      const std::string before = "urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::5783";
      text.replace(text.find(before), before.size(), system);
      ASSERT_EQ(Read("town.gml", text), "");
      const Vec3 low = GroundFromGltf(scene_.meshes.at(0).positions.at(0));
      EXPECT_NEAR(low.x + scene_.origin_m.x, 500000, 13) << system << north_first;
      EXPECT_NEAR(low.y + scene_.origin_m.y, 300000, 13);
      ASSERT_EQ(warnings_.size(), north_first ? 0u : 1u) << system;
      if (north_first) continue;
      EXPECT_NE(warnings_[0].find("taken for the easting"), std::string::npos) << warnings_[0];
    }
  }
}

// ---- OBJ ----

TEST_F(CityModel, ObjObjectsAreNodes) {
  const std::string box = "v 0 0 0\nv 40 0 0\nv 40 8 0\nv 0 8 0\nv 0 0 30\n";
  ASSERT_EQ(Read("town.obj", box + "o church\nf 1 2 3 4\no tower\nf -1/1/1 1/2/2 2//3\n"), "");
  ASSERT_EQ(scene_.nodes.size(), 2u);
  EXPECT_EQ(scene_.nodes[0].name, "church");
  EXPECT_EQ(Triangles(false), 3);
  EXPECT_NEAR(Highest().z, 8, 1e-6) << "lower than it is long along z: y is up";
  EXPECT_EQ(warnings_.size(), 1u) << "says so";
}

TEST_F(CityModel, ObjWithMapCoordinatesHasZUp) {
  ASSERT_EQ(Read("town.obj", "v 603000.125 5780000 50\nv 603001 5780000 50\nv 603001 5780000 90\nf 1 2 3\n"), "");
  EXPECT_NEAR(Highest().z, 90, 1e-6);
  EXPECT_NEAR(Highest().x, 603001, 1e-3);
}

// A gabled house of 12 x 9 m, 8 m high, is neither flat nor tall: its walls tell.
TEST_F(CityModel, ObjWallsTellWhichWayIsUp) {
  const double corners[][3] = {{0, 0, 0},  {12, 0, 0}, {12, 9, 0}, {0, 9, 0},   {0, 0, 5},
                               {12, 0, 5}, {12, 9, 5}, {0, 9, 5},  {0, 4.5, 8}, {12, 4.5, 8}};
  const std::string faces = "f 1 2 6 5\nf 3 4 8 7\nf 2 3 7 10 6\nf 4 1 5 9 8\nf 5 6 10 9\nf 7 8 9 10\nf 4 3 2 1\n";
  for (const bool y_up : {false, true}) {
    std::string text;
    for (const auto& [x, y, z] : corners) {
      text +=
          "v " + std::to_string(x) + " " + std::to_string(y_up ? z : y) + " " + std::to_string(y_up ? -y : z) + "\n";
    }
    ASSERT_EQ(Read("house.obj", text + faces), "");
    EXPECT_NEAR(Highest().z, 8, 0.01) << y_up;
  }
}

// Two walls and a floor; the library and the picture are named as programs on other systems name them.
constexpr const char* kLookedAtObj =
    "mtllib Die Stadt.mtl\r\nv 0 0 0\r\nv 4 0 0\r\nv 4 0 3\r\nv 0 0 3\r\nv 0 4 0\r\nv 4 4 0\r\n"
    "vt 0 0\r\nvt 1 0\r\nvt 1 1\r\nvt 0 1\r\n"
    "usemtl brick\r\nf 1/1 2/2 3/3 4/4\r\nusemtl red\r\nf 1 2 6 5\r\nusemtl lost\r\nf 4 3 2 1\r\n";

TEST_F(CityModel, ObjWearsItsMaterials) {
  std::ofstream(folder_ / "Die Stadt.mtl") << "newmtl brick\r\nKd 0 0 0\r\n"
                                              "map_Kd -s 2 1 1 -o 0 0.5 C:\\Anna\\a wall.png\r\n"
                                              "newmtl red\r\nKd 1 0 0\r\nd 0.5\r\n";
  const std::vector<uint8_t> png = EncodePng(1, 1, 3, {10, 20, 30});
  std::ofstream(folder_ / "a wall.png", std::ios::binary)
      .write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  ASSERT_EQ(Read("town.obj", kLookedAtObj), "");
  EXPECT_EQ(warnings_.size(), 1u) << "which way is up";
  ASSERT_EQ(scene_.images.size(), 1u);
  EXPECT_EQ(scene_.images[0].bytes, png);
  std::map<std::string, const Mesh*> by_material;
  for (const Mesh& mesh : scene_.meshes) by_material[At(scene_.materials, mesh.material).name] = &mesh;
  const auto look = [&](const char* name) { return At(scene_.materials, by_material.at(name)->material); };
  EXPECT_EQ(look("brick").base_color_image, 0);
  EXPECT_EQ(look("brick").base_color.x, 1) << "the picture as it is";
  EXPECT_EQ(look("red").base_color.y, 0);
  EXPECT_EQ(look("red").alpha, Material::Alpha::kBlend);
  ASSERT_EQ(by_material.size(), 3u) << "what no library has is plain";
  const Mesh& brick = *by_material.at("brick");
  ASSERT_EQ(brick.uvs.size(), 6u);
  for (size_t i = 0; i < 6; ++i) {
    const Vec3 p = GroundFromGltf(brick.positions[i]);
    EXPECT_NEAR(brick.uvs[i].x, 2 * p.x / 4, 1e-6f);
    EXPECT_NEAR(brick.uvs[i].y, 1 - (p.z / 3 + 0.5f), 1e-6f);
  }
}

TEST_F(CityModel, ObjPlacesInPicturesAreFinite) {
  const std::vector<uint8_t> png = EncodePng(1, 1, 3, {10, 20, 30});
  std::ofstream(folder_ / "wall.png", std::ios::binary)
      .write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  for (const char* map : {"map_Kd -s nan nan wall.png", "map_Kd -s 3e38 3e38 -o 3e38 3e38 wall.png"}) {
    std::ofstream(folder_ / "Die Stadt.mtl") << "newmtl brick\n" << map << "\n";
    ASSERT_EQ(Read("town.obj", kLookedAtObj), "");
    for (const Mesh& mesh : scene_.meshes)
      for (const Vec2 uv : mesh.uvs) ASSERT_TRUE(std::isfinite(uv.x) && std::isfinite(uv.y)) << map;
  }
}

TEST_F(CityModel, ObjSaysWhichLooksAreLost) {
  ASSERT_EQ(Read("town.obj", kLookedAtObj), "");
  ASSERT_EQ(warnings_.size(), 2u);
  EXPECT_NE((warnings_[0] + warnings_[1]).find("'Die Stadt.mtl'; their surfaces are plain"), std::string::npos)
      << warnings_[1];
  std::ofstream(folder_ / "Die Stadt.mtl") << "newmtl brick\nmap_Kd wall.tga\n";
  ASSERT_EQ(Read("town.obj", kLookedAtObj), "");
  ASSERT_EQ(warnings_.size(), 2u);
  EXPECT_NE((warnings_[0] + warnings_[1]).find("'wall.tga'; their surfaces are plain"), std::string::npos);
  std::ofstream(folder_ / "wall.tga") << "no picture that is known";
  ASSERT_EQ(Read("town.obj", kLookedAtObj), "");
  EXPECT_EQ(warnings_.size(), 2u);
  EXPECT_TRUE(scene_.images.empty()) << "what cannot be read is not kept";
}

TEST_F(CityModel, ObjVerticesHaveColours) {
  ASSERT_EQ(Read("town.obj", "v 0 0 0 1 0 0\nv 4 0 0 0 1 0\nv 4 0 9 0 0 1\nf 1 2 3\n"), "");
  ASSERT_EQ(scene_.meshes.size(), 1u);
  ASSERT_EQ(scene_.meshes[0].colors.size(), 3u);
  EXPECT_EQ(scene_.meshes[0].colors[0].x, 1);
  EXPECT_EQ(scene_.meshes[0].colors[1].x, 0);
  EXPECT_EQ(At(scene_.materials, scene_.meshes[0].material).base_color.y, 1) << "on white";
}

TEST_F(CityModel, ObjIsAsRoundAsItsNormalsSay) {
  const std::string corners = "v 0 0 0\nv 40 0 0\nv 40 9 40\n", normals = "vn 0 0 2\nvn 1 0 1\nvn 0 1 0\n";
  ASSERT_EQ(Read("town.obj", corners + normals + "f 1//1 2//2 3//3\nf 1//1 3//3 2\n"), "");
  const Mesh& mesh = scene_.meshes.at(0);
  ASSERT_EQ(mesh.normals.size(), 6u);
  EXPECT_LT(Length(mesh.normals[1] - Normalized(Vec3{1, 0, 1})), 1e-5f);
  EXPECT_LT(Length(mesh.normals[2] - Vec3{0, 1, 0}), 1e-5f);
  EXPECT_LT(Length(mesh.normals[4] - Normalized(Vec3{0, 1600, -360})), 1e-5f)
      << "a face with a corner without one is flat";
}

TEST_F(CityModel, BadObjIsNamedByLine) {
  EXPECT_NE(Read("bad.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n").find("bad.obj:3"), std::string::npos);
  EXPECT_NE(Read("bad.obj", "v 0 0 nan\n").find("bad.obj:1"), std::string::npos);
  EXPECT_NE(Read("bad.obj", "v 0 0\n").find("bad.obj:1"), std::string::npos);
  EXPECT_NE(Read("bad.obj", "").find("no face"), std::string::npos);
}

TEST(PlainReferenceSystem, KnowsTheUsualWays) {
  EXPECT_EQ(PlainReferenceSystem("EPSG:32632"), "EPSG:32632");
  EXPECT_EQ(PlainReferenceSystem("urn:ogc:def:crs:EPSG::7415"), "EPSG:7415");
  EXPECT_EQ(PlainReferenceSystem("urn:ogc:def:crs:EPSG:6.12:3068"), "EPSG:3068");
  EXPECT_EQ(PlainReferenceSystem("urn:adv:crs:ETRS89_UTM32*DE_DHHN2016_NH*GCG2016"), "EPSG:25832");
  EXPECT_EQ(PlainReferenceSystem("urn:adv:crs:DE_DHDN_3GK4*DE_DHHN92_NH"), "EPSG:31468");
  EXPECT_EQ(PlainReferenceSystem("https://www.opengis.net/def/crs/EPSG/0/28992"), "EPSG:28992");
}

}  // namespace
}  // namespace flaneur
