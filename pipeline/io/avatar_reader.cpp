#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "pipeline/io/avatar_normalize.h"
#include "pipeline/io/avatar_stance.h"
#include "pipeline/io/blender_import.h"
#include "pipeline/io/choose_clips.h"
#include "pipeline/io/gltf.h"
#include "pipeline/io/gltf_document.h"
#include "pipeline/io/gltf_names.h"
#include "pipeline/io/gltf_pose.h"
#include "pipeline/io/join_documents.h"
#include "pipeline/io/motion_reader.h"
#include "pipeline/rig/clip_loop.h"
#include "pipeline/rig/clip_rig.h"
#include "pipeline/rig/copy_clip.h"
#include "pipeline/rig/face.h"
#include "pipeline/rig/motion_quality.h"
#include "pipeline/rig/plant_feet.h"
#include "pipeline/rig/retarget.h"
#include "pipeline/rig/still_legs.h"
#include "runtime/base/array.h"
#include "runtime/base/file.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

constexpr float kLongestLoop_s = 12;  // of a walk, and of any clip from another file
constexpr float kLongestOwn_s = 59;   // of any other clip of the figure's own
constexpr float kMostSlide = 0.15f;   // of the walking speed: what soles may slide before a clip is not taken as it is

// Nodes to draw: in the scene and not beneath a hidden one.
Error VisibleNodes(const GltfDocument& document, const ReadAvatarOptions& options, std::vector<bool>* visible) {
  std::vector<std::string> names;
  for (const DocumentNode& node : document.nodes) names.push_back(node.name);
  const auto find = [&](const std::vector<std::string>& wanted, const char* what) {
    for (const std::string& name : wanted) {
      if (std::find(names.begin(), names.end(), name) == names.end())
        return Fail("no node " + Quoted(name) + what + DidYouMean(name, names));
    }
    return Ok();
  };
  if (Error e = find(options.hide, " to hide")) return e;
  if (Error e = find(options.props, " for the prop of that name")) return e;
  visible->assign(document.nodes.size(), false);
  for (const int i : document.order) {
    const DocumentNode& node = At(document.nodes, i);
    const bool hidden = std::find(options.hide.begin(), options.hide.end(), node.name) != options.hide.end();
    const bool parent_seen = node.parent < 0 || !At(document.nodes, node.parent).in_scene || At(*visible, node.parent);
    At(*visible, i) = node.in_scene && parent_seen && !hidden;
  }
  return Ok();
}

// A node with a mesh, and for a rigid one the node of the skeleton that it moves with.
struct Part {
  int node = 0;
  bool skinned = false;
  int anchor = -1;
  int prop = -1;  // of the avatar's props; -1: everybody has it
};

using Face = std::array<std::vector<Vec3>, kFaceMoves>;  // as DocumentPrimitive has it

bool HasInfluences(const DocumentMesh& mesh) {
  return std::any_of(mesh.primitives.begin(), mesh.primitives.end(),
                     [](const auto& primitive) { return primitive.influences.per_vertex > 0; });
}

Error CheckSkins(const GltfDocument& document) {
  for (const DocumentSkin& skin : document.skins) {
    if (!skin.joints.empty()) return Ok();
  }
  return Fail("no skin: no mesh is bound to a skeleton; export the rigged figure");
}

class AvatarReader {
 public:
  AvatarReader(const GltfDocument& document, const ReadAvatarOptions& options, Avatar* avatar,
               std::vector<std::string>* notes)
      : document_(document), options_(options), avatar_(avatar), notes_(notes) {}

  Error Read();

 private:
  Error FindParts();
  Error FindJoints();
  void FindBindPose();
  Error AddPart(const Part& part);
  Error SkinVertices(const Part& part, const DocumentPrimitive& primitive, Mesh* mesh, Face* face);
  void AttachVertices(const Part& part, Mesh* mesh, Face* face) const;
  void AddToFace(const Face& face, size_t mesh, size_t before);
  int PropOf(int node) const;
  bool HangsOnLeg(const Part& part) const;
  Mesh* MergedMesh(int material, std::vector<Mesh>* meshes) const;
  void WarnOfFullHands() const;
  Error JudgeLoneWalk(const Rig& rig);
  Error AddClips();
  float ToldSpeed() const;
  void PlantWalk(const Rig& rig, Retargeted* walk);
  void Shorten(const std::string& clip_name, bool walks, const std::vector<Joint>& joints, Clip* clip);
  Error FitClip(const ChosenClip& chosen, const Rig* rig, const std::string& why);
  void Glide();
  std::vector<NamedBone> Told() const;
  void DropUnusedMaterials();

