#include "pipeline/avatar/material_atlas.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

#include "pipeline/avatar/atlas_picture.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

constexpr float kMerged_px = 600;  // height of the person; larger ones show more than an atlas holds
constexpr float kMaxRepeats = 4;   // of a picture, in each direction
constexpr float kSparse = 0.1f;    // of the surface: so much may be stretched more
constexpr int kGutter_px = 16;     // stays clean down to the mip level of a sixteenth
constexpr int kAlign_px = 16;      // so that mip levels stay what they were
constexpr int kMinSide_px = 64, kMaxSide_px = 1024;
constexpr float kSameTile = 1e-3f;  // uvs so little below 0 still count as the tile above

struct Rect {
  Vec2 min{1e9f, 1e9f}, max{-1e9f, -1e9f};
};

// One mesh of each level, and where its picture goes.
struct Member {
  size_t mesh = 0;
  Material material;
  std::optional<Pixels> picture;                 // none: the base colour alone
  Rect used;                                     // of the picture, uv
  int halvings = 0;                              // as a mip level
  float texels_per_m = 0;                        // of the picture, where it is stretched most
  int width_px = 1, height_px = 1;               // of the whole picture as it goes into the atlas
  int left = 0, top = 0, columns = 1, rows = 1;  // of the part used; left and top in the picture
  int x = 0, y = 0;                              // in the atlas, without the gutter
};

Material MaterialOf(const Avatar& avatar, const Mesh& mesh) {
  return mesh.material < 0 ? Material{} : avatar.materials[static_cast<size_t>(mesh.material)];
}

// Moves every connected part by whole tiles to where its picture begins.
void ShiftToFirstTile(Mesh* mesh) {
  std::vector<uint32_t> parent(mesh->positions.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&parent](uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (size_t i = 0; i + 2 < mesh->indices.size(); i += 3) {
    parent[root(mesh->indices[i])] = root(mesh->indices[i + 1]);
    parent[root(mesh->indices[i + 1])] = root(mesh->indices[i + 2]);
  }
  std::vector<Vec2> least(parent.size(), {1e9f, 1e9f});
  for (uint32_t v = 0; v < parent.size(); ++v) {
    Vec2& min = least[root(v)];
    min = {std::min(min.x, mesh->uvs[v].x), std::min(min.y, mesh->uvs[v].y)};
  }
  for (uint32_t v = 0; v < parent.size(); ++v) {
    const Vec2 min = least[root(v)];
    mesh->uvs[v] = mesh->uvs[v] - Vec2{std::floor(min.x + kSameTile), std::floor(min.y + kSameTile)};
  }
}

void Include(const Mesh& mesh, Rect* rect) {
  for (const uint32_t i : mesh.indices) {
    const Vec2 uv = mesh.uvs[i];
    rect->min = {std::min(rect->min.x, uv.x), std::min(rect->min.y, uv.y)};
    rect->max = {std::max(rect->max.x, uv.x), std::max(rect->max.y, uv.y)};
  }
}

// Texels a metre of the triangle's surface in the direction that it has fewest in; its sides in
// metres and in texels.
float FewestTexelsPerMetre(Vec3 p, Vec3 q, Vec2 a, Vec2 b) {
  const float along = Length(p), height = Length(Cross(p, q)) / along, shift = Dot(p, q) / along;
  // Texels by metres along the first side and across it.
  const Vec2 x = a * (1 / along), y = (b - x * shift) * (1 / height);
  const float sum = Dot(x, x) + Dot(y, y), area = x.x * y.y - x.y * y.x;
  const float greatest2 = (sum + std::sqrt(std::max(sum * sum - 4 * area * area, 0.0f))) / 2;
  return greatest2 > 0 ? std::abs(area) / std::sqrt(greatest2) : 0;
}

// The same where only the share kSparse of the surface has fewer.
float TexelsPerMetre(const Mesh& mesh, const Pixels& picture) {
  std::vector<std::pair<float, float>> by_density;  // with the area
  float total = 0;
  const Vec2 size{static_cast<float>(picture.width), static_cast<float>(picture.height)};
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const uint32_t* corner = &mesh.indices[i];
    const auto side = [&](size_t k) { return mesh.positions[corner[k]] - mesh.positions[corner[0]]; };
    const auto texels = [&](size_t k) {
      const Vec2 uv = mesh.uvs[corner[k]] - mesh.uvs[corner[0]];
      return Vec2{uv.x * size.x, uv.y * size.y};
    };
    const float area = Length(Cross(side(1), side(2)));
    if (!(area > 0)) continue;
    by_density.push_back({FewestTexelsPerMetre(side(1), side(2), texels(1), texels(2)), area});
    total += area;
  }
  std::sort(by_density.begin(), by_density.end());
  float sum = 0;
  for (const auto& [density, area] : by_density) {
    sum += area;
    if (sum > kSparse * total) return density;
  }
  return 0;
}

