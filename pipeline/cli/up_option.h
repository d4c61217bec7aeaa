// The option that says which axis of a town's file points up.
#pragma once
#include <string>

#include "pipeline/io/scene_reader.h"

namespace CLI {
class App;
}

namespace flaneur {

void AddUp(CLI::App* app, UpAxis* up);

// What the option and tour.toml call it: "y", "-z", ...; empty: judged.
UpAxis UpAxisNamed(const std::string& name);

}  // namespace flaneur