  const DocumentNode& Node(int i) const { return At(document_.nodes, i); }

  const GltfDocument& document_;
  const ReadAvatarOptions& options_;
  Avatar* avatar_;
  std::vector<std::string>* notes_;

  ClipChoice clips_;
  std::vector<Part> parts_;
  std::vector<int> joint_nodes_;  // node of each of the avatar's joints
  std::vector<int> joint_of_;     // joint of each node, -1: none
  std::vector<Mat4> rest_;        // world matrices of the file's own pose
  std::vector<Mat4> to_metres_;   // a joint: removes the scale that its node has at rest, and mirroring
  float walk_speed_ = 0;          // of a walk made to fit, in units of the file
  std::vector<FaceShape> face_{{FaceMove::kBlink, {}}, {FaceMove::kOpenMouth, {}}};
  Mesh body_;  // skinned parts: what stands on the ground
  int unnormalized_ = 0;
  int weightless_ = 0;
};

// Of the nearest of the node and those above it that bears a prop's name.
int AvatarReader::PropOf(int node) const {
  for (int a = node; a >= 0; a = Node(a).parent) {
    const auto found = std::find(options_.props.begin(), options_.props.end(), Node(a).name);
    if (found != options_.props.end()) return static_cast<int>(found - options_.props.begin());
  }
  return -1;
}

// A foot or shin of a figure that is put together from rigid pieces.
bool AvatarReader::HangsOnLeg(const Part& part) const {
  for (int a = part.anchor; a >= 0; a = Node(a).parent) {
    const BodyPart body_part = ReadBoneName(Node(a).name).part;
    if (body_part >= BodyPart::kUpperLeg && body_part <= BodyPart::kToes) return true;
  }
  return false;
}

Error AvatarReader::FindParts() {
  std::vector<bool> visible;
  if (Error e = VisibleNodes(document_, options_, &visible)) return e;
  std::vector<bool> moves(document_.nodes.size(), false);
  for (const DocumentSkin& skin : document_.skins) {
    for (const int joint : skin.joints) At(moves, joint) = true;
  }
  for (const ChosenClip& clip : clips_.clips) {
    if (clip.file >= 0) continue;
    for (const DocumentChannel& c : document_.clips[clip.index].channels) At(moves, c.node) = true;
  }
  bool any_skinned = false;
  for (const std::string& name : options_.props) avatar_->props.push_back({name, {}});
  for (const int i : document_.order) {
    const DocumentNode& node = Node(i);
    if (!At(visible, i) || node.mesh < 0) continue;
    const DocumentMesh& mesh = At(document_.meshes, node.mesh);
    if (mesh.primitives.empty()) continue;
    const bool has_face = std::any_of(mesh.primitives.begin(), mesh.primitives.end(), [](const auto& primitive) {
      return !primitive.face[0].empty() || !primitive.face[1].empty();
    });
    if (mesh.morphs) {
      notes_->push_back("mesh " + Quoted(mesh.name) + ": its morph targets stay at the file's own weights" +
                        (has_face ? ", but for those that close eyes and open the mouth" : ""));
    }
    Part part{i, node.skin >= 0 && HasInfluences(mesh), -1, PropOf(i)};
    for (int a = i; a >= 0 && part.anchor < 0; a = Node(a).parent) {
      if (At(moves, a)) part.anchor = a;
    }
    if (!part.skinned && part.anchor < 0) {
      notes_->push_back("node " + Quoted(node.name) + " hangs on no bone and is left out");
      continue;
    }
    any_skinned = any_skinned || (part.skinned && part.prop < 0);
    parts_.push_back(part);
  }
  if (!any_skinned) {
    return Fail("no skin: no visible mesh is bound to a skeleton; export the rigged figure");
  }
  return Ok();
}

