// What an impostor costs to bake and how exact its pictures are:
//
//   impostor_bench PERSON.glb [SAMPLES] [REFERENCE_SAMPLES]
//
// Bakes 16 directions x 8 phases of the walk at 128 px, once as by default (or with SAMPLES a pixel) and once with
// REFERENCE_SAMPLES (64; 0: without), then the whole impostor's mip levels after compression against exact means of the
// finest.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "pipeline/impostor/atlas_layers.h"
#include "pipeline/impostor/bake_impostor.h"
#include "pipeline/io/gltf.h"
#include "runtime/base/pixels.h"
#include "runtime/pack/ktx2.h"

namespace flaneur {
namespace {

Error Decode(const Image& image, Pixels* out) {
  const std::optional<Pixels> pixels = Decoded(image.bytes);
  if (!pixels) return Fail("the atlas cannot be decoded");
  *out = *pixels;
  return Ok();
}

Vec3 NormalOf(const uint8_t* texel) {
  const auto axis = [](uint8_t value) { return static_cast<float>(value) / 127.5f - 1; };
  return Normalized(Vec3{axis(texel[0]), axis(texel[1]), axis(texel[2])});
}

Error CompareSamples(const ImpostorAtlas& few, const ImpostorAtlas& many) {
  Pixels a, b, m, n;
  if (Error e = Decode(few.albedo, &a)) return e;
  if (Error e = Decode(many.albedo, &b)) return e;
  if (Error e = Decode(few.normal, &m)) return e;
  if (Error e = Decode(many.normal, &n)) return e;
  double squares = 0, edge_squares = 0, degrees = 0;
  size_t edges = 0, covered = 0;
  for (size_t i = 0; i + 3 < a.rgba.size(); i += 4) {
    const double off = a.rgba[i + 3] - b.rgba[i + 3];
    squares += off * off;
    if (b.rgba[i + 3] > 0 && b.rgba[i + 3] < 255) edge_squares += off * off, ++edges;
    if (a.rgba[i + 3] < 128 || b.rgba[i + 3] < 128) continue;
    const Vec3 u = NormalOf(&m.rgba[i]), v = NormalOf(&n.rgba[i]);
    degrees +=
        std::atan2(static_cast<double>(Length(Cross(u, v))), static_cast<double>(Dot(u, v))) * 180 / 3.14159265358979;
    ++covered;
  }
  std::printf("alpha off by %.2f of 255 (root mean square; on edges alone %.2f), normals by %.2f degrees\n",
              std::sqrt(4 * squares / static_cast<double>(a.rgba.size())),
              std::sqrt(edge_squares / static_cast<double>(edges)), degrees / static_cast<double>(covered));
  std::fflush(stdout);
  return Ok();
}

float Share(uint8_t byte) { return static_cast<float>(byte) / 255; }

AtlasLevel Finest(const Pixels& albedo) {
  AtlasLevel level{albedo.width, albedo.height, {}};
  for (size_t i = 0; i + 3 < albedo.rgba.size(); i += 4) {
    const uint8_t* t = &albedo.rgba[i];
    level.texels.push_back({Share(t[3]), {Share(t[0]), Share(t[1]), Share(t[2])}, {}, 0, {}, {}, {}});
  }
  return level;
}

Error CompareLevels(const ImpostorAtlas& atlas) {
  PackTexture texture;
  Pixels albedo;
  if (Error e = ReadKtx2(atlas.albedo_ktx2, &texture)) return e;
  if (Error e = Decode(atlas.albedo, &albedo)) return e;
  const std::vector<AtlasLevel> levels = MakeLevels(Finest(albedo));
  const double share = CoveredShare(levels[0], 0.5f);
  std::printf(
      "level  covered  colour off by: edges (mean with sign, mean, root mean square)  inside (root mean square), of "
      "255\n");
  for (size_t k = 0; k < texture.levels.size(); ++k) {
    const std::vector<uint8_t> seen = DecodeLevel(texture.format, levels[k].width, levels[k].height, texture.levels[k]);
    double bled = 0, off[2] = {}, squares[2] = {};  // bled: signed, on edges
    size_t count[2] = {}, covered = 0;
    for (size_t i = 0; i < levels[k].texels.size(); ++i) {
      const AtlasTexel& texel = levels[k].texels[i];
      covered += seen[4 * i + 3] >= 128;
      if (texel.coverage <= 0) continue;
      const size_t inside = texel.coverage >= 0.999f;
      for (size_t c = 0; c < 3; ++c) {
        const double d = seen[4 * i + c] - 255 * static_cast<double>(texel.albedo[c]);
        bled += inside ? 0 : d, off[inside] += std::abs(d), squares[inside] += d * d, ++count[inside];
      }
    }
    const auto n = [&](size_t inside) { return static_cast<double>(std::max<size_t>(1, count[inside])); };
    std::printf("%5zu  %+.2f %%  %+.2f %.2f %.2f  %.2f\n", k,
                100 * (static_cast<double>(covered) / static_cast<double>(levels[k].texels.size()) - share),
                bled / n(0), off[0] / n(0), std::sqrt(squares[0] / n(0)), std::sqrt(squares[1] / n(1)));
  }
  return Ok();
}

Error Bake(const Avatar& avatar, const ImpostorOptions& options, ImpostorAtlas* atlas) {
  ImpostorStatistics s;
  if (Error e = BakeImpostor(avatar, options, atlas, &s)) return e;
  std::printf(
      "%d samples: Blender %.1f CPU seconds, %.0f MB; atlas %d x %d px, %.1f %% of its texels show the person, %.2f "
      "MB\n",
      options.samples, s.blender_cpu_s, static_cast<double>(s.blender_peak_memory_bytes) / 1e6, s.width_px, s.height_px,
      100 * s.fill_rate, static_cast<double>(s.memory_bytes) / 1e6);
  std::fflush(stdout);
  return Ok();
}

Error Run(int argc, char** argv) {
  Avatar avatar;
  std::vector<std::string> warnings;
  if (Error e = ReadAvatar(argv[1], {}, &avatar, &warnings)) return e;
  ImpostorOptions options, walk;
  if (argc > 2) options.samples = std::atoi(argv[2]);
  walk.samples = options.samples;
  walk.clips = {{"walk", 8}};
  ImpostorAtlas few, many, whole;
  if (Error e = Bake(avatar, walk, &few)) return e;
  walk.samples = argc > 3 ? std::atoi(argv[3]) : 64;
  if (walk.samples > 0) {
    if (Error e = Bake(avatar, walk, &many)) return e;
    if (Error e = CompareSamples(few, many)) return e;
  }
  if (Error e = CompareLevels(few)) return e;
  return Bake(avatar, options, &whole);
}

}  // namespace
}  // namespace flaneur

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "usage: impostor_bench PERSON.glb [SAMPLES] [REFERENCE_SAMPLES]\n"), 2;
  const flaneur::Error error = flaneur::Run(argc, argv);
  if (!error) return 0;
  std::fprintf(stderr, "impostor_bench: error: %s\n", error.message.c_str());
  return 1;
}
