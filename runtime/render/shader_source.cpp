#include "runtime/render/shader_source.h"

#include <algorithm>
#include <sstream>

namespace flaneur {
namespace {

struct Entry {
  const char *vertex, *fragment, *defines;
};
constexpr Entry kPrograms[] = {
#define PROGRAM(name, vertex, fragment, defines) {vertex, fragment, defines},
    FLANEUR_SHADER_PROGRAMS(PROGRAM)
#undef PROGRAM
};
constexpr const char* kModes[] = {
#define MODE(name, defines) defines,
    FLANEUR_SHADER_MODES(MODE)
#undef MODE
};

std::string Defined(std::string_view names) {
  std::istringstream words{std::string(names)};
  std::string out, word;
  while (words >> word) out += "#define " + word + "\n";
  return out;
}

std::string_view TextOf(std::string_view file) {
  const std::vector<ShaderText>& texts = ShaderTexts();
  return std::find_if(texts.begin(), texts.end(), [&](const ShaderText& t) { return t.file == file; })->text;
}

}  // namespace

ShaderSource SourceOf(ShaderProgram program, ShaderMode mode) {
  const Entry& entry = kPrograms[static_cast<size_t>(program)];
  const std::string before = kShaderHeader + Defined(entry.defines) + Defined(kModes[static_cast<size_t>(mode)]);
  return {before + std::string(TextOf(entry.vertex)), before + std::string(TextOf(entry.fragment))};
}

}  // namespace flaneur