// Joints that some vertex follows, and the skeleton above them.
Error AvatarReader::FindJoints() {
  std::vector<bool> bone(document_.nodes.size(), false), used(document_.nodes.size(), false);
  for (const DocumentSkin& skin : document_.skins) {
    for (const int joint : skin.joints) At(bone, joint) = true;
  }
  for (const Part& part : parts_) {
    if (!part.skinned) {
      At(used, part.anchor) = true;
      continue;
    }
    const DocumentSkin& skin = At(document_.skins, Node(part.node).skin);
    const int mesh = Node(part.node).mesh;
    for (const auto& primitive : At(document_.meshes, mesh).primitives) {
      const Influences& in = primitive.influences;
      bool any_weight = false;
      for (size_t i = 0; i < in.joints.size(); ++i) {
        if (in.weights[i] <= 0) continue;
        any_weight = true;
        if (!InRange(skin.joints, in.joints[i])) {
          return Fail("mesh " + Quoted(primitive.mesh.name) + ": joint " + std::to_string(in.joints[i]) +
                      " is not in its skin");
        }
        At(used, At(skin.joints, in.joints[i])) = true;
      }
      if (!any_weight) At(used, skin.joints[0]) = true;
    }
  }
  for (auto it = document_.order.rbegin(); it != document_.order.rend(); ++it) {
    const int parent = Node(*it).parent;
    // Kept bones reach up to the topmost bone; plain nodes between and above fold into them.
    for (int a = parent; At(used, *it) && a >= 0; a = Node(a).parent) {
      if (At(bone, a)) At(used, a) = true;
    }
  }
  joint_of_.assign(document_.nodes.size(), -1);
  for (const int i : document_.order) {
    if (!At(used, i)) continue;
    Joint joint;
    joint.name = Node(i).name;
    for (int a = Node(i).parent; a >= 0 && joint.parent < 0; a = Node(a).parent) {
      joint.parent = At(joint_of_, a);
    }
    At(joint_of_, i) = Count(joint_nodes_);
    joint_nodes_.push_back(i);
    avatar_->joints.push_back(std::move(joint));
  }
  if (Count(joint_nodes_) > options_.max_joints) {
    return Fail("it uses " + std::to_string(joint_nodes_.size()) + " joints, at most " +
                std::to_string(options_.max_joints) + " are possible; simplify the skeleton");
  }
  return Ok();
}

float Determinant(const Mat4& m) {
  const Vec3 x{m.m[0][0], m.m[0][1], m.m[0][2]};
  const Vec3 y{m.m[1][0], m.m[1][1], m.m[1][2]};
  const Vec3 z{m.m[2][0], m.m[2][1], m.m[2][2]};
  return Dot(Cross(x, y), z);
}

Mat4 UniformScale(float s) { return FromTranslationRotationScale({}, {}, {s, s, s}); }

// One bind pose for all skins, in scene space: that of the first skin each joint is in, placed so
// that the first joint's bind pose is its rest pose. Parts bound otherwise are moved into it when
// they are added.
void AvatarReader::FindBindPose() {
  rest_ = WorldMatrices(document_);
  std::vector<const Mat4*> binds(joint_nodes_.size(), nullptr);
  for (const Part& part : parts_) {
    if (!part.skinned) continue;
    const DocumentSkin& skin = At(document_.skins, Node(part.node).skin);
    for (size_t k = 0; k < skin.joints.size(); ++k) {
      const int joint = At(joint_of_, skin.joints[k]);
      if (joint < 0 || At(binds, joint) != nullptr) continue;
      At(binds, joint) = &skin.inverse_binds[k];
    }
  }
  Mat4 from_bind;  // the skins' space to scene space
  for (size_t j = 0; j < binds.size(); ++j) {
    if (binds[j] == nullptr) continue;
    from_bind = At(rest_, joint_nodes_[j]) * *binds[j];
    break;
  }
  const Mat4 to_bind = Inverse(from_bind);
  for (size_t j = 0; j < binds.size(); ++j) {
    const Mat4& rest = At(rest_, joint_nodes_[j]);
    const float volume = Determinant(rest), scale = volume != 0 ? std::cbrt(std::abs(volume)) : 1.0f;
    to_metres_.push_back(Unscaled(rest));
    const Mat4 inverse = binds[j] != nullptr ? *binds[j] * to_bind : Inverse(rest);
    const Mat4 from_metres = FromTranslationRotationScale({}, {}, {volume < 0 ? -scale : scale, scale, scale});
    avatar_->joints[j].inverse_bind = from_metres * inverse;
    const int parent = avatar_->joints[j].parent;
    const Mat4 own = rest * to_metres_[j];
    const size_t p = static_cast<size_t>(std::max(parent, 0));
    avatar_->joints[j].rest = Decomposed(parent < 0 ? own : Inverse(At(rest_, joint_nodes_[p]) * to_metres_[p]) * own);
  }
}

// Positions and normals through one matrix.
void Transform3(const Mat4& matrix, Vec3* position, Vec3* normal) {
  *position = TransformPoint(matrix, *position);
  const Vec3 x{matrix.m[0][0], matrix.m[0][1], matrix.m[0][2]};
  const Vec3 y{matrix.m[1][0], matrix.m[1][1], matrix.m[1][2]};
  const Vec3 z{matrix.m[2][0], matrix.m[2][1], matrix.m[2][2]};
  const Vec3 n = Cross(y, z) * normal->x + Cross(z, x) * normal->y + Cross(x, y) * normal->z;
  // Cofactors turn the normal over where the matrix mirrors; it stays outside.
  *normal = Normalized(Determinant(matrix) < 0 ? n * -1 : n);
}