class Merger {
 public:
  Merger(AvatarLevels* levels, size_t first, std::vector<std::string>* warnings)
      : levels_(levels), first_(first), warnings_(warnings) {}

  // All meshes whose materials agree in sides and blending.
  void Merge(bool double_sided, bool blended) {
    members_.clear();
    const std::vector<Mesh>& meshes = levels_->avatar.meshes;
    for (size_t m = 0; m < meshes.size(); ++m) {
      Member member;
      member.mesh = m;
      member.material = MaterialOf(levels_->avatar, meshes[m]);
      const bool fits =
          member.material.double_sided == double_sided && (member.material.alpha == Material::Alpha::kBlend) == blended;
      if (fits && Anything(m) && Prepare(&member)) members_.push_back(std::move(member));
    }
    if (members_.size() < 2) return;
    const int side_px = FitIn();
    const int image = AddImage(Painted(side_px));
    std::set<uint8_t> tints;
    for (const Member& member : members_) tints.insert(member.material.tints);
    for (const uint8_t dyed_alike : tints) {
      const int material = AddMaterial(image, dyed_alike);
      for (size_t k = first_; k < levels_->levels.size(); ++k) {
        Join(material, dyed_alike, side_px, &levels_->levels[k].meshes);
      }
    }
  }

 private:
  bool Anything(size_t mesh) const {
    for (size_t k = first_; k < levels_->levels.size(); ++k) {
      if (!levels_->levels[k].meshes[mesh].indices.empty()) return true;
    }
    return false;
  }

  // False where the material has to keep apart.
  bool Prepare(Member* member) {
    const int image = member->material.base_color_image;
    if (image < 0 || levels_->avatar.meshes[member->mesh].uvs.empty()) return true;
    member->picture = Decoded(levels_->avatar.images[static_cast<size_t>(image)].bytes);
    if (!member->picture) return Refuse(*member, "has a picture that cannot be decoded");
    for (size_t k = first_; k < levels_->levels.size(); ++k) {
      Mesh shifted = levels_->levels[k].meshes[member->mesh];
      ShiftToFirstTile(&shifted);
      Include(shifted, &member->used);
    }
    const Vec2 size = member->used.max - member->used.min;
    if (!(size.x <= kMaxRepeats && size.y <= kMaxRepeats)) {
      return Refuse(*member, "repeats its picture more than four times");
    }
    member->texels_per_m = TexelsPerMetre(levels_->levels[first_].meshes[member->mesh], *member->picture);
    return true;
  }

  bool Refuse(const Member& member, const std::string& why) {
    warnings_->push_back("avatar '" + OneLine(levels_->avatar.name) + "': material '" + OneLine(member.material.name) +
                         "' " + why + " and keeps apart at coarser levels");
    return false;
  }

  float WantedTexelsPerMetre() const {
    return std::min(levels_->levels[first_ - 1].switch_px, kMerged_px) / levels_->avatar.height_m;
  }

