// A small made-up tour to draw: a wall, and a person who is a box, as a mesh and as an impostor.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "runtime/desktop/context.h"
#include "runtime/render/renderer.h"

namespace flaneur {

inline constexpr int kWidth = 320, kHeight = 180;

// A box on the ground (glTF axes), every face a quad with its own normal; skinned to joint 0.
inline PackPrimitive BoxPrimitive(Vec3 low, Vec3 high, int material, bool skinned) {
  PackPrimitive p;
  p.material = material;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      const auto first = static_cast<uint32_t>(p.positions.size());
      for (int corner = 0; corner < 4; ++corner) {
        float c[3];
        c[axis] = static_cast<float>(side);
        c[(axis + 1) % 3] = corner == 1 || corner == 2 ? 1.0f : 0.0f;
        c[(axis + 2) % 3] = corner >= 2 ? 1.0f : 0.0f;
        float n[3] = {0, 0, 0};
        n[axis] = side == 1 ? 1.0f : -1.0f;
        p.positions.push_back(
            {low.x + c[0] * (high.x - low.x), low.y + c[1] * (high.y - low.y), low.z + c[2] * (high.z - low.z)});
        p.normals.push_back({n[0], n[1], n[2]});
      }
      const std::array<uint32_t, 6> forward{0, 1, 2, 0, 2, 3}, backward{0, 2, 1, 0, 3, 2};
      for (uint32_t i : side == 1 ? forward : backward) p.indices.push_back(first + i);
    }
  }
  if (skinned) {
    p.joints.assign(p.positions.size(), {0, 0, 0, 0});
    p.weights.assign(p.positions.size(), {255, 0, 0, 0});
  }
  return p;
}

// A picture of one colour. BC7: even values, by mode 6 with both ends alike.
inline PackTexture Flat(TextureFormat format, int width, int height, std::vector<uint8_t> color) {
  std::vector<uint8_t> block(BlockBytes(format), 0);
  if (format == TextureFormat::kBc7 || format == TextureFormat::kBc7Srgb) {
    size_t at = 0;
    const auto put = [&](int value, int bits) {
      for (int i = 0; i < bits; ++i, ++at) block[at / 8] |= static_cast<uint8_t>((value >> i & 1) << at % 8);
    };
    put(1 << 6, 7);
    for (uint8_t c : color) put(c >> 1, 7), put(c >> 1, 7);
  } else {
    for (size_t c = 0; c < color.size(); ++c) block[8 * c] = block[8 * c + 1] = color[c];
  }
  PackTexture texture{format, width, height, {{}}};
  for (size_t i = 0; i < LevelBytes(format, width, height) / block.size(); ++i) {
    texture.levels[0].insert(texture.levels[0].end(), block.begin(), block.end());
  }
  return texture;
}

inline PackAvatar BoxPerson() {
  PackAvatar a;
  a.name = "box";
  a.joints = 1;
  a.walk = a.idle = a.talk = {1, 1, {Mat4{}}};
  a.levels = {{0, 12, 0, 0, 100}, {0, 12, 0, 0, 0}};
  // Four times the same picture: 0.5 m wide, 1.8 m high, its front 0.25 m before the axis.
  PackImpostor& atlas = a.impostor;
  atlas.directions = 4;
  atlas.frames = 1;
  atlas.elevations_deg = {0};
  atlas.width_px = 128;
  atlas.height_px = 96;
  atlas.texel_m = 1.8f / 72;
  atlas.depth_range_m = 0.5f;
  atlas.motion_range_m = atlas.bend_range_m = 0.1f;
  atlas.clips = {{"walk", 0, 1}};
  for (int16_t d = 0; d < 4; ++d)
    atlas.cells.push_back({static_cast<int16_t>(32 * d), 0, 20, 72, static_cast<int16_t>(32 * d + 10), 72});
  atlas.albedo = Flat(TextureFormat::kBc7Srgb, 128, 96, {200, 60, 60, 254});
  atlas.normal = Flat(TextureFormat::kBc5, 128, 96, {128, 128});
  atlas.depth = Flat(TextureFormat::kBc4, 128, 96, {191});
  atlas.motion = Flat(TextureFormat::kBc7, 64, 48, {128, 128, 128, 128});
  return a;
}

// `boxes` of the town, each at its place on the ground.
inline TourPack MakePack(const std::vector<Vec2>& boxes) {
  TourPack pack;
  pack.materials = {{"red", {0.578f, 0.045f, 0.045f, 1}, -1, false, false, 0.5f}};  // 200, 60, 60 made linear
  pack.meshes = {{{BoxPrimitive({-0.25f, 0, -0.25f}, {0.25f, 1.8f, 0.25f}, 0, true)}},
                 {{BoxPrimitive({-1, 0, -1}, {1, 4, 1}, 0, false)}}};
  for (Vec2 p : boxes) {
    TownInstance instance{"box", 1, {}};
    const Vec3 at = GltfFromGround({p.x, p.y, 0});
    instance.world.m[3] = {at.x, at.y, at.z, 1};
    pack.town.push_back(instance);
  }
  pack.avatars = {BoxPerson()};
  return pack;
}

inline FrameInput LookEast() {
  FrameInput frame;
  frame.eye = {0, 0, 1.6f};
  frame.to_sun = Normalized(Vec3{-1, 0.3f, 0.6f});
  return frame;
}

// level: of the mesh; -1: the impostor.
inline DrawnPerson PersonAt(float x, float y, int level) {
  DrawnPerson person;
  person.level = level < 0 ? kImpostor : MeshLevel(level);
  person.position = {x, y, 0};
  person.heading_rad = kPi;  // towards the eye
  return person;
}

struct Rgb {
  int r, g, b;
};

class Drawing : public ::testing::Test {
 protected:
  void SetUp() override {
    const Error error = context_.Create();
    if (error) GTEST_SKIP() << error.message;
  }

  std::vector<uint8_t> Draw(const TourPack& pack, const FrameInput& frame, const RenderOptions& options = {}) {
    Renderer renderer;
    EXPECT_EQ(renderer.Create(pack, options).message, "");
    return DrawWith(frame, &renderer);
  }
  std::vector<uint8_t> DrawWith(const FrameInput& frame, Renderer* renderer) {
    std::vector<uint8_t> rgb;
    renderer->Draw(frame, kWidth, kHeight, &statistics_);
    renderer->Read(&rgb);
    return rgb;
  }

  HeadlessContext context_;
  FrameStatistics statistics_;
};

inline Rgb Pixel(const std::vector<uint8_t>& rgb, int x, int y) {
  const size_t i = static_cast<size_t>(y * kWidth + x) * 3;
  return {rgb[i], rgb[i + 1], rgb[i + 2]};
}

inline bool IsRed(Rgb c) { return c.r > c.g + 30 && c.r > c.b + 30; }

struct Patch {
  int count = 0;
  double r = 0, g = 0, b = 0;
};
inline Patch RedPatch(const std::vector<uint8_t>& rgb) {
  Patch patch;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const Rgb c = Pixel(rgb, x, y);
      if (!IsRed(c)) continue;
      ++patch.count;
      patch.r += c.r, patch.g += c.g, patch.b += c.b;
    }
  }
  patch.r /= patch.count, patch.g /= patch.count, patch.b /= patch.count;
  return patch;
}

}  // namespace flaneur
