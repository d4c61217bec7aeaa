// Shaders as the driver gets them. Internal to runtime/render; no OpenGL.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "runtime/render/shaders/programs.h"

namespace flaneur {

struct ShaderSource {
  std::string vertex, fragment;
};
ShaderSource SourceOf(ShaderProgram program, ShaderMode mode);

// As embedded at build: a file with what it includes, without the header and the defines of a variant.
struct ShaderText {
  std::string_view file, text;
};
const std::vector<ShaderText>& ShaderTexts();
extern const char* const kShaderHeader;

}  // namespace flaneur
