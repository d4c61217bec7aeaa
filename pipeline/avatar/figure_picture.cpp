#include "pipeline/avatar/figure_picture.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pipeline/avatar/atlas_picture.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr float kMargin = 0.08f;  // of the height, above and below
constexpr float kWidth = 0.85f;   // of a view, against its height, at least
constexpr float kWidest = 4;      // the same, at most
constexpr float kAmbient = 0.45f;
constexpr Vec3 kLight{0.35f, 0.6f, 0.72f};  // towards it, as seen
constexpr int kPicture_px = 256;            // that materials' pictures are looked up in

struct Look {
  Vec4 color;  // sRGB
  std::optional<Pixels> picture;
  float cutoff = 0;
};

std::vector<Look> LooksOf(const Avatar& avatar) {
  std::vector<Look> looks;
  for (const Material& material : avatar.materials) {
    Look& look = looks.emplace_back();
    const auto srgb = [](float linear) { return std::pow(std::clamp(linear, 0.0f, 1.0f), 1 / 2.2f); };
    const Vec4 c = material.base_color;
    look.color = {srgb(c.x), srgb(c.y), srgb(c.z), c.w};
    if (material.alpha == Material::Alpha::kMask) look.cutoff = material.alpha_cutoff;
    if (material.alpha == Material::Alpha::kBlend) look.cutoff = 0.5f;
    if (material.base_color_image < 0) continue;
    look.picture = Decoded(At(avatar.images, material.base_color_image).bytes);
    if (look.picture) look.picture = Resized(*look.picture, kPicture_px, kPicture_px);
  }
  return looks;
}

// In the view's pose and turned as it is seen, +Z towards the eye.
Mesh Seen(const Mesh& mesh, const FigureView& view) {
  const float yaw = view.yaw_deg * kPi / 180, c = std::cos(yaw), s = std::sin(yaw);
  Mesh seen = Skinned(mesh, view.pose);
  for (std::vector<Vec3>* const vectors : {&seen.positions, &seen.normals}) {
    for (Vec3& v : *vectors) v = {c * v.x - s * v.z, v.y, s * v.x + c * v.z};
  }
  return seen;
}

// What a view must show to both sides of its middle and above the ground, in metres.
struct Reach {
  float aside_m = 0, up_m = 0;
};

void Widen(const Mesh& seen, Reach* reach) {
  for (const Vec3 p : seen.positions) *reach = {std::max(reach->aside_m, std::abs(p.x)), std::max(reach->up_m, p.y)};
}

struct Corner {
  float x = 0, y = 0, depth = 0, shade = 0;
  Vec2 uv;
  Vec3 tint{1, 1, 1};
};

class Canvas {
 public:
  Canvas(int views, Reach reach, int height_px)
      : height_(height_px),
        scale_(static_cast<float>(height_px) * (1 - 2 * kMargin) / std::max(reach.up_m, 0.01f)),
        width_(static_cast<int>(std::clamp(2 * scale_ * reach.aside_m + 2 * kMargin * static_cast<float>(height_px),
                                           kWidth * static_cast<float>(height_px),
                                           kWidest * static_cast<float>(height_px)))),
        pixels_(Blank(width_ * std::max(views, 1), height_px)),
        depths_(static_cast<size_t>(pixels_.width) * static_cast<size_t>(pixels_.height), -1e30f) {
    const int ground =
        std::clamp(height_ - 1 - static_cast<int>(kMargin * static_cast<float>(height_)), 0, height_ - 1);
    for (int x = 0; x < pixels_.width; ++x) Set(x, ground, {0.75f, 0.75f, 0.75f});
  }

