// A pack cut into what travels at a time, in the order in which a visitor misses it.
#pragma once
#include <vector>

#include "runtime/pack/tour_pack.h"

namespace flaneur {

struct PackPiece {
  std::vector<ByteRange> parts;  // of the file, one after the other
  bool opens = false;            // the pack is opened with it
  bool first = false;            // a picture with people needs it
};

struct PieceLimits {
  size_t first_town_bytes = 1700 * 1024;  // of the town's meshes and pictures, that come before the first picture
  size_t piece_bytes = 512 * 1024;
};

// All of the file, each byte once: what the player opens it with, the town about where the visit begins, the atlases'
// coarsest levels; the rest of the town, what is near or large first; people's pictures and coarsest levels; sounds;
// atlases; finer levels. file: opened from `bytes` bytes, and pack: read from it with its geometry.
std::vector<PackPiece> PiecesOf(const PackFile& file, const TourPack& pack, size_t bytes,
                                const PieceLimits& limits = {});

}  // namespace flaneur
