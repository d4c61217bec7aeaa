// All shaders, as the player hands them to the driver, are correct GLSL ES 3.00, and with that WebGL 2: judged by Khronos' own
// compiler, where it is installed.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "runtime/render/all_shaders.h"
#include "runtime/desktop/context.h"
#include "runtime/render/renderer.h"

namespace flaneur {
namespace {

TourPack OnePerson() {
  TourPack pack;
  PackAvatar avatar;
  avatar.joints = 1;
  avatar.walk = avatar.idle = avatar.talk = {1, 1, {Mat4{}}};
  avatar.impostor.directions = avatar.impostor.frames = avatar.impostor.width_px = avatar.impostor.height_px = 1;
  avatar.impostor.elevations_deg = {0};
  avatar.impostor.texel_m = avatar.impostor.depth_range_m = avatar.impostor.motion_range_m = avatar.impostor.bend_range_m = 1;
  avatar.impostor.clips = {{"walk", 0, 1}};
  avatar.impostor.cells.resize(1);
  pack.avatars = {avatar};
  return pack;
}

// What the compiler has against it; empty: nothing.
std::string Complaints(const ShaderSource& shader, size_t number) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("flaneur_shader_" + std::to_string(number) + (shader.vertex ? ".vert" : ".frag"));
  std::ofstream(path) << shader.text;
  FILE* pipe = popen(("glslangValidator " + path.string() + " 2>&1").c_str(), "r");
  std::string said;
  char line[256];
  while (pipe != nullptr && std::fgets(line, sizeof line, pipe) != nullptr) {
    if (std::string(line).find("ERROR") != std::string::npos) said += line;
  }
  if (pipe != nullptr) pclose(pipe);
  std::filesystem::remove(path);
  return said;
}

TEST(Shaders, AreCorrectInEveryVariant) {
  if (std::system("glslangValidator --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no glslangValidator: install glslang-tools";
  HeadlessContext context;
  if (const Error error = context.Create()) GTEST_SKIP() << error.message;
  KeepShaderSources(true);
  for (const RenderOptions& options : {RenderOptions{1, true, false}, RenderOptions{4, true, false}, RenderOptions{1, true, true}}) {
    Renderer renderer;
    ASSERT_EQ(renderer.Begin(OnePerson(), options).message, "");
  }
  KeepShaderSources(false);
  const std::vector<ShaderSource>& sources = KeptShaderSources();
  ASSERT_GT(sources.size(), 60u);
  for (size_t i = 0; i < sources.size(); ++i) {
    EXPECT_EQ(Complaints(sources[i], i), "") << sources[i].text;
    // What OpenGL ES 3.0 has and WebGL 2 has not.
    for (const char* missing : {"GL_EXT_", "GL_OES_", "texture2D(", "gl_FragColor"}) {
      EXPECT_EQ(sources[i].text.find(missing), std::string::npos) << missing;
    }
    EXPECT_EQ(sources[i].text.rfind("#version 300 es\n", 0), 0u);
  }
}

}  // namespace
}  // namespace flaneur
