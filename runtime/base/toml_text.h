// TOML that is no file.
#pragma once
#include <string>

#include "runtime/base/toml_table.h"

namespace flaneur {

// As ReadToml; `name` stands for the file.
Error ParseToml(const std::string& text, const std::string& name, toml::table* root);

}  // namespace flaneur