void TurnRound(Mesh* mesh) {
  for (size_t i = 0; i < mesh->indices.size(); i += 3) {
    std::swap(mesh->indices[i], mesh->indices[i + 1]);
  }
}

struct Weighted {
  uint16_t joint = 0;
  float weight = 0;
};

// The four heaviest, summing to 1. Returns false where there is no weight at all.
bool FourHeaviest(std::vector<Weighted> all, std::array<uint16_t, 4>* joints, std::array<float, 4>* weights) {
  std::stable_sort(all.begin(), all.end(), [](const Weighted& a, const Weighted& b) { return a.weight > b.weight; });
  all.resize(4);
  float sum = 0;
  for (const Weighted& each : all) sum += each.weight;
  if (!(sum > 0)) return false;
  for (size_t i = 0; i < 4; ++i) {
    (*weights)[i] = all[i].weight / sum;
    (*joints)[i] = all[i].weight > 0 ? all[i].joint : uint16_t{0};
  }
  return true;
}

void TransformFace(const Mat4& matrix, size_t vertex, Face* face) {
  for (std::vector<Vec3>& offsets : *face) {
    if (!offsets.empty()) offsets[vertex] = TransformDirection(matrix, offsets[vertex]);
  }
}

Error AvatarReader::SkinVertices(const Part& part, const DocumentPrimitive& primitive, Mesh* mesh, Face* face) {
  const DocumentSkin& skin = At(document_.skins, Node(part.node).skin);
  std::vector<Mat4> into_bind(skin.joints.size());  // the part's space to the avatar's bind pose
  for (size_t k = 0; k < skin.joints.size(); ++k) {
    const int joint = At(joint_of_, skin.joints[k]);
    if (joint < 0) continue;
    const size_t j = static_cast<size_t>(joint);
    into_bind[k] = Inverse(avatar_->joints[j].inverse_bind) * Inverse(to_metres_[j]) * skin.inverse_binds[k];
  }
  const Influences& in = primitive.influences;
  const size_t width = static_cast<size_t>(in.per_vertex);
  const size_t vertices = mesh->positions.size();
  mesh->joints.resize(vertices);
  mesh->weights.resize(vertices);
  int mirrored = 0;
  for (size_t v = 0; v < vertices; ++v) {
    std::vector<Weighted> all;
    Mat4 blend = UniformScale(0);
    blend.m[3][3] = 0;
    float sum = 0;
    for (size_t i = v * width; i < (v + 1) * width; ++i) {
      const float weight = in.weights[i];
      if (weight <= 0) continue;
      const size_t k = static_cast<size_t>(in.joints[i]);
      sum += weight;
      for (size_t m = 0; m < 16; ++m) blend.m[m / 4][m % 4] += weight * into_bind[k].m[m / 4][m % 4];
      const auto joint = static_cast<uint16_t>(At(joint_of_, skin.joints[k]));
      const auto same = std::find_if(all.begin(), all.end(), [&](const Weighted& w) { return w.joint == joint; });
      if (same == all.end()) all.push_back({joint, weight});
      else same->weight += weight;
    }
    if (!FourHeaviest(all, &mesh->joints[v], &mesh->weights[v])) {
      ++weightless_;
      const int root = At(joint_of_, skin.joints[0]);
      mesh->joints[v] = {static_cast<uint16_t>(std::max(root, 0)), 0, 0, 0};
      mesh->weights[v] = {1, 0, 0, 0};
      blend = into_bind[0];
      sum = 1;
    }
    if (std::abs(sum - 1) > 0.01f) ++unnormalized_;
    for (auto& column : blend.m) {
      for (float& value : column) value /= sum;
    }
    if (Determinant(blend) < 0) ++mirrored;
    Transform3(blend, &mesh->positions[v], &mesh->normals[v]);
    TransformFace(blend, v, face);
  }
  if (2 * static_cast<size_t>(mirrored) > vertices) TurnRound(mesh);
  return Ok();
}

void AvatarReader::AttachVertices(const Part& part, Mesh* mesh, Face* face) const {
  const int joint = At(joint_of_, part.anchor);
  const size_t j = static_cast<size_t>(joint);
  const Mat4 from_anchor = Inverse(At(rest_, part.anchor)) * At(rest_, part.node);
  const Mat4 matrix = Inverse(avatar_->joints[j].inverse_bind) * Inverse(to_metres_[j]) * from_anchor;
  for (size_t v = 0; v < mesh->positions.size(); ++v) {
    Transform3(matrix, &mesh->positions[v], &mesh->normals[v]);
    TransformFace(matrix, v, face);
  }
  if (Determinant(matrix) < 0) TurnRound(mesh);
  mesh->joints.assign(mesh->positions.size(), {static_cast<uint16_t>(joint), 0, 0, 0});
  mesh->weights.assign(mesh->positions.size(), {1, 0, 0, 0});
}

