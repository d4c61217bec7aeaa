// Every shader program in every mode, as the driver takes it. The build has shown each to Khronos' own compiler.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "runtime/desktop/context.h"
#include "runtime/render/gl_objects.h"
#include "runtime/render/shader_source.h"

namespace flaneur {
namespace {

struct Variant {
  ShaderProgram program;
  ShaderMode mode;
  std::string name;
};

std::vector<Variant> AllVariants() {
  std::vector<Variant> all;
#define MODE(mode, defines) all.push_back({program, ShaderMode::mode, name + " " #mode});
#define PROGRAM(which, vertex, fragment, defines)       \
  {                                                     \
    const ShaderProgram program = ShaderProgram::which; \
    const std::string name = #which;                    \
    FLANEUR_SHADER_MODES(MODE)                          \
  }
  FLANEUR_SHADER_PROGRAMS(PROGRAM)
#undef PROGRAM
#undef MODE
  return all;
}

class Shaders : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const Error error = context_.Create()) GTEST_SKIP() << error.message;
  }

  HeadlessContext context_;
};

TEST_F(Shaders, LinkInEveryVariant) {
  const std::vector<Variant> all = AllVariants();
  ASSERT_GT(all.size(), 100u);
  for (const Variant& v : all) {
    Program program;
    EXPECT_EQ(BuildProgram(v.program, v.mode, &program).message, "") << v.name;
    glDeleteProgram(program.id);
  }
}

TEST_F(Shaders, HaveTheFrameWhereTheProgramPutsIt) {
  const struct {
    const char* name;
    size_t offset;
  } fields[] = {
#define FIELD(type, name) {"Frame." #name, offsetof(FrameBlock, name)},
#include "runtime/render/shaders/frame_fields.glsl"
#undef FIELD
  };
  Program program;
  ASSERT_EQ(BuildProgram(ShaderProgram::kTown, ShaderMode::kGpu, &program).message, "");
  const GLuint block = glGetUniformBlockIndex(program.id, "Frame");
  ASSERT_NE(block, GL_INVALID_INDEX);
  GLint bytes = 0;
  glGetActiveUniformBlockiv(program.id, block, GL_UNIFORM_BLOCK_DATA_SIZE, &bytes);
  EXPECT_EQ(static_cast<size_t>(bytes), sizeof(FrameBlock));
  for (const auto& field : fields) {
    GLuint index = GL_INVALID_INDEX;
    glGetUniformIndices(program.id, 1, &field.name, &index);
    ASSERT_NE(index, GL_INVALID_INDEX) << field.name;
    GLint offset = -1;
    glGetActiveUniformsiv(program.id, 1, &index, GL_UNIFORM_OFFSET, &offset);
    EXPECT_EQ(static_cast<size_t>(offset), field.offset) << field.name;
  }
}

// One that nobody sets would be 0, and the picture wrong without a word.
TEST_F(Shaders, HaveNoUniformThatCannotBeSet) {
  constexpr GLenum kSamplers[] = {GL_SAMPLER_2D, GL_SAMPLER_2D_ARRAY, GL_SAMPLER_2D_SHADOW, GL_SAMPLER_2D_ARRAY_SHADOW};
  for (const Variant& v : AllVariants()) {
    Program p;
    ASSERT_EQ(BuildProgram(v.program, v.mode, &p).message, "") << v.name;
    const GLint places[] = {p.atlas,        p.ranges,       p.directions, p.tints, p.tint_shifts,
                            p.tint_regions, p.alpha_cutoff, p.share,      p.size};
    GLint count = 0;
    glGetProgramiv(p.id, GL_ACTIVE_UNIFORMS, &count);
    for (GLint i = 0; i < count; ++i) {
      char name[128] = "";
      GLint size = 0;
      GLenum type = 0;
      glGetActiveUniform(p.id, static_cast<GLuint>(i), sizeof name, nullptr, &size, &type, name);
      const GLint place = glGetUniformLocation(p.id, name);
      if (place < 0) continue;  // of the frame
      if (std::find(std::begin(kSamplers), std::end(kSamplers), type) != std::end(kSamplers)) {
        GLint unit = -1;
        glGetUniformiv(p.id, place, &unit);
        // Unit 0 is also where a driver has those that nobody placed.
        EXPECT_EQ(unit == 0, std::string(name) == "u_texture") << v.name << " " << name;
        continue;
      }
      EXPECT_NE(std::find(std::begin(places), std::end(places), place), std::end(places)) << v.name << " " << name;
    }
    glDeleteProgram(p.id);
  }
}

// The same text runs in a browser.
TEST(ShaderSources, AreWebGl2) {
  for (const Variant& v : AllVariants()) {
    const ShaderSource source = SourceOf(v.program, v.mode);
    for (const std::string& text : {source.vertex, source.fragment}) {
      EXPECT_EQ(text.rfind("#version 300 es\n", 0), 0u) << v.name;
      for (const char* missing : {"#extension", "GL_EXT_", "GL_OES_", "texture2D(", "gl_FragColor", "#include"}) {
        EXPECT_EQ(text.find(missing), std::string::npos) << v.name << ": " << missing;
      }
    }
  }
}

}  // namespace
}  // namespace flaneur
