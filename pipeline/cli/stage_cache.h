// What a step made as one text, and back. The text is no format: the program that wrote it reads it again.
#pragma once
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "pipeline/core/avatar.h"
#include "pipeline/core/footprint.h"
#include "pipeline/core/impostor.h"
#include "pipeline/core/report.h"
#include "pipeline/pack/write_tour_pack.h"
#include "runtime/tour_data/tour_data.h"

namespace flaneur {

// The fields of each kind of struct, listed once for writing and reading.
template <typename A>
void Fields(A& a, Image* v) {
  a(&v->name, &v->mime_type, &v->bytes);
}
template <typename A>
void Fields(A& a, Material* v) {
  a(&v->name, &v->base_color, &v->base_color_image, &v->normal_image, &v->metallic, &v->roughness, &v->double_sided,
    &v->alpha, &v->alpha_cutoff, &v->tints);
}
template <typename A>
void Fields(A& a, Mesh* v) {
  a(&v->name, &v->material, &v->positions, &v->normals, &v->uvs, &v->uvs1, &v->colors, &v->joints, &v->weights,
    &v->indices);
}
template <typename A>
void Fields(A& a, Joint* v) {
  a(&v->name, &v->parent, &v->rest, &v->inverse_bind);
}
template <typename A>
void Fields(A& a, Clip* v) {
  a(&v->name, &v->duration_s, &v->keys, &v->transforms);
}
template <typename A>
void Fields(A& a, AvatarProp* v) {
  a(&v->name, &v->meshes);
}
template <typename A>
void Fields(A& a, Avatar* v) {
  a(&v->name, &v->meshes, &v->materials, &v->images, &v->joints, &v->clips, &v->props, &v->height_m, &v->radius_m,
    &v->walk_speed_mps);
}
template <typename A>
void Fields(A& a, AvatarLevel* v) {
  a(&v->meshes, &v->triangles, &v->error_mm, &v->posed_error_mm, &v->normal_deg, &v->joints, &v->switch_px);
}
template <typename A>
void Fields(A& a, AvatarLevels* v) {
  a(&v->avatar, &v->levels);
}
template <typename A>
void Fields(A& a, ImpostorClip* v) {
  a(&v->name, &v->first_frame, &v->phases);
}
template <typename A>
void Fields(A& a, ImpostorAtlas* v) {
  a(&v->directions, &v->elevations_deg, &v->frames, &v->width_px, &v->height_px, &v->texel_m, &v->depth_range_m,
    &v->motion_range_m, &v->bend_range_m, &v->clips, &v->cells, &v->albedo, &v->normal, &v->albedo_ktx2,
    &v->normal_ktx2, &v->depth_ktx2, &v->motion_ktx2, &v->tint_regions, &v->tints, &v->tints_ktx2);
}
template <typename A>
void Fields(A& a, Obstacle* v) {
  a(&v->name, &v->kind, &v->source, &v->clearance_m, &v->ground_z_m, &v->open_shell, &v->outer, &v->holes, &v->center,
    &v->radius_m);
}
template <typename A>
void Fields(A& a, Footprints* v) {
  a(&v->clearance_m, &v->tolerance_m, &v->band_m, &v->origin_m, &v->reference_system, &v->obstacles);
}
template <typename A>
void Fields(A& a, GroundRaster* v) {
  a(&v->min_m, &v->cell_m, &v->columns, &v->rows, &v->height_m, &v->kind);
}
template <typename A>
void Fields(A& a, Place* v) {
  a(&v->name, &v->kind, &v->position_m, &v->width_m, &v->yaw_rad, &v->clip, &v->avatars, &v->seat_m, &v->stay_s,
    &v->people);
}
template <typename A>
void Fields(A& a, Street* v) {
  a(&v->names, &v->points);
}
template <typename A>
void Fields(A& a, ReportFinding* v) {
  a(&v->code, &v->severity, &v->title, &v->feature, &v->message, &v->advice, &v->at_m);
}
template <typename A>
void Fields(A& a, DracoMesh* v) {
  a(&v->bytes, &v->position, &v->normal, &v->uv, &v->uv1, &v->color, &v->joints, &v->weights, &v->vertices,
    &v->triangles, &v->min, &v->max);
}
template <typename A>
void Fields(A& a, EncodedPart* v) {
  a(&v->material, &v->draco, &v->mesh);
}
template <typename A>
void Fields(A& a, EncodedMesh* v) {
  a(&v->compressed, &v->byte_joints, &v->parts);
}
template <typename A>
void Fields(A& a, KeyChannel* v) {
  a(&v->joint, &v->path, &v->knots, &v->times, &v->values, &v->rounded);
}
template <typename A>
void Fields(A& a, EncodedAvatar* v) {
  a(&v->levels, &v->props, &v->clips);
}
template <typename A>
void Fields(A& a, EncodedTown::Node* v) {
  a(&v->name, &v->mesh, &v->transform, &v->extras);
}
template <typename A>
void Fields(A& a, EncodedTown* v) {
  a(&v->materials, &v->images, &v->nodes, &v->meshes);
}
template <typename A>
void Fields(A& a, AvatarPart* v) {
  a(&v->skin, &v->skeleton_node, &v->joint_nodes, &v->level_nodes, &v->prop_nodes, &v->animations, &v->materials);
}
template <typename A>
void Fields(A& a, TourIndices* v) {
  a(&v->avatars, &v->impostors, &v->height_view, &v->kind_view, &v->people_view, &v->loiter_view,
    &v->title_picture_view, &v->title_logo_view, &v->sounds, &v->pictures);
}
template <typename A>
void Fields(A& a, TourModels* v) {
  a(&v->glb, &v->indices);
}
template <typename A>
void Fields(A& a, StageReport* v) {
  a(&v->figures, &v->levels, &v->picture_png);
}
template <typename A, typename F, typename S>
void Fields(A& a, std::pair<F, S>* v) {
  a(&v->first, &v->second);
}

class StageWriter {
 public:
  template <typename... T>
  void operator()(T*... values) {
    (Put(values), ...);
  }
  const std::string& text() const { return text_; }

