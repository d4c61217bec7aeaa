#include "pipeline/io/join_documents.h"

#include <map>
#include <string>
#include <utility>

#include "pipeline/rig/copy_clip.h"
#include "runtime/base/array.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

std::vector<bool> BonesOf(const GltfDocument& document) {
  std::vector<bool> bone(document.nodes.size(), false);
  for (const DocumentSkin& skin : document.skins) {
    for (const int joint : skin.joints) At(bone, joint) = true;
  }
  return bone;
}

void Shift(int by, int* index) {
  if (*index >= 0) *index += by;
}

template <typename T>
void MoveAll(std::vector<T>* from, std::vector<T>* to) {
  for (T& each : *from) to->push_back(std::move(each));
}

}  // namespace

Error JoinDocuments(GltfDocument part, GltfDocument* whole) {
  const std::vector<bool> own_bones = BonesOf(*whole), bones = BonesOf(part);
  std::map<std::string, int> by_name;
  for (int n = 0; n < Count(whole->nodes); ++n) {
    if (At(own_bones, n)) by_name.try_emplace(BareName(At(whole->nodes, n).name), n);
  }
  // Where each node of the part goes: onto the one it stands for, or behind all.
  const int first = Count(whole->nodes);
  std::vector<int> to;
  int known = 0, wanted = 0;
  for (int n = 0; n < Count(part.nodes); ++n) {
    const auto same = by_name.find(BareName(At(part.nodes, n).name));
    const bool stands_for = same != by_name.end() && At(part.nodes, n).mesh < 0;
    to.push_back(stands_for ? same->second : first + n);
    wanted += At(bones, n), known += At(bones, n) && stands_for;
  }
  if (wanted > 0 && 2 * known < wanted) {
    return Fail(part.path + ": is for another skeleton: only " + std::to_string(known) + " of its " +
                std::to_string(wanted) + " bones have names of " + OneLine(whole->path) + "'s");
  }
  const int meshes = Count(whole->meshes), skins = Count(whole->skins), materials = Count(whole->materials),
            images = Count(whole->images);
  for (int n = 0; n < Count(part.nodes); ++n) {
    DocumentNode node = std::move(At(part.nodes, n));
    if (At(to, n) != first + n) node.in_scene = false;  // another stands for it
    if (node.parent >= 0) node.parent = At(to, node.parent);
    Shift(meshes, &node.mesh);
    Shift(skins, &node.skin);
    whole->nodes.push_back(std::move(node));
  }
  for (const int n : part.order) whole->order.push_back(first + n);
  for (DocumentMesh& mesh : part.meshes) {
    for (DocumentPrimitive& primitive : mesh.primitives) Shift(materials, &primitive.mesh.material);
  }
  for (DocumentSkin& skin : part.skins) {
    for (int& joint : skin.joints) joint = At(to, joint);
  }
  for (Material& material : part.materials) {
    Shift(images, &material.base_color_image);
    Shift(images, &material.normal_image);
  }
  MoveAll(&part.meshes, &whole->meshes);
  MoveAll(&part.skins, &whole->skins);
  MoveAll(&part.materials, &whole->materials);
  MoveAll(&part.images, &whole->images);
  return Ok();
}

}  // namespace flaneur