template <typename T>
void AppendAll(const std::vector<T>& from, std::vector<T>* to) {
  to->insert(to->end(), from.begin(), from.end());
}

// As AppendAll; where only one side has the attribute the other is filled with `missing`.
template <typename T>
void AppendFilled(const std::vector<T>& from, size_t from_count, size_t to_count, T missing, std::vector<T>* to) {
  if (from.empty() && to->empty()) return;
  if (to->empty()) to->assign(to_count, missing);
  AppendAll(from, to);
  to->resize(to_count + from_count, missing);
}

Mesh* AvatarReader::MergedMesh(int material, std::vector<Mesh>* meshes) const {
  for (Mesh& mesh : *meshes) {
    if (mesh.material == material) return &mesh;
  }
  meshes->emplace_back();
  meshes->back().material = material;
  meshes->back().name = material < 0 ? "plain" : At(document_.materials, material).name;
  return &meshes->back();
}

void AppendMesh(const Mesh& part, Mesh* mesh) {
  const size_t base = mesh->positions.size(), count = part.positions.size();
  AppendFilled(part.uvs, count, base, Vec2{}, &mesh->uvs);
  AppendFilled(part.colors, count, base, Vec4{1, 1, 1, 1}, &mesh->colors);
  AppendAll(part.positions, &mesh->positions);
  AppendAll(part.normals, &mesh->normals);
  AppendAll(part.joints, &mesh->joints);
  AppendAll(part.weights, &mesh->weights);
  for (const uint32_t i : part.indices) {
    mesh->indices.push_back(static_cast<uint32_t>(base) + i);
  }
}

// What a part's morph targets move, where its `before` vertices come to lie.
void AvatarReader::AddToFace(const Face& face, size_t mesh, size_t before) {
  for (size_t move = 0; move < kFaceMoves; ++move) {
    if (face[move].empty()) continue;
    auto& offsets = face_[move].offsets;
    offsets.resize(std::max(offsets.size(), mesh + 1));
    offsets[mesh].resize(before);
    AppendAll(face[move], &offsets[mesh]);
  }
}

Error AvatarReader::AddPart(const Part& part) {
  const int mesh_index = Node(part.node).mesh;
  for (const auto& primitive : At(document_.meshes, mesh_index).primitives) {
    Mesh mesh = primitive.mesh;
    Face face = primitive.face;
    if (part.skinned && primitive.influences.per_vertex > 0) {
      if (Error e = SkinVertices(part, primitive, &mesh, &face)) return e;
    } else if (part.anchor >= 0) {
      AttachVertices(part, &mesh, &face);
    } else {
      Part on_skin = part;
      on_skin.anchor = At(document_.skins, Node(part.node).skin).joints[0];
      AttachVertices(on_skin, &mesh, &face);
    }
    std::vector<Mesh>& meshes = part.prop < 0 ? avatar_->meshes : At(avatar_->props, part.prop).meshes;
    Mesh* merged = MergedMesh(mesh.material, &meshes);
    if (part.prop < 0) AddToFace(face, static_cast<size_t>(merged - meshes.data()), merged->positions.size());
    AppendMesh(mesh, merged);
    if ((part.skinned || HangsOnLeg(part)) && part.prop < 0) AppendMesh(mesh, &body_);
  }
  return Ok();
}

// Alternates that all show in one hand: two axes and a mug.
void AvatarReader::WarnOfFullHands() const {
  std::map<int, std::vector<std::string>> held;  // by hand's node
  for (const Part& part : parts_) {
    if (part.skinned || part.prop >= 0) continue;
    for (int a = part.anchor; a >= 0; a = Node(a).parent) {
      if (ReadBoneName(Node(a).name).part != BodyPart::kHand) continue;
      held[a].push_back(Node(part.node).name);
      break;
    }
  }
  for (const auto& [hand, things] : held) {
    if (things.size() < 2) continue;
    std::string list;
    for (const std::string& thing : things) list += (list.empty() ? "" : ", ") + Quoted(thing);
    notes_->push_back(Quoted(Node(hand).name) + " holds " + std::to_string(things.size()) + " things at once (" + list +
                      "): hide all but one, or make them props");
  }
}

