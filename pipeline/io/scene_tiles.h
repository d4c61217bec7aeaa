// One town from the tiles of a city.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/core/scene.h"
#include "pipeline/io/scene_reader.h"
#include "runtime/base/error.h"

namespace flaneur {

// Reads all files, brings them to one origin, and where they name other systems than the first one into that. What
// stands in two tiles, as buildings on their border do, is taken once: of the same name and shape, or of the same
// shape. Of the same name with another shape both are taken, the later one under a new name. The result does not depend
// on the order of the files but in which of two equal things is kept. Errors: as ReadScene; a file without map
// coordinates among others that have some (names it).
Error ReadTiles(const std::vector<std::filesystem::path>& files, const ReadSceneOptions& options, Scene* scene,
                SceneSource* source, std::vector<std::string>* warnings);

}  // namespace flaneur