  // Texels a pixel where the picture is stretched most.
  float Excess(const Member& member) const {
    return std::ldexp(member.texels_per_m / WantedTexelsPerMetre(), -member.halvings);
  }

  // As large as wanted or, where that is too much, as there is room for; returns the side.
  int FitIn() {
    for (Member& member : members_) {
      while (member.picture && Excess(member) > 2) ++member.halvings;
    }
    int side_px = kMinSide_px;
    while (!Pack(side_px) && side_px < kMaxSide_px) side_px *= 2;
    while (!Pack(side_px)) {
      ++std::max_element(members_.begin(), members_.end(), [&](const Member& a, const Member& b) {
          return std::pair(a.columns > 1, Excess(a)) < std::pair(b.columns > 1, Excess(b));
        })->halvings;
    }
    for (Member& member : members_) {  // what room is left makes them finer
      while (member.halvings > 0) {
        --member.halvings;
        if (Pack(side_px)) continue;
        ++member.halvings;
        break;
      }
    }
    Pack(side_px);
    return side_px;
  }

  // Its size, and which part is used; from multiples of kAlign_px, so that mip levels stay the
  // same.
  static void Measure(Member* member) {
    if (!member->picture) return;
    member->width_px = std::max(1, member->picture->width >> member->halvings);
    member->height_px = std::max(1, member->picture->height >> member->halvings);
    const auto w = static_cast<float>(member->width_px), h = static_cast<float>(member->height_px);
    member->left = Down(member->used.min.x * w);
    member->top = Down(member->used.min.y * h);
    member->columns = std::max(1, static_cast<int>(std::ceil(member->used.max.x * w)) - member->left);
    member->rows = std::max(1, static_cast<int>(std::ceil(member->used.max.y * h)) - member->top);
  }

  static int Down(float px) { return kAlign_px * static_cast<int>(std::floor(px / static_cast<float>(kAlign_px))); }

  static int Up(int px) { return (px + kAlign_px - 1) / kAlign_px * kAlign_px; }

  // On shelves, the highest first. False where the side is too small.
  bool Pack(int side_px) {
    std::vector<Member*> order;
    for (Member& member : members_) {
      Measure(&member);
      order.push_back(&member);
    }
    std::stable_sort(order.begin(), order.end(), [](const Member* a, const Member* b) { return a->rows > b->rows; });
    int x = 0, y = 0, shelf = 0;
    for (Member* member : order) {
      const int width = Up(member->columns + 2 * kGutter_px);
      const int height = Up(member->rows + 2 * kGutter_px);
      if (x + width > side_px) {
        x = 0;
        y += shelf;
        shelf = 0;
      }
      if (width > side_px || y + height > side_px) return false;
      member->x = x + kGutter_px;
      member->y = y + kGutter_px;
      x += width;
      shelf = std::max(shelf, height);
    }
    return true;
  }

  Pixels Painted(int side_px) const {
    std::vector<Pixels> parts;
    for (const Member& m : members_) {
      const Pixels whole = TimesBaseColor(m.picture ? *m.picture : Blank(1, 1), m.material);
      parts.push_back(Resized(whole, m.width_px, m.height_px));
    }
    // The coarsest mip levels reach beyond the gutters: nothing there may stand out.
    Pixels atlas = Resized(Resized(parts[0], 1, 1), side_px, side_px);
    for (size_t i = 0; i < parts.size(); ++i) {
      const Member& m = members_[i];
      CopyRepeated(parts[i], {m.left - kGutter_px, m.top - kGutter_px}, {m.x - kGutter_px, m.y - kGutter_px},
                   {m.columns + 2 * kGutter_px, m.rows + 2 * kGutter_px}, &atlas);
    }
    return atlas;
  }

