// Builds a glTF 2.0 binary piece by piece. Every Add function returns the index that glTF itself
// uses.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/core/avatar.h"
#include "pipeline/core/mesh.h"
#include "runtime/base/error.h"
#include "runtime/base/math.h"

namespace flaneur {

// Bits each component is rounded to, over the extent of the mesh. Joints and weights are lossless:
// weights are stored as bytes that sum to 255.
struct DracoOptions {
  bool compress = true;   // false: plain accessors, nothing rounded but weights
  int position_bits = 0;  // 0: for a level of detail by its error, 12 to 16; else 14
  int normal_bits = 10;
  int uv_bits = 12;
  int color_bits = 10;
  int speed = 0;              // 0: smallest, 10: fastest
  size_t most_triangles = 0;  // a primitive: larger ones are cut into several, see InPieces; 0: any
};

struct GltfNode {
  std::string name;
  int parent = -1;  // index of an earlier node; -1: a root, to be named in a scene
  int mesh = -1;
  int skin = -1;  // a node with a skin must be a root and have no transform
  Transform transform;
  std::string extras;  // a JSON object, or empty
};

struct EncodedAvatar;
struct EncodedMesh;
struct KeyChannel;

class GltfBuilder {
 public:
  GltfBuilder();
  ~GltfBuilder();
  GltfBuilder(GltfBuilder&&) noexcept;
  GltfBuilder& operator=(GltfBuilder&&) noexcept;

  // Equal images (and textures, and float arrays) are stored once.
  int AddImage(const Image& image);
  int AddTexture(int image, bool repeat = true);
  // `material`'s image indices are those of AddImage.
  int AddMaterial(const Material& material);
  // Adds the images and materials of one owner; returns where each material went, to be passed to
  // AddMesh.
  std::vector<int> AddMaterials(std::span<const Material> materials, std::span<const Image> images);

  // One glTF mesh with a primitive for each of the encoded parts; `materials[part.material]` is its material here.
  // At least one part; joint indices are those of the skin that the node will name. Errors: a material out of range,
  // no triangle; each names the mesh.
  Error AddMesh(const std::string& name, const EncodedMesh& encoded, std::span<const int> materials, int* mesh);

  int AddNode(const GltfNode& node);
  int AddSkin(const std::string& name, std::span<const int> joint_nodes, std::span<const Mat4> inverse_binds,
              int skeleton_node);
  // Rounded channels are packed by EXT_meshopt_compression. Returns -1, and adds nothing, where there is none.
  int AddAnimation(const std::string& name, std::span<const KeyChannel> channels, std::span<const int> joint_nodes);
  int AddScene(const std::string& name,
               std::span<const int> root_nodes);  // the first is the default scene

  // Raw bytes in the binary chunk, aligned to 4; for the extensions' own data.
  int AddBufferView(std::span<const uint8_t> bytes);

  // `json` is an object; a second call for the same name replaces the first. Both note the
  // extension as used.
  void SetRootExtension(const std::string& name, std::string_view json);
  void SetNodeExtension(int node, const std::string& name, std::string_view json);
  void SetNodeExtras(int node, std::string_view json);
  void UseExtension(const std::string& name, bool required = false);
  // The node's coarser stand-ins (MSFT_lod), finest first; they belong in no scene.
  // `switch_heights`, one for the node and each stand-in: the share of the screen's height at or
  // above which it is shown.
  void SetLevels(int node, std::span<const int> coarser, std::span<const float> switch_heights);

  // The whole file. The builder is empty afterwards.
  Error Finish(std::vector<uint8_t>* glb);
  // The same into a file; `bytes`: its size. Errors: also those of WriteFile.
  Error Write(const std::filesystem::path& path, size_t* bytes);
  // Goes on with what Finish gave, in the place of all that was added so far. Images, textures and clips that are added
  // then are not compared with those in the file. Errors: no glTF binary.
  Error Resume(std::vector<uint8_t> glb);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Where an avatar went.
struct AvatarPart {
  int skin = -1;
  int skeleton_node = -1;        // parent of the root joints; a root of the scene
  std::vector<int> joint_nodes;  // as Avatar::joints
  std::vector<int> level_nodes;  // finest first; the first is a root of the scene
  std::vector<int> prop_nodes;   // as Avatar::props
  std::vector<int> animations;   // as Avatar::clips; -1: a clip without motion
  std::vector<int> materials;    // as Avatar::materials
};

// Adds skeleton, skin, levels (chained by MSFT_lod) and clips; names of nodes and animations start
// with `prefix`. `encoded` is of the same levels. The caller puts `skeleton_node`, `level_nodes[0]` and `prop_nodes`
// into a scene. Errors: as AddMesh.
Error AddAvatar(GltfBuilder* builder, const AvatarLevels& levels, const EncodedAvatar& encoded,
                const std::string& prefix, AvatarPart* part);

}  // namespace flaneur