std::vector<NamedBone> AvatarReader::Told() const {
  std::vector<NamedBone> told;
  for (const DocumentBone& bone : document_.bones) {
    if (At(joint_of_, bone.node) >= 0) told.push_back({At(joint_of_, bone.node), bone.part, bone.side});
  }
  return told;
}

// Stylized walks drag their feet through the ground: as they are where the skeletons are one, but for that.
void AvatarReader::PlantWalk(const Rig& rig, Retargeted* walk) {
  if (!PlantFeet(rig, walk)) return;
  walk_speed_ = walk->walk_speed_mps;
  char share[16];
  std::snprintf(share, sizeof share, "%.0f", static_cast<double>(100 * walk->source_slide));
  notes_->push_back("the walk's feet slide over the ground by " + std::string(share) +
                    " % of its speed; they are set anew");
}

// Of the file's own walk, by itself; 0: it does not say.
float AvatarReader::ToldSpeed() const {
  float speed = 0;
  for (const DocumentNode& node : document_.nodes) speed = std::max(speed, node.tags.walk_speed_mps);
  return speed;
}

// A recording of minutes to what is repeated: of a walk one cycle.
void AvatarReader::Shorten(const std::string& clip_name, bool walks, const std::vector<Joint>& joints, Clip* clip) {
  if (walks) CutToCycle(joints, clip);
  if (clip->duration_s <= kLongestLoop_s) return;
  notes_->push_back("clip " + clip_name + " is long; its first " + std::to_string(static_cast<int>(kLongestLoop_s)) +
                    " s are taken");
  CutTo(kLongestLoop_s, joints.size(), clip);
}

// A clip of another file: as it is where the skeletons are one, else retargeted, else by the joints' names.
Error AvatarReader::FitClip(const ChosenClip& chosen, const Rig* rig, const std::string& why) {
  const MotionFile& motion = At(clips_.files, chosen.file);
  Clip clip;
  if (Error e = ClipOf(motion, chosen.index, &clip)) return e;
  const std::vector<Joint>& joints = motion.skeleton.joints;
  DropRestPose(joints, &clip);
  Shorten(Quoted(motion.clip_names[chosen.index]) + " of " + motion.path, chosen.name == "walk", joints, &clip);
  float scale = 1;
  Rig source;
  std::string source_why;
  Retargeted made;
  const bool same = SameSkeleton(joints, avatar_->joints, &scale), walks = chosen.name == "walk" && rig != nullptr;
  if (same) CopyClip(joints, clip, avatar_->joints, &made.clip);
  if (same && walks) PlantWalk(*rig, &made);
  // Larger boots on the same bones may slide whatever is done to the clip as it is.
  const bool slides = same && walks && BendsKnees(*rig) && SlideOfWalk(*rig, made.clip) > kMostSlide;
  if ((!same || slides) && rig != nullptr && MakeClipRig(motion.skeleton, motion.told, clip, &source, &source_why)) {
    made = chosen.name == "walk" ? ClearLegs(*avatar_, source, clip, *rig) : Retarget(source, clip, *rig);
    if (chosen.name == "walk") walk_speed_ = made.walk_speed_mps;
    const bool led = chosen.name == "walk" || chosen.name == "idle" || chosen.name == "talk";
    if (led && !same) ClearHands(*avatar_, *rig, &made.clip);
  } else if (!same) {
    const int found = CopyClip(joints, clip, avatar_->joints, &made.clip);
    if (2 * found < Count(avatar_->joints)) {
      return Fail(
          "clip " + Quoted(motion.clip_names[chosen.index]) + " of " + motion.path + " does not fit: " +
          (rig == nullptr ? "the figure is no human skeleton, " + why : "it is for no human skeleton, " + source_why) +
          ", and only " + std::to_string(found) + " of " + std::to_string(avatar_->joints.size()) +
          " joints have names of its");
    }
  }
  if (const Clip* const walk = FindClip(*avatar_, "walk"); rig != nullptr && walk != nullptr) {
    if (clips_.shipped == chosen.file && Sits(*rig, *walk)) KeepSeated(*rig, *walk, &made.clip);
    if (!same || slides) TurnClip(HeadingOf(*rig, *walk), rig->joints, &made.clip);
  }
  made.clip.name = chosen.name;
  avatar_->clips.push_back(std::move(made.clip));
  return Ok();
}