  int AddImage(const Pixels& atlas) {
    std::vector<Image>& images = levels_->avatar.images;
    const bool opaque = std::none_of(members_.begin(), members_.end(), [](const Member& member) {
      return member.material.alpha != Material::Alpha::kOpaque;
    });
    images.push_back(Encoded(atlas, !opaque));
    images.back().name = "atlas";
    return static_cast<int>(images.size()) - 1;
  }

  // All that show the atlas differ in nothing but what dyes them.
  int AddMaterial(int image, uint8_t tints) {
    Material merged;
    merged.name = "atlas";
    merged.tints = tints;
    merged.double_sided = members_[0].material.double_sided;
    merged.alpha = members_[0].material.alpha;
    merged.metallic = merged.roughness = 0;
    const auto count = static_cast<float>(members_.size());
    for (const Member& member : members_) {
      merged.metallic += member.material.metallic / count;
      merged.roughness += member.material.roughness / count;
      if (member.material.alpha == Material::Alpha::kMask) merged.alpha = Material::Alpha::kMask;
    }
    merged.base_color_image = image;
    levels_->avatar.materials.push_back(merged);
    return static_cast<int>(levels_->avatar.materials.size()) - 1;
  }

  // The member's vertices with their uvs in the atlas.
  static Mesh Moved(const Member& member, int side_px, const Mesh& mesh) {
    Mesh moved = mesh;
    if (member.picture) {
      ShiftToFirstTile(&moved);
    } else {
      moved.uvs.assign(moved.positions.size(), {0.5f, 0.5f});
    }
    const auto side = static_cast<float>(side_px);
    for (Vec2& uv : moved.uvs) {
      uv.x = (uv.x * static_cast<float>(member.width_px) + static_cast<float>(member.x - member.left)) / side;
      uv.y = (uv.y * static_cast<float>(member.height_px) + static_cast<float>(member.y - member.top)) / side;
    }
    return moved;
  }

  // The members that are dyed alike.
  void Join(int material, uint8_t tints, int side_px, std::vector<Mesh>* meshes) const {
    Mesh joined;
    joined.name = "merged";
    joined.material = material;
    const bool colored = std::any_of(members_.begin(), members_.end(),
                                     [&](const Member& member) { return !(*meshes)[member.mesh].colors.empty(); });
    size_t place = 0;
    for (const Member& member : members_) {
      if (member.material.tints != tints) continue;
      place = member.mesh;
      Mesh& mesh = (*meshes)[member.mesh];
      Mesh part = Moved(member, side_px, mesh);
      if (colored) part.colors.resize(part.positions.size(), {1, 1, 1, 1});
      const auto base = static_cast<uint32_t>(joined.positions.size());
      const auto append = [](const auto& from, auto* to) { to->insert(to->end(), from.begin(), from.end()); };
      append(part.positions, &joined.positions);
      append(part.normals, &joined.normals);
      append(part.uvs, &joined.uvs);
      append(part.colors, &joined.colors);
      append(part.joints, &joined.joints);
      append(part.weights, &joined.weights);
      for (const uint32_t i : part.indices) joined.indices.push_back(base + i);
      mesh = {};
    }
    (*meshes)[place] = std::move(joined);
  }

  AvatarLevels* levels_;
  size_t first_;  // level whose materials merge
  std::vector<std::string>* warnings_;
  std::vector<Member> members_;
};

}  // namespace

void MergeMaterials(AvatarLevels* levels, std::vector<std::string>* warnings) {
  size_t first = 1;
  while (first < levels->levels.size() && levels->levels[first - 1].switch_px > kMerged_px) ++first;
  if (first >= levels->levels.size()) return;
  Merger merger(levels, first, warnings);
  for (const bool double_sided : {false, true}) {
    for (const bool blended : {false, true}) merger.Merge(double_sided, blended);
  }
  for (size_t k = first; k < levels->levels.size(); ++k) {
    std::erase_if(levels->levels[k].meshes, [](const Mesh& mesh) { return mesh.indices.empty(); });
  }
}

}  // namespace flaneur
