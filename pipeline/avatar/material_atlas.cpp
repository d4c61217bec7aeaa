#include "pipeline/avatar/material_atlas.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "pipeline/avatar/atlas_picture.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

constexpr float kMerged_px =
    600;  // height of the person; larger ones show more than an atlas holds
constexpr float kMostRepeats = 4;      // of a picture, in each direction
constexpr float kTexelsAPixel = 1.5f;  // where a picture is stretched most
constexpr float kSparse = 0.1f;        // of the surface: so much may be stretched more
constexpr int kGutter_px = 8;          // stays clean down to the mip level of an eighth
constexpr int kLeastSide_px = 64, kMostSide_px = 1024;
constexpr float kShrink = 0.9f;     // of all pictures where they do not fit
constexpr float kSameTile = 1e-3f;  // uvs so little below 0 still count as the tile above

struct Rect {
  Vec2 min{1e9f, 1e9f}, max{-1e9f, -1e9f};
};

// One mesh of each level, and where its picture goes.
struct Member {
  size_t mesh = 0;
  Material material;
  std::optional<Picture> picture;                // none: the base colour alone
  Rect used;                                     // of the picture, uv
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
    mesh->uvs[v] =
        mesh->uvs[v] - Vec2{std::floor(min.x + kSameTile), std::floor(min.y + kSameTile)};
  }
}

void Include(const Mesh& mesh, Rect* rect) {
  for (const uint32_t i : mesh.indices) {
    const Vec2 uv = mesh.uvs[i];
    rect->min = {std::min(rect->min.x, uv.x), std::min(rect->min.y, uv.y)};
    rect->max = {std::max(rect->max.x, uv.x), std::max(rect->max.y, uv.y)};
  }
}

