// Makes a scene of polygons with coordinates of any size.
#pragma once
#include <string>
#include <vector>

#include "pipeline/core/scene.h"
#include "pipeline/io/axis_order.h"
#include "runtime/base/error.h"

namespace flaneur {

// Its colour. kNotSaid: told by how steep it is, as a building's wall or roof.
enum class SurfaceKind { kOther, kWall, kRoof, kGround, kGrass, kPaving, kPlants, kWater, kNotSaid };

// In which system the coordinates are.
struct CityCoordinates {
  std::string system;  // "EPSG:25832"; empty: not known
  bool axes_as_named;  // the first of a point is what the system's authority says, such as latitude; else always east
};

// A material of its own for a polygon, and of its corners the places in the material's picture, colours and normals:
// for each ring as many as it has points, or none at all.
struct PolygonLook {
  int material = -1;  // as AddMaterial says; -1: that of its kind of surface
  std::vector<std::vector<Vec2>> uvs;
  std::vector<std::vector<Vec4>> colors;   // linear
  std::vector<std::vector<Vec3>> normals;  // unit, in the axes of the points; else the face's own
};

class TownBuilder {
 public:
  // Returns the node's number. Give the parent first.
  int AddNode(const std::string& name, NodeKind kind, GroundKind ground = GroundKind::kNone, int parent = -1);
  // The node below a building that holds its ground surfaces; made when first asked for.
  int FoundationOf(int building);
  void MarkBridge(int node);
  // Returns the material's number. `image`, if any, becomes its picture.
  int AddMaterial(Material material, const Image* image);
  // Of a material that was added: the picture's number, for others that share it; -1: none.
  int ImageOf(int material) const;
  // Rings without a repeated last point: the outer one, then holes. Points are x east, y north, z up, metres; or what
  // Finish makes that of. Finite. Polygons without area are counted and left out.
  void AddPolygon(int node, SurfaceKind surface, const std::vector<std::vector<Point3>>& rings,
                  const PolygonLook& look = {});

  // Degrees, and maps that are stretched, mirrored or turned, become the fitting system in metres: then
  // `source_system` (may be null) is what they were. Which axis comes first is told by the place where the system is
  // used, else of degrees by right angles, of metres by houses that are not inside out, and by `coordinates` only where
  // these are silent. Coordinates far from zero are moved by whole hundreds of metres: see Scene::origin_m. Nodes
  // without triangles stay where something hangs on them. Errors: nothing but polygons without area, degrees in a
  // system of metres or outside of the system's area, a coordinate beyond 1e11; each names `file`.
  Error Finish(const std::string& file, const CityCoordinates& coordinates, Scene* scene, std::string* source_system,
               std::vector<std::string>* warnings);

 private:
  struct Triangle {
    int node, material;
    Point3 a, b, c;
    int first_uv, first_color, first_normal;  // of three; -1: none
  };
  struct WaitingPolygon {
    int node, material;
    std::vector<std::vector<Point3>> rings;
    PolygonLook look;
  };
  void Triangulate(const WaitingPolygon& polygon);
  void TriangulateWaiting();
  bool IsInDegrees() const;  // most nodes that wait
  Error DegreesToMetres(const CityCoordinates& coordinates, std::string* from, std::string* to,
                        std::vector<std::string>* notes);
  AxisEvidence AxesByFaces() const;
  Error MapToMetres(const CityCoordinates& coordinates, std::string* from, std::string* to,
                    std::vector<std::string>* notes);
  Error CheckReach() const;
  std::string TellWithoutFaces() const;  // of buildings; empty: none
  void Build(Scene* scene);
  void TellSurfaces();
  void AddTriangles(Scene* scene);
  std::vector<SceneNode> nodes_;
  std::vector<int> foundations_;
  bool may_be_degrees_ = true;           // so far
  std::vector<WaitingPolygon> waiting_;  // until that is known: degrees are no plane to triangulate in
  std::vector<Triangle> triangles_;
  std::vector<Vec2> uvs_;
  std::vector<Vec4> colors_;
  std::vector<Vec3> normals_;
  std::vector<Material> materials_;  // besides those of the kinds of surface
  std::vector<Image> images_;
  int without_area_ = 0;
};

// "EPSG:25832" from the ways in which files name a reference system (urn, URL, plain, AdV's urn); the text itself where
// it is none of them.
std::string PlainReferenceSystem(const std::string& text);

}  // namespace flaneur