 private:
  template <typename T>
  void Put(T* value) {
    if constexpr (std::is_trivially_copyable_v<T>) Raw(value, sizeof(T));
    else Fields(*this, value);
  }
  void Put(std::string* value) { PutSize(value->size()), Raw(value->data(), value->size()); }
  template <typename T>
  void Put(std::vector<T>* values) {
    PutSize(values->size());
    if constexpr (std::is_trivially_copyable_v<T>) Raw(values->data(), values->size() * sizeof(T));
    else
      for (T& value : *values) Put(&value);
  }
  template <typename K, typename V>
  void Put(std::map<K, V>* values) {
    std::vector<std::pair<K, V>> pairs(values->begin(), values->end());
    Put(&pairs);
  }
  void PutSize(uint64_t size) { Raw(&size, sizeof size); }
  void Raw(const void* data, size_t size) { text_.append(static_cast<const char*>(data), size); }

  std::string text_;
};

class StageReader {
 public:
  explicit StageReader(std::string_view text) : text_(text) {}
  template <typename... T>
  void operator()(T*... values) {
    (Get(values), ...);
  }
  bool whole() const { return good_ && text_.empty(); }

 private:
  template <typename T>
  void Get(T* value) {
    if constexpr (std::is_trivially_copyable_v<T>) Raw(value, sizeof(T));
    else Fields(*this, value);
  }
  void Get(std::string* value) {
    value->resize(Size(1));
    Raw(value->data(), value->size());
  }
  template <typename T>
  void Get(std::vector<T>* values) {
    constexpr bool kRaw = std::is_trivially_copyable_v<T>;
    const size_t count = Size(kRaw ? sizeof(T) : 1);
    if constexpr (kRaw && sizeof(T) == 1) {  // a whole pack may be in it: not set to zero first
      const auto* bytes = reinterpret_cast<const T*>(text_.data());
      values->assign(bytes, bytes + count);
      text_.remove_prefix(count);
    } else {
      values->resize(count);
      if constexpr (kRaw) Raw(values->data(), count * sizeof(T));
      else
        for (T& value : *values) Get(&value);
    }
  }
  template <typename K, typename V>
  void Get(std::map<K, V>* values) {
    std::vector<std::pair<K, V>> pairs;
    Get(&pairs);
    *values = {pairs.begin(), pairs.end()};
  }
  // How many elements of at least so many bytes follow.
  size_t Size(size_t bytes) {
    uint64_t size = 0;
    Raw(&size, sizeof size);
    good_ = good_ && size <= text_.size() / bytes;
    return good_ ? static_cast<size_t>(size) : 0;
  }
  void Raw(void* data, size_t size) {
    good_ = good_ && size <= text_.size();
    if (!good_ || size == 0) return;
    std::memcpy(data, text_.data(), size);
    text_.remove_prefix(size);
  }

  std::string_view text_;
  bool good_ = true;
};

// All of them in one text, and back. Whether the text held just that; else nothing is changed.
template <typename... Parts>
std::string Packed(Parts*... parts) {
  StageWriter writer;
  writer(parts...);
  return writer.text();
}
template <typename... Parts>
bool Unpacked(const std::string& text, Parts*... parts) {
  std::tuple<Parts...> read;
  StageReader reader(text);
  std::apply([&](Parts&... values) { reader(&values...); }, read);
  if (!reader.whole()) return false;
  std::tie(*parts...) = std::move(read);
  return true;
}

}  // namespace flaneur