// Texels a metre where only the share kSparse of the surface has fewer.
float TexelsPerMetre(const Mesh& mesh, const Picture& picture) {
  std::vector<std::pair<float, float>> by_density;  // with the area
  float total = 0;
  const Vec2 size{static_cast<float>(picture.width), static_cast<float>(picture.height)};
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const auto at = [&](size_t k) { return mesh.positions[mesh.indices[i + k]]; };
    const auto texel = [&](size_t k) {
      const Vec2 uv = mesh.uvs[mesh.indices[i + k]];
      return Vec2{uv.x * size.x, uv.y * size.y};
    };
    const float area = Length(Cross(at(1) - at(0), at(2) - at(0)));
    const Vec2 a = texel(1) - texel(0), b = texel(2) - texel(0);
    const float texels = std::abs(a.x * b.y - a.y * b.x);
    if (!(area > 0)) continue;
    by_density.push_back({std::sqrt(texels / area), area});
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
      const bool fits = member.material.double_sided == double_sided &&
                        (member.material.alpha == Material::Alpha::kBlend) == blended;
      if (fits && Anything(m) && Prepare(&member)) members_.push_back(std::move(member));
    }
    if (members_.size() < 2) return;
    int side_px = kLeastSide_px;
    for (float share = 1; !Pack(side_px, share);) {
      if (side_px < kMostSide_px)
        side_px *= 2;
      else
        share *= kShrink;
    }
    const int material = AddMaterial(Painted(side_px));
    for (size_t k = first_; k < levels_->levels.size(); ++k) {
      Join(material, side_px, &levels_->levels[k].meshes);
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
    member->picture = Decoded(levels_->avatar.images[static_cast<size_t>(image)]);
    if (!member->picture) return Refuse(*member, "has a picture that cannot be decoded");
    for (size_t k = first_; k < levels_->levels.size(); ++k) {
      Mesh shifted = levels_->levels[k].meshes[member->mesh];
      ShiftToFirstTile(&shifted);
      Include(shifted, &member->used);
    }
    const Vec2 size = member->used.max - member->used.min;
    if (!(size.x <= kMostRepeats && size.y <= kMostRepeats)) {
      return Refuse(*member, "repeats its picture more than four times");
    }
    member->texels_per_m =
        TexelsPerMetre(levels_->levels[first_].meshes[member->mesh], *member->picture);
    return true;
  }

  bool Refuse(const Member& member, const std::string& why) {
    warnings_->push_back("avatar '" + OneLine(levels_->avatar.name) + "': material '" +
                         OneLine(member.material.name) + "' " + why +
                         " and keeps apart at coarser levels");
    return false;
  }

  float WantedTexelsPerMetre() const {
    return kTexelsAPixel * std::min(levels_->levels[first_ - 1].switch_px, kMerged_px) /
           levels_->avatar.height_m;
  }

  void Scale(float share, Member* member) const {
    if (!member->picture) return;
    const float wanted = WantedTexelsPerMetre();
    const float scale =
        share * (member->texels_per_m > wanted ? wanted / member->texels_per_m : 1.0f);
    const auto scaled = [scale](int px) {
      return std::max(1, static_cast<int>(std::lround(scale * static_cast<float>(px))));
    };
    member->width_px = scaled(member->picture->width);
    member->height_px = scaled(member->picture->height);
    const auto w = static_cast<float>(member->width_px), h = static_cast<float>(member->height_px);
    member->left = static_cast<int>(std::floor(member->used.min.x * w));
    member->top = static_cast<int>(std::floor(member->used.min.y * h));
    member->columns = static_cast<int>(std::ceil(member->used.max.x * w)) - member->left;
    member->rows = static_cast<int>(std::ceil(member->used.max.y * h)) - member->top;
    member->columns = std::max(member->columns, 1);
    member->rows = std::max(member->rows, 1);
  }

  // On shelves, the highest first. False where the side is too small.
  bool Pack(int side_px, float share) {
    std::vector<Member*> order;
    for (Member& member : members_) {
      Scale(share, &member);
      order.push_back(&member);
    }
    std::stable_sort(order.begin(), order.end(),
                     [](const Member* a, const Member* b) { return a->rows > b->rows; });
    int x = 0, y = 0, shelf = 0;
    for (Member* member : order) {
      const int width = member->columns + 2 * kGutter_px, height = member->rows + 2 * kGutter_px;
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

  Picture Painted(int side_px) const {
    Picture atlas = Blank(side_px, side_px);
    for (const Member& m : members_) {
      const Picture whole = Tinted(m.picture ? *m.picture : Blank(1, 1), m.material);
      CopyRepeated(Resized(whole, m.width_px, m.height_px),
                   {m.left - kGutter_px, m.top - kGutter_px}, {m.x - kGutter_px, m.y - kGutter_px},
                   {m.columns + 2 * kGutter_px, m.rows + 2 * kGutter_px}, &atlas);
    }
    return atlas;
  }

  int AddMaterial(const Picture& atlas) {
    Avatar& avatar = levels_->avatar;
    Material merged;
    merged.name = "atlas";
    merged.double_sided = members_[0].material.double_sided;
    merged.alpha = members_[0].material.alpha;
    merged.metallic = merged.roughness = 0;
    const auto count = static_cast<float>(members_.size());
    for (const Member& member : members_) {
      merged.metallic += member.material.metallic / count;
      merged.roughness += member.material.roughness / count;
      if (member.material.alpha == Material::Alpha::kMask) merged.alpha = Material::Alpha::kMask;
    }
    merged.base_color_image = static_cast<int>(avatar.images.size());
    avatar.images.push_back(Encoded(atlas, merged.alpha != Material::Alpha::kOpaque));
    avatar.images.back().name = merged.name;
    avatar.materials.push_back(merged);
    return static_cast<int>(avatar.materials.size()) - 1;
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
      uv.x = (uv.x * static_cast<float>(member.width_px) +
              static_cast<float>(member.x - member.left)) /
             side;
      uv.y = (uv.y * static_cast<float>(member.height_px) +
              static_cast<float>(member.y - member.top)) /
             side;
    }
    return moved;
  }

  void Join(int material, int side_px, std::vector<Mesh>* meshes) const {
    Mesh joined;
    joined.name = "merged";
    joined.material = material;
    const bool colored = std::any_of(members_.begin(), members_.end(), [&](const Member& member) {
      return !(*meshes)[member.mesh].colors.empty();
    });
    for (const Member& member : members_) {
      Mesh& mesh = (*meshes)[member.mesh];
      Mesh part = Moved(member, side_px, mesh);
      if (colored) part.colors.resize(part.positions.size(), {1, 1, 1, 1});
      const auto base = static_cast<uint32_t>(joined.positions.size());
      const auto append = [](const auto& from, auto* to) {
        to->insert(to->end(), from.begin(), from.end());
      };
      append(part.positions, &joined.positions);
      append(part.normals, &joined.normals);
      append(part.uvs, &joined.uvs);
      append(part.colors, &joined.colors);
      append(part.joints, &joined.joints);
      append(part.weights, &joined.weights);
      for (const uint32_t i : part.indices) joined.indices.push_back(base + i);
      mesh = {};
    }
    (*meshes)[members_[0].mesh] = std::move(joined);
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