  void Draw(const Mesh& mesh, const Look* look, int view) {
    std::vector<Corner> corners(mesh.positions.size());
    for (size_t v = 0; v < corners.size(); ++v) {
      const Vec3 p = mesh.positions[v];
      Corner& corner = corners[v];
      corner.x = static_cast<float>(view * width_) + 0.5f * static_cast<float>(width_) + scale_ * p.x;
      corner.y = (1 - kMargin) * static_cast<float>(height_) - scale_ * p.y;
      corner.depth = p.z;
      const float lit = Dot(mesh.normals[v], kLight);
      corner.shade = kAmbient + (1 - kAmbient) * std::abs(lit) * (lit < 0 ? 0.5f : 1.0f);
      if (!mesh.uvs.empty()) corner.uv = mesh.uvs[v];
      if (!mesh.colors.empty())
        corner.tint = {std::sqrt(mesh.colors[v].x), std::sqrt(mesh.colors[v].y), std::sqrt(mesh.colors[v].z)};
    }
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      Fill(corners[mesh.indices[i]], corners[mesh.indices[i + 1]], corners[mesh.indices[i + 2]], look, view);
    }
  }

  Pixels Take() { return std::move(pixels_); }

 private:
  void Set(int x, int y, Vec3 color) {
    uint8_t* out =
        &pixels_.rgba[4 * (static_cast<size_t>(y) * static_cast<size_t>(pixels_.width) + static_cast<size_t>(x))];
    const float channels[] = {color.x, color.y, color.z};
    for (size_t i = 0; i < 3; ++i) out[i] = static_cast<uint8_t>(std::clamp(channels[i], 0.0f, 1.0f) * 255);
    out[3] = 255;
  }

  void Fill(const Corner& a, const Corner& b, const Corner& c, const Look* look, int view) {
    const float area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (!(std::abs(area) > 1e-6f)) return;
    const auto bound = [](float v, int low, int high) {
      return static_cast<int>(std::clamp(v, static_cast<float>(low), static_cast<float>(high)));
    };
    const int left = bound(std::floor(std::min({a.x, b.x, c.x})), view * width_, (view + 1) * width_ - 1);
    const int right = bound(std::ceil(std::max({a.x, b.x, c.x})), view * width_, (view + 1) * width_ - 1);
    const int top = bound(std::floor(std::min({a.y, b.y, c.y})), 0, height_ - 1);
    const int bottom = bound(std::ceil(std::max({a.y, b.y, c.y})), 0, height_ - 1);
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) {
        const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
        const float wa = ((b.x - px) * (c.y - py) - (b.y - py) * (c.x - px)) / area;
        const float wb = ((c.x - px) * (a.y - py) - (c.y - py) * (a.x - px)) / area;
        const float wc = 1 - wa - wb;
        if (wa < 0 || wb < 0 || wc < 0) continue;
        Shade(x, y, wa, wb, wc, a, b, c, look);
      }
    }
  }

  void Shade(int x, int y, float wa, float wb, float wc, const Corner& a, const Corner& b, const Corner& c,
             const Look* look) {
    float& depth = depths_[static_cast<size_t>(y) * static_cast<size_t>(pixels_.width) + static_cast<size_t>(x)];
    const float own = wa * a.depth + wb * b.depth + wc * c.depth;
    if (own <= depth) return;
    Vec4 color{0.8f, 0.8f, 0.8f, 1};
    if (look != nullptr) {
      color = look->color;
      if (look->picture) {
        const Vec4 texel = Texel(*look->picture, a.uv * wa + b.uv * wb + c.uv * wc);
        color = {color.x * texel.x, color.y * texel.y, color.z * texel.z, color.w * texel.w};
      }
      if (color.w < look->cutoff) return;
    }
    depth = own;
    const float shade = wa * a.shade + wb * b.shade + wc * c.shade;
    const Vec3 tint = a.tint * wa + b.tint * wb + c.tint * wc;
    Set(x, y, {color.x * shade * tint.x, color.y * shade * tint.y, color.z * shade * tint.z});
  }

  static Vec4 Texel(const Pixels& picture, Vec2 uv) {
    const auto wrapped = [](float v, int size) {
      const int i = static_cast<int>((v - std::floor(v)) * static_cast<float>(size));
      return static_cast<size_t>(std::clamp(i, 0, size - 1));
    };
    const uint8_t* in = &picture.rgba[4 * (wrapped(uv.y, picture.height) * static_cast<size_t>(picture.width) +
                                           wrapped(uv.x, picture.width))];
    return {static_cast<float>(in[0]) / 255, static_cast<float>(in[1]) / 255, static_cast<float>(in[2]) / 255,
            static_cast<float>(in[3]) / 255};
  }

  int height_;
  float scale_;
  int width_;
  Pixels pixels_;
  std::vector<float> depths_;
};

}  // namespace

Pixels DrawFigures(const std::vector<Mesh>& meshes, const Avatar& avatar, const std::vector<FigureView>& views,
                   float height_m, int height_px) {
  const std::vector<Look> looks = LooksOf(avatar);
  std::vector<std::vector<Mesh>> seen(views.size());
  Reach reach{0, height_m};
  for (size_t v = 0; v < views.size(); ++v) {
    for (const Mesh& mesh : meshes) {
      seen[v].push_back(Seen(mesh, views[v]));
      Widen(seen[v].back(), &reach);
    }
  }
  Canvas canvas(Count(views), reach, height_px);
  for (int v = 0; v < Count(views); ++v) {
    for (const Mesh& mesh : At(seen, v)) {
      const Look* look = InRange(looks, mesh.material) ? &At(looks, mesh.material) : nullptr;
      canvas.Draw(mesh, look, v);
    }
  }
  return canvas.Take();
}

std::vector<FigureView> ViewsOfClip(const Avatar& avatar, const Clip& clip, int count) {
  std::vector<FigureView> views;
  for (int i = 0; i < count; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(std::max(count, 1));
    views.push_back({SkinningMatrices(avatar, clip, share * clip.duration_s), 90});
  }
  for (const float yaw_deg : {0.0f, 180.0f})
    views.push_back({SkinningMatrices(avatar, clip, 0.25f * clip.duration_s), yaw_deg});
  return views;
}

Pixels Beside(const Pixels& left, const Pixels& right) {
  Pixels both = Blank(left.width + right.width, std::max(left.height, right.height));
  const auto put = [&](const Pixels& from, int x) {
    for (int y = 0; y < from.height; ++y) {
      const auto begin = from.rgba.begin() + static_cast<std::ptrdiff_t>(4) * y * from.width;
      std::copy(begin, begin + static_cast<std::ptrdiff_t>(4) * from.width,
                both.rgba.begin() + static_cast<std::ptrdiff_t>(4) * (static_cast<std::ptrdiff_t>(y) * both.width + x));
    }
  };
  put(left, 0);
  put(right, left.width);
  return both;
}

Pixels Stacked(const std::vector<Pixels>& rows) {
  int width = 1, height = 0;
  for (const Pixels& row : rows) width = std::max(width, row.width), height += row.height;
  Pixels all = Blank(width, std::max(height, 1));
  size_t top = 0;
  for (const Pixels& row : rows) {
    for (size_t y = 0; y < static_cast<size_t>(row.height); ++y) {
      const auto from = row.rgba.begin() + static_cast<std::ptrdiff_t>(4 * y * static_cast<size_t>(row.width));
      std::copy(from, from + static_cast<std::ptrdiff_t>(4 * row.width),
                all.rgba.begin() + static_cast<std::ptrdiff_t>(4 * (top + y) * static_cast<size_t>(width)));
    }
    top += static_cast<size_t>(row.height);
  }
  return all;
}

}  // namespace flaneur
