// The options that bake, plan and step share. Internal to pipeline/cli.
#pragma once
#include "pipeline/cli/bake.h"

namespace CLI {
class App;
}

namespace flaneur {

void AddPlaces(CLI::App* app, BakeOptions* options);  // where results and the cache are, and what may be read
void AddLimits(CLI::App* app, BakeOptions* options);  // how much at a time

}  // namespace flaneur
