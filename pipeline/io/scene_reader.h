// Towns in: glTF 2.0 (.glb, .gltf), OBJ, CityJSON 1.0 to 2.0, CityJSONSeq, CityGML 1.0 and 2.0; .blend, .fbx and .dae
// by Blender.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/core/scene.h"
#include "runtime/base/error.h"

namespace flaneur {

// What the file says of itself that the scene no longer shows.
struct SceneSource {
  std::string system;  // of the file's coordinates, where they were brought into Scene::reference_system; else empty
};

// Which axis of an OBJ points up, which the format does not say.
enum class UpAxis { kJudged, kY, kZ };

struct ReadSceneOptions {
  std::string system;  // of a city model's coordinates, whatever its file says: "EPSG:6697"; empty: as the file says
  UpAxis obj_up = UpAxis::kJudged;  // of an OBJ alone
};

// Reads a town of any of these formats, told by the content, Blender's by the name. Coordinates far from zero are moved
// near it and `scene->origin_m` says by how much. City models: each building with its parts and installations is one
// node, named by its id; its finest level of detail up to 3 counts; closure surfaces and rooms are left out; ground
// surfaces become its foundation; terrain and roads are ground, plants trees. Those in degrees, or in a map that is
// stretched, mirrored or turned, are brought into the fitting system in metres: see SceneSource. OBJ: each `o`,
// else each `g`, is an untagged node. `warnings` gets one line for each kind of thing left out or guessed. Errors:
// unreadable or broken file (names the line or element), a number that is none, an index out of range, a document type
// in XML, degrees in a system of metres, nothing to see.
Error ReadScene(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings = nullptr,
                const ReadSceneOptions& options = {}, SceneSource* source = nullptr);

// One format each.
Error ReadObj(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings,
              UpAxis up = UpAxis::kJudged);
Error ReadCityJson(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings,
                   const ReadSceneOptions& options, SceneSource* source);
Error ReadCityGml(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings,
                  const ReadSceneOptions& options, SceneSource* source);

}  // namespace flaneur
