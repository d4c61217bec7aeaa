// glTF 2.0 files in (.glb, and .gltf with external or embedded buffers and images) and avatars out.
// Understood beyond the core: KHR_draco_mesh_compression, EXT_meshopt_compression, KHR_mesh_quantization,
// KHR_texture_transform (baked into the uvs), KHR_materials_pbrSpecularGlossiness (its diffuse
// part). A file that requires anything else is refused by name.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"
#include "pipeline/core/scene.h"
#include "pipeline/io/gltf_builder.h"
#include "pipeline/io/scene_reader.h"
#include "runtime/base/error.h"
#include "runtime/base/jobs.h"

namespace flaneur {

// Reads the default scene (the first, or all nodes where the file has none) as a static town. Nodes
// keep the file's order with parents before children; a mesh used by several nodes stands once in
// `scene->meshes`, except that a node with a mirroring world matrix gets a copy with its triangles
// turned round. Strips and fans become triangles, missing normals are computed, points and lines
// are left out. Tags come from node extras by the town convention; ground without `flaneur_ground`
// is pavement. Only images that a material uses are kept. Errors: unreadable or broken file,
// unknown required extension, unknown tag value, a non-finite vertex (names node and mesh), no
// triangle at all.
Error ReadGltfScene(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings = nullptr);

struct ReadAvatarOptions {
  std::string name;  // of the avatar; empty: the file's stem
  // Clip names in the file, upper and lower case alike. Empty: the clip of that very name, else the
  // shortest name that contains it ("Walking_A" for walk; idle and talk may be absent). A file's
  // only clip counts as its walk.
  std::string walk, idle, talk;
  // Further clips: what each is called here, and in the file; empty: the one of that very name, where there is one.
  std::vector<std::pair<std::string, std::string>> other_clips;
  float height_m = 0;              // 0: as in the file where 0.5 to 2.3 m, else 1.75
  std::vector<std::string> hide;   // names of nodes left out, with what hangs on them
  std::vector<std::string> props;  // names of nodes that become AvatarProps, each with what hangs on it
  int max_joints = 256;
};

// Reads a person from glTF, or .blend, .fbx, .dae and .obj by Blender (blender_import.h): every mesh of the default
// scene, on one joint list, in metres, feet at y = 0, centred at x = z = 0. The figure is taken to face +Z. Rigid
// meshes that hang on bones get one weight of 1, weights are reduced to the four heaviest and made to sum to 1, clips
// are resampled at 30 Hz, made to loop and to walk on the spot. The walk's speed is `flaneur_walk_speed_mps` in any
// node's extras (metres of the file), else that of the root's travel, else that of the sole on the ground. `warnings`
// gets one line for each thing left out or guessed. Errors: as for a scene, and no skin, no walk clip (lists the
// clips), a named clip, hidden node or prop that is not there, too many joints, a prop without a mesh.
Error ReadAvatar(const std::filesystem::path& path, const ReadAvatarOptions& options, Avatar* avatar,
                 std::vector<std::string>* warnings);

// Writes one avatar as a glTF binary: one skin, the levels as an MSFT_lod chain, the clips as
// animations, meshes compressed with Draco. The level's numbers stand in the extras of its node.
// Errors: as for WriteFile.
Error WriteAvatarGlb(const std::filesystem::path& path, const AvatarLevels& levels, const DracoOptions& draco = {},
                     Jobs* jobs = nullptr);

}  // namespace flaneur
