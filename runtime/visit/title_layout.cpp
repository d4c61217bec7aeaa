#include "runtime/visit/title_layout.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

constexpr float kLogoShare = 0.5f;   // of the page's width and height, at most
constexpr float kLogoMiddle = 0.4f;  // of the page's height, from its top
constexpr int kMostSide_px = 4096;

Pixels DecodedOrNone(const std::vector<uint8_t>& bytes) {
  if (bytes.empty()) return {};
  const auto size = DecodedSize(bytes);
  if (!size || size->width > kMostSide_px || size->height > kMostSide_px) return {};
  auto pixels = Decoded(bytes);
  return pixels ? std::move(*pixels) : Pixels{};
}

// From a place in the page to one in a picture, both in pixels.
struct Placing {
  float scale = 1, left = 0, top = 0;  // pixels of the page for one of the picture; where the picture begins
};

// As shrinking needs it: the middle of what one pixel of the page covers.
struct Sampler {
  const Pixels& of;
  Placing at;

  // Premultiplied, 0 to 255 each.
  Vec4 Sample(float x, float y) const {
    const float reach = std::max(1.0f, 1 / at.scale);
    const float u = (x - at.left) / at.scale, v = (y - at.top) / at.scale;
    const int steps = std::min(4, static_cast<int>(std::ceil(reach)));
    Vec4 sum{};
    for (int j = 0; j < steps; ++j) {
      for (int i = 0; i < steps; ++i) {
        const auto off = [&](int k) { return ((static_cast<float>(k) + 0.5f) / static_cast<float>(steps) - 0.5f); };
        const Vec4 texel = Bilinear(u + off(i) * reach, v + off(j) * reach);
        sum = {sum.x + texel.x, sum.y + texel.y, sum.z + texel.z, sum.w + texel.w};
      }
    }
    const float share = 1 / static_cast<float>(steps * steps);
    return {sum.x * share, sum.y * share, sum.z * share, sum.w * share};
  }

 private:
  Vec4 Texel(int x, int y) const {
    const auto column = static_cast<size_t>(std::clamp(x, 0, of.width - 1));
    const auto row = static_cast<size_t>(std::clamp(y, 0, of.height - 1));
    const uint8_t* p = &of.rgba[4 * (row * static_cast<size_t>(of.width) + column)];
    const float alpha = static_cast<float>(p[3]) / 255;
    return {static_cast<float>(p[0]) * alpha, static_cast<float>(p[1]) * alpha, static_cast<float>(p[2]) * alpha,
            static_cast<float>(p[3])};
  }
  Vec4 Bilinear(float u, float v) const {
    const float x = u - 0.5f, y = v - 0.5f, left = std::floor(x), top = std::floor(y);
    const float fx = x - left, fy = y - top;
    const int column = static_cast<int>(left), row = static_cast<int>(top);
    const Vec4 corners[] = {Texel(column, row), Texel(column + 1, row), Texel(column, row + 1),
                            Texel(column + 1, row + 1)};
    const float shares[] = {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
    Vec4 sum{};
    for (size_t k = 0; k < 4; ++k) {
      sum = {sum.x + shares[k] * corners[k].x, sum.y + shares[k] * corners[k].y, sum.z + shares[k] * corners[k].z,
             sum.w + shares[k] * corners[k].w};
    }
    return sum;
  }
};

void Draw(const Pixels& picture, const Placing& at, Pixels* page) {
  const Sampler sampler{picture, at};
  const auto first = [](float from) { return std::max(0, static_cast<int>(std::floor(from))); };
  const auto end = [](float to, int most) { return std::min(most, static_cast<int>(std::ceil(to))); };
  const int bottom = end(at.top + at.scale * static_cast<float>(picture.height), page->height);
  const int right = end(at.left + at.scale * static_cast<float>(picture.width), page->width);
  for (int y = first(at.top); y < bottom; ++y) {
    for (int x = first(at.left); x < right; ++x) {
      const Vec4 over = sampler.Sample(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      uint8_t* p =
          &page->rgba[4 * (static_cast<size_t>(y) * static_cast<size_t>(page->width) + static_cast<size_t>(x))];
      const float rest = 1 - over.w / 255;
      const float colors[] = {over.x, over.y, over.z};
      for (size_t c = 0; c < 3; ++c)
        p[c] = static_cast<uint8_t>(std::clamp(colors[c] + rest * static_cast<float>(p[c]) + 0.5f, 0.0f, 255.0f));
    }
  }
}

}  // namespace

TitlePictures DecodeTitlePage(const TitlePage& page) {
  return {DecodedOrNone(page.picture), DecodedOrNone(page.logo), page.background};
}

Pixels LayOutTitlePage(const TitlePictures& pictures, int width_px, int height_px) {
  const auto width = static_cast<float>(width_px), height = static_cast<float>(height_px);
  Pixels page{width_px, height_px, {}};
  page.rgba.resize(4 * static_cast<size_t>(width_px) * static_cast<size_t>(height_px));
  const float background[] = {pictures.background.x, pictures.background.y, pictures.background.z, 1};
  for (size_t k = 0; k < page.rgba.size(); ++k) page.rgba[k] = static_cast<uint8_t>(255 * background[k % 4] + 0.5f);
  const auto place = [&](const Pixels& picture, float scale, float middle) {
    const float wide = scale * static_cast<float>(picture.width), high = scale * static_cast<float>(picture.height);
    Draw(picture, {scale, (width - wide) / 2, middle * height - high / 2}, &page);
  };
  if (const Pixels& p = pictures.picture; !p.rgba.empty())
    place(p, std::max(width / static_cast<float>(p.width), height / static_cast<float>(p.height)), 0.5f);
  if (const Pixels& p = pictures.logo; !p.rgba.empty())
    place(p, kLogoShare * std::min(width / static_cast<float>(p.width), height / static_cast<float>(p.height)),
          kLogoMiddle);
  return page;
}

}  // namespace flaneur
