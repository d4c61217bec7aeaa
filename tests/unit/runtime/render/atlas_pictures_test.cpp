// Impostors' pictures as machines of every kind take them; OpenGL, which reads ETC2 itself, is the judge of its blocks.
#include "runtime/render/atlas_pictures.h"

#include <GLES3/gl3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "runtime/desktop/context.h"
#include "runtime/render/etc2_blocks.h"

namespace flaneur {
namespace {

// Of what is drawn: smooth, with edges and some noise.
std::vector<uint8_t> Drawing(int channels, int width_px, int height_px, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> between(0, 1);
  std::vector<uint8_t> texels;
  const float edge_px = between(random) * static_cast<float>(width_px);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      const bool left = static_cast<float>(x + y / 2) < edge_px;
      for (int c = 0; c < channels; ++c) {
        const float slope = static_cast<float>(x * (c + 1) + y) / static_cast<float>(4 * width_px + height_px);
        const float value =
            c == 3 ? (left ? 255.0f : 0.0f) : (left ? 60.0f : 170.0f) + 40 * slope + 6 * between(random);
        texels.push_back(static_cast<uint8_t>(value));
      }
    }
  }
  return texels;
}

// Four channels a texel, as OpenGL understands the blocks.
std::vector<uint8_t> Understood(GLenum format, int width_px, int height_px, const std::vector<uint8_t>& blocks) {
  GLuint texture = 0, framebuffer = 0, color = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glCompressedTexImage2D(GL_TEXTURE_2D, 0, format, width_px, height_px, 0, static_cast<GLsizei>(blocks.size()),
                         blocks.data());
  for (GLenum name : {GLenum{GL_TEXTURE_MIN_FILTER}, GLenum{GL_TEXTURE_MAG_FILTER}})
    glTexParameteri(GL_TEXTURE_2D, name, GL_NEAREST);
  glGenRenderbuffers(1, &color);
  glBindRenderbuffer(GL_RENDERBUFFER, color);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width_px, height_px);
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
  const auto shader = [](GLenum kind, const char* text) {
    const GLuint made = glCreateShader(kind);
    glShaderSource(made, 1, &text, nullptr);
    glCompileShader(made);
    return made;
  };
  const GLuint program = glCreateProgram();
  glAttachShader(program,
                 shader(GL_VERTEX_SHADER,
                        "#version 300 es\nvoid main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> "
                        "1) * 4.0 - 1.0, 0, 1); }"));
  glAttachShader(program,
                 shader(GL_FRAGMENT_SHADER,
                        "#version 300 es\nprecision highp float; uniform highp sampler2D picture; out vec4 color;"
                        "void main() { color = texelFetch(picture, ivec2(gl_FragCoord.xy), 0); }"));
  glLinkProgram(program);
  glUseProgram(program);
  glViewport(0, 0, width_px, height_px);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  std::vector<uint8_t> out(static_cast<size_t>(width_px * height_px) * 4);
  glReadPixels(0, 0, width_px, height_px, GL_RGBA, GL_UNSIGNED_BYTE, out.data());
  EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
  glDeleteTextures(1, &texture);
  glDeleteFramebuffers(1, &framebuffer);
  glDeleteRenderbuffers(1, &color);
  return out;
}

double RootMeanSquare(int channels, const std::vector<uint8_t>& texels, const std::vector<uint8_t>& understood) {
  double sum = 0;
  for (size_t i = 0; i < texels.size(); ++i) {
    const size_t texel = i / static_cast<size_t>(channels), channel = i % static_cast<size_t>(channels);
    const double off = static_cast<double>(texels[i]) - static_cast<double>(understood[4 * texel + channel]);
    sum += off * off;
  }
  return std::sqrt(sum / static_cast<double>(texels.size()));
}

constexpr GLenum FormatFor(int channels) {
  return channels == 1 ? GL_COMPRESSED_R11_EAC : channels == 2 ? GL_COMPRESSED_RG11_EAC : GL_COMPRESSED_RGBA8_ETC2_EAC;
}

TEST(Etc2Blocks, OpenGLReadsWhatWasWritten) {
  HeadlessContext context;
  if (context.Create()) GTEST_SKIP() << "no OpenGL here";
  for (unsigned seed = 0; seed < 12; ++seed) {
    for (int channels : {1, 2, 4}) {
      const int width_px = 17 + static_cast<int>(seed) * 5, height_px = 30 + static_cast<int>(seed) % 4;
      const auto texels = Drawing(channels, width_px, height_px, seed);
      const auto understood =
          Understood(FormatFor(channels), width_px, height_px, Etc2Blocks(channels, width_px, height_px, texels));
      EXPECT_LT(RootMeanSquare(channels, texels, understood), channels == 4 ? 6 : 3) << channels << " " << seed;
    }
  }
}

