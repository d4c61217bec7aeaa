// Every shader program in every variant, as the driver gets it. Internal to runtime/render; for the test that compiles them all.
#pragma once
#include <string>
#include <vector>

#include "runtime/base/error.h"

namespace flaneur {

struct ShaderSource { bool vertex = false; std::string text; };

// While on, BuildProgram keeps what it hands to the driver.
void KeepShaderSources(bool on);
const std::vector<ShaderSource>& KeptShaderSources();

}  // namespace flaneur
