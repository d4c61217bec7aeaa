// The root extension FLANEUR_tour as JSON. Internal to pipeline/pack.
#pragma once
#include <string>
#include <vector>

#include "pipeline/io/gltf_builder.h"
#include "pipeline/pack/write_tour_pack.h"

namespace flaneur {

// An impostor's buffer views.
struct ImpostorViews {
  int cells = -1, albedo = -1, normal = -1, depth = -1, motion = -1, tints = -1;
};

// Where the glTF part of the pack put what the extension refers to.
struct TourIndices {
  std::vector<AvatarPart> avatars;
  std::vector<ImpostorViews> impostors;  // one an avatar
  int height_view = -1, kind_view = -1;
  int people_view = -1, loiter_view = -1;             // -1: no painting
  std::vector<int> sounds;                            // views, by sound
  int title_picture_view = -1, title_logo_view = -1;  // -1: none
  std::vector<int> pictures;                          // views, by picture
};

std::string TourJson(const TourParts& parts, const TourIndices& indices);

}  // namespace flaneur