TEST(Etc2Blocks, OfOneValueAreThatValue) {
  HeadlessContext context;
  if (context.Create()) GTEST_SKIP() << "no OpenGL here";
  for (int channels : {1, 2, 4}) {
    for (int value = 0; value < 256; value += 5) {
      const std::vector<uint8_t> texels(static_cast<size_t>(16 * channels), static_cast<uint8_t>(value));
      const auto understood = Understood(FormatFor(channels), 4, 4, Etc2Blocks(channels, 4, 4, texels));
      for (size_t c = 0; c < static_cast<size_t>(channels); ++c) {
        const int off = std::abs(understood[c] - value);
        EXPECT_LE(off, channels == 4 && c < 3 ? 2 : 1) << channels << " channels, " << value;
      }
    }
  }
}

PackTexture Noise(TextureFormat format, int width_px, int height_px, unsigned seed) {
  std::mt19937 random(seed);
  PackTexture out{format, width_px, height_px, {}};
  for (int level = 0; level < 5; ++level) {
    std::vector<uint8_t> blocks(LevelBytes(format, std::max(1, width_px >> level), std::max(1, height_px >> level)));
    for (uint8_t& byte : blocks) byte = static_cast<uint8_t>(random());
    out.levels.push_back(std::move(blocks));
  }
  return out;
}

PackImpostor NoisyImpostor() {
  PackImpostor impostor;
  impostor.albedo = Noise(TextureFormat::kBc7Srgb, 516, 264, 1);
  impostor.normal = Noise(TextureFormat::kBc5, 516, 264, 2);
  impostor.depth = Noise(TextureFormat::kBc4, 516, 264, 3);
  impostor.motion = Noise(TextureFormat::kBc7, 258, 132, 4);
  return impostor;
}

TEST(AtlasBuilder, InStepsMakesTheSameAsAtOnce) {
  const PackImpostor impostor = NoisyImpostor();
  AtlasFormats plain;
  int steps = 1;
  AtlasBuilder builder(impostor, plain);
  while (!builder.Advance()) ++steps;
  EXPECT_GT(steps, 20);
  const auto pictures = builder.Take();
  const std::array<const PackTexture*, 4> from{&impostor.albedo, &impostor.normal, &impostor.depth, &impostor.motion};
  for (size_t k = 0; k < from.size(); ++k) {
    ASSERT_EQ(pictures[k].levels.size(), 4u);
    for (int level = 0; level < 4; ++level) {
      const auto& blocks = from[k]->levels[static_cast<size_t>(level)];
      EXPECT_EQ(pictures[k].levels[static_cast<size_t>(level)],
                DecodeLevel(from[k]->format, from[k]->width_px >> level, from[k]->height_px >> level, blocks));
    }
  }
  EXPECT_TRUE(pictures[4].levels.empty());
}

TEST(AtlasBuilder, TakesWhatTheMachineReads) {
  const PackImpostor impostor = NoisyImpostor();
  AtlasFormats all, telephone, none;
  all.bc7_blocks = all.rgtc_blocks = all.etc2_blocks = telephone.etc2_blocks = none.fewer_texels = true;
  const auto of_all = BuildAtlas(impostor, all), of_telephone = BuildAtlas(impostor, telephone),
             of_none = BuildAtlas(impostor, none);
  EXPECT_EQ(of_all[0].levels[0], impostor.albedo.levels[0]);
  EXPECT_EQ(of_all[3].levels[1], impostor.motion.levels[1]);
  for (size_t k : {0u, 1u, 2u}) {
    EXPECT_EQ(of_telephone[k].stored_as, StoredAs::kEtc2Blocks);
    EXPECT_EQ(of_telephone[k].levels[0].size(), of_all[k].levels[0].size())
        << "no more memory than the pack's own blocks";
  }
  EXPECT_EQ(of_telephone[3].stored_as, StoredAs::kTexels) << "what is no colour keeps its channels apart";
  EXPECT_EQ(of_none[0].width_px, 258) << "texels take four times the memory: a fourth of them";
}

// Of a page's tour the coarse levels come first, as pictures of their own.
TEST(AtlasBuilder, GivesWebGlBlocksOfPicturesThatTheyFillAlone) {
  AtlasFormats page;
  page.bc7_blocks = page.rgtc_blocks = page.whole_blocks = true;
  const PackImpostor impostor = NoisyImpostor();
  const auto pictures = BuildAtlas(impostor, page);
  for (size_t k : {0u, 1u, 2u}) EXPECT_EQ(pictures[k].stored_as, StoredAs::kOwnBlocks);
  EXPECT_EQ(pictures[3].stored_as, StoredAs::kTexels) << "258 texels wide";
}

}  // namespace
}  // namespace flaneur
