// The option that says which axis of an OBJ points up.
#pragma once
#include "pipeline/io/scene_reader.h"

namespace CLI {
class App;
}

namespace flaneur {

void AddObjUp(CLI::App* app, UpAxis* up);

}  // namespace flaneur
