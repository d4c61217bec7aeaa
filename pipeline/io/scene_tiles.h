// One town from the tiles of a city.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/core/scene.h"
#include "pipeline/io/scene_reader.h"
#include "runtime/base/error.h"

namespace flaneur {

// Puts tiles together: brings them to one origin, and where they name other systems than the first one into that. What
// stands in two tiles, as buildings on their border do, is taken once: of the same name and shape, or of the same
// shape. Of the same name with another shape both are taken, the later one under a new name. The result does not depend
// on the order of the tiles but in which of two equal things is kept.
class TileJoiner {
 public:
  explicit TileJoiner(Scene* whole);  // empty
  ~TileJoiner();
  // `file`: what messages call it. Errors: with map coordinates among tiles that have none, or the other way round; far
  // from the first one; cannot be brought into its system.
  Error Add(const std::filesystem::path& file, Scene tile);
  void WarnOfTwice(std::vector<std::string>* warnings) const;  // of things that were there already; may be null

 private:
  struct Known;
  std::unique_ptr<Known> known_;
};

// Whether a file has its things on a map, and not about a zero of its own.
bool IsOnMap(const Scene& scene);

// Reads all files and puts them together. `source`: the first one's. Errors: as ReadScene and TileJoiner.
Error ReadTiles(const std::vector<std::filesystem::path>& files, const ReadSceneOptions& options, Scene* scene,
                SceneSource* source, std::vector<std::string>* warnings);

}  // namespace flaneur