// A person's only clip is no walk where its name says so or they stand in it. Who sits in it has wheels or hooves.
Error AvatarReader::JudgeLoneWalk(const Rig& rig) {
  const auto walk =
      std::find_if(clips_.clips.begin(), clips_.clips.end(), [](const ChosenClip& c) { return c.name == "walk"; });
  if (!clips_.lone_walk || walk == clips_.clips.end()) return Ok();
  Clip clip;
  std::string name, why;
  Rig source = rig;
  bool human = true;
  if (walk->file < 0) {
    const DocumentClip& own = document_.clips[walk->index];
    name = own.name;
    if (Error e = SampleClip(document_, own, avatar_->joints, joint_nodes_, to_metres_, &clip)) return e;
    DropRestPose(avatar_->joints, &clip);
  } else {
    const MotionFile& motion = At(clips_.files, walk->file);
    name = motion.clip_names[walk->index];
    if (Error e = ClipOf(motion, walk->index, &clip)) return e;
    DropRestPose(motion.skeleton.joints, &clip);
    human = MakeClipRig(motion.skeleton, motion.told, clip, &source, &why);
  }
  const bool named_otherwise = IsNoWalk(name);
  const bool own_sits = walk->file < 0 && Sits(rig, clip);
  if (own_sits || (!named_otherwise && (!human || !KeepsLegsStill(source, clip)))) return Ok();
  ClipChoice anew;
  anew.files = std::move(clips_.files);  // opened once
  anew.shipped = clips_.shipped;
  clips_ = std::move(anew);
  if (Error e = ChooseClips(document_, options_, named_otherwise ? LoneClip::kNone : LoneClip::kIdle, &clips_))
    return e;
  clips_.missing = Quoted(name) + (named_otherwise ? " is none by its name" : " moves no leg");
  return Ok();
}

// Who has no legs and no clips moves over the ground as they stand.
void AvatarReader::Glide() {
  Clip walk{"walk", 1, 2, {}};
  for (int k = 0; k < walk.keys; ++k) {
    for (const Joint& joint : avatar_->joints) walk.transforms.push_back(joint.rest);
  }
  avatar_->clips.insert(avatar_->clips.begin(), std::move(walk));
}

Error AvatarReader::AddClips() {
  Rig rig;
  std::string why;
  const bool human = MakeRig(*avatar_, Told(), &rig, &why);
  if (human) {
    if (Error e = JudgeLoneWalk(rig)) return e;
  }
  for (std::string& unused : UnusedFiles(options_, clips_)) notes_->push_back(std::move(unused));
  for (const ChosenClip& chosen : clips_.clips) {
    if (chosen.file < 0) {
      Clip clip;
      if (Error e =
              SampleClip(document_, document_.clips[chosen.index], avatar_->joints, joint_nodes_, to_metres_, &clip))
        return e;
      const bool walks = chosen.name == "walk";
      DropRestPose(avatar_->joints, &clip);
      if (clip.duration_s > (walks ? kLongestLoop_s : kLongestOwn_s))
        Shorten(Quoted(document_.clips[chosen.index].name), walks, avatar_->joints, &clip);
      clip.name = chosen.name;
      Retargeted own{std::move(clip)};
      if (human && walks && ToldSpeed() <= 0) PlantWalk(rig, &own);
      avatar_->clips.push_back(std::move(own.clip));
      continue;
    }
    const bool shipped = clips_.shipped == chosen.file;
    if (!human && clips_.shipped_walk && rig.humanoid.quadruped) {
      return Fail("no walk clip, and it goes on four legs: only its own clips make it walk; " + clips_.missing);
    }
    if (!human && shipped) continue;  // said below
    if (Error e = FitClip(chosen, human ? &rig : nullptr, why)) return e;
  }
  const Clip* const walk = FindClip(*avatar_, "walk");
  if (human && walk != nullptr && !clips_.shipped_walk && GoesBackwards(rig, *walk))
    notes_->push_back("the walk goes backwards: its soles push the ground ahead; name another clip as walk");
  if (walk == nullptr) {
    if (!document_.clips.empty())
      return Fail("no walk clip, and no legs that another could move (" + why + "); " + clips_.missing);
    notes_->push_back("it has no walk clip and no legs to walk with (" + why + "): it glides as it stands");
    Glide();
  } else if (clips_.shipped_walk) {
    notes_->push_back("it has no walk clip (" + clips_.missing + "): it walks by one that comes with Flaneur");
  } else if (clips_.shipped_idle && human) {
    notes_->push_back("it has no idle clip: it stands and talks by those that come with Flaneur");
  }
  return Ok();
}

