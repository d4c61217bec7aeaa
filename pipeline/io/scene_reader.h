// Towns in: glTF 2.0 (.glb, .gltf), OBJ, PLY, STL, CityJSON 1.0 to 2.0, CityJSONSeq, CityGML 1.0 to 3.0; by Blender
// .blend, .fbx, .dae, .x3d, .wrl, .abc and USD, as far as the installed one reads them.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/core/scene.h"
#include "pipeline/io/up_axis.h"
#include "runtime/base/error.h"

namespace flaneur {

// What the file says of itself that the scene no longer shows.
struct SceneSource {
  std::string system;  // of the file's coordinates, where they were brought into Scene::reference_system; else empty
};

struct ReadSceneOptions {
  std::string system;  // of a city model's coordinates, whatever its file says: "EPSG:6697"; empty: as the file says
  // Not of a city model. Of what Blender reads: of the glTF that it makes of it. kJudged: as the format says, which
  // OBJ, PLY and STL don't.
  UpAxis up = UpAxis::kJudged;
};

// Reads a town of any of these formats, told by the content, Blender's by the name. Coordinates far from zero are moved
// near it and `scene->origin_m` says by how much. A town that lies on its side gets a warning. City models: each
// building with its parts and installations is one node, named by its id; its finest level of detail up to 3 counts;
// closure surfaces and rooms are left out; ground surfaces become its foundation; terrain and roads are ground, plants
// trees. Those in degrees, or in a map that is stretched, mirrored or turned, are brought into the fitting system in
// metres: see SceneSource. OBJ: each `o`, else each `g`, is an untagged node; a PLY or STL is one. `warnings` gets one
// line for each kind of thing left out or guessed. Errors: unreadable or broken file (names the line or element), a
// number that is none, an index out of range, a document type in XML, degrees in a system of metres, nothing to see, no
// format that is known, `up` of a city model.
Error ReadScene(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings = nullptr,
                const ReadSceneOptions& options = {}, SceneSource* source = nullptr);

// One format each.
Error ReadObj(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings,
              UpAxis up = UpAxis::kJudged);
Error ReadPly(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings,
              UpAxis up = UpAxis::kJudged);
Error ReadStl(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings,
              UpAxis up = UpAxis::kJudged);
Error ReadCityJson(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings,
                   const ReadSceneOptions& options, SceneSource* source);
Error ReadCityGml(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings,
                  const ReadSceneOptions& options, SceneSource* source);

}  // namespace flaneur
