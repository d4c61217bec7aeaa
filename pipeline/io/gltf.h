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
// triangle at all. Messages call the file `named`, as LoadGltf's do.
Error ReadGltfScene(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings = nullptr,
                    const std::filesystem::path& named = {});

// A clip besides walk, idle and talk, or one of these from a file of its own.
struct ClipRequest {
  std::string name;       // what it is called here
  std::string clip = {};  // in the file; empty: the one of that name, where there is one
  std::filesystem::path file =
      {};  // any that OpenMotion reads, or "flaneur": the clips that come with the program; empty: the avatar's
};

struct ReadAvatarOptions {
  std::string name;  // of the avatar; empty: the file's stem
  // Clip names, upper and lower case alike. Empty: the clip of that very name, else the shortest name that contains it
  // ("Walking_A" for walk; idle and talk may be absent). A file's only clip counts as its walk. Clips are looked for in
  // clip_files, then in the avatar's own file, and a name or a missing walk in the clips that come with the program.
  std::string walk, idle, talk;
  std::vector<ClipRequest> other_clips;
  std::vector<std::filesystem::path> clip_files;
  float height_m = 0;       // 0: as in the file where 0.5 to 2.3 m, else in a unit that makes it so, else 1.75
  float scale = 0;          // metres per unit of the file, where height_m is 0; 0: by the height
  std::string up, forward;  // of the figure in the file: "z", "-y", ...; empty: by its skeleton and walk
  std::vector<std::filesystem::path> parts;  // further files on the same skeleton: outfits, hair, faces
  std::vector<std::string> hide;             // names of nodes left out, with what hangs on them
  std::vector<std::string> props;            // names of nodes that become AvatarProps, each with what hangs on it
  int max_joints = 4096;                     // BuildLevels makes fewer of them
};

// Reads a person from glTF, or .blend, .fbx, .dae and .obj by Blender (blender_import.h): every mesh of the default
// scene, on one joint list, in metres, feet at y = 0, centred at x = z = 0, upright and facing +Z. Rigid
// meshes that hang on bones get one weight of 1, weights are reduced to the four heaviest and made to sum to 1, clips
// are resampled at 30 Hz, made to loop and to walk on the spot; those of other files are taken as they are where the
// skeletons are one, else made to fit (pipeline/rig/retarget.h). The walk's speed is that of the clip it was made from,
// or `flaneur_walk_speed_mps` in any node's extras (in metres or in the unit of the file), else that of the root's
// travel, else that of the sole on the ground. `warnings` gets one line for each thing left out or guessed. Errors: as
// for a scene and for OpenMotion, no skin, a named clip, hidden node or prop that is not there, a clip that fits no
// way, too many joints, a prop without a mesh; without any walk clip, four legs.
Error ReadAvatar(const std::filesystem::path& path, const ReadAvatarOptions& options, Avatar* avatar,
                 std::vector<std::string>* warnings);

// Writes one avatar as a glTF binary: one skin, the levels as an MSFT_lod chain, the clips as
// animations, meshes compressed with Draco. The level's numbers stand in the extras of its node.
// Errors: as for WriteFile.
Error WriteAvatarGlb(const std::filesystem::path& path, const AvatarLevels& levels, const DracoOptions& draco = {},
                     Jobs* jobs = nullptr);

}  // namespace flaneur