void AvatarReader::DropUnusedMaterials() {
  std::vector<int> image_to(document_.images.size(), -1);
  const auto use_image = [&](int* image) {
    if (*image < 0) return;
    int& to = At(image_to, *image);
    if (to < 0) {
      to = Count(avatar_->images);
      avatar_->images.push_back(At(document_.images, *image));
    }
    *image = to;
  };
  std::map<std::pair<int, bool>, int>
      known;  // a material of the file, and whether there are uvs for its picture -> ours
  for (Mesh* const each : AllMeshes(avatar_)) {
    Mesh& mesh = *each;
    if (mesh.material < 0) continue;
    const auto [entry, fresh] = known.try_emplace({mesh.material, mesh.uvs.empty()}, Count(avatar_->materials));
    const int source = std::exchange(mesh.material, entry->second);
    if (!fresh) continue;
    Material material = At(document_.materials, source);
    if (mesh.uvs.empty() && material.base_color_image >= 0) {
      notes_->push_back("material " + Quoted(material.name) + ": its picture is left out, as its surface has no uvs");
      material.base_color_image = material.normal_image = -1;
    }
    use_image(&material.base_color_image);
    use_image(&material.normal_image);
    avatar_->materials.push_back(std::move(material));
  }
}

Error AvatarReader::Read() {
  if (Error e = CheckSkins(document_)) return e;
  if (Error e = ChooseClips(document_, options_, LoneClip::kWalk, &clips_)) return e;
  if (Error e = FindParts()) return e;
  if (Error e = FindJoints()) return e;
  FindBindPose();
  for (const Part& part : parts_) {
    if (Error e = AddPart(part)) return e;
  }
  for (const AvatarProp& prop : avatar_->props) {
    if (prop.meshes.empty()) return Fail("prop " + Quoted(prop.name) + " shows no mesh that hangs on a bone");
  }
  DropUnusedMaterials();
  WarnOfFullHands();
  if (std::string which; HasSecondPerson(avatar_->joints, &which)) {
    notes_->push_back("the file holds more than one person (" + Quoted(which) +
                      " is of another): hide all but one, see flaneur avatar --list");
  }
  if (IsHeadless(*avatar_, Told())) {
    notes_->push_back(
        "nothing hangs on the skeleton's head: where the file is an outfit, add the body as a further part "
        "([[avatar.part]])");
  }
  if (Error e = AddClips()) return e;
  if (unnormalized_ > 0) {
    notes_->push_back(std::to_string(unnormalized_) + " vertices had weights that do not sum to 1; they were scaled");
  }
  if (weightless_ > 0) {
    notes_->push_back(std::to_string(weightless_) + " vertices had no weight; they follow the skin's first joint");
  }
  NormalizeOptions normalize;
  normalize.height_m = options_.height_m;
  normalize.scale = options_.scale;
  normalize.up = options_.up;
  normalize.forward = options_.forward;
  normalize.told = Told();
  const bool own_walk = std::none_of(clips_.clips.begin(), clips_.clips.end(),
                                     [](const ChosenClip& clip) { return clip.name == "walk" && clip.file >= 0; });
  if (own_walk) normalize.walk_speed = ToldSpeed();
  if (walk_speed_ > 0) normalize.walk_speed = walk_speed_;
  const std::vector<FaceJoint> face = AddFaceJoints(face_, avatar_, notes_);
  if (Error e = NormalizeAvatar(normalize, body_, avatar_, notes_)) return e;
  MoveFace(face, avatar_);
  return Ok();
}

}  // namespace

namespace {

Error LoadPerson(const std::filesystem::path& path, GltfDocument* document, std::vector<std::string>* warnings) {
  TemporaryFolder folder;
  std::filesystem::path gltf = path;
  if (HasExtension(path, ".ply") || HasExtension(path, ".stl"))
    return Fail(path.string() +
                ": holds no skeleton; rig the figure first (Blender, Mixamo) and save it as glTF or FBX");
  if (NeedsBlender(path) || HasExtension(path, ".obj")) {
    if (Error e = ConvertToGltf(path, &folder, &gltf)) return e;
  }
  return LoadGltf(gltf, document, warnings, path);
}

}  // namespace

Error ReadAvatar(const std::filesystem::path& path, const ReadAvatarOptions& options, Avatar* avatar,
                 std::vector<std::string>* warnings) {
  GltfDocument document;
  if (Error e = LoadPerson(path, &document, warnings)) return e;
  for (const std::filesystem::path& file : options.parts) {
    GltfDocument part;
    if (Error e = LoadPerson(file, &part, warnings)) return e;
    if (Error e = JoinDocuments(std::move(part), &document)) return e;
  }
  JoinTwins(&document);
  *avatar = {};
  avatar->name = options.name.empty() ? path.stem().string() : options.name;
  std::vector<std::string> notes;
  if (Error e = AvatarReader(document, options, avatar, &notes).Read()) {
    return Fail(document.path + ": " + e.message);
  }
  for (const std::string& note : notes) warnings->push_back(document.path + ": " + note);
  return Ok();
}

}  // namespace flaneur
