// Impostor atlases, offline: a person drawn from every direction at every phase of every clip, by
// Blender's Cycles without light, so that the runtime can light the pictures anew.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"
#include "pipeline/core/impostor.h"
#include "runtime/base/error.h"

namespace flaneur {

struct ImpostorClipOptions {
  std::string name;
  int phases = 0;  // 1 to 256, evenly spaced over the clip's duration, the first at its start
};

struct ImpostorOptions {
  int directions = 16;                   // 1 to 64
  std::vector<float> elevations_deg{3};  // 1 to 8 of them, -89 to 89: a grown-up sees a person 15 m away from 3 above
  std::vector<ImpostorClipOptions> clips{{"walk", 8}, {"idle", 2}, {"talk", 2}};
  int work_phases = 2;      // of each further clip that whoever bakes adds
  int height_px = 128;      // of the highest cell, 16 to 1024
  float full_height_m = 0;  // who is lower has lower cells, down to a quarter, with texels as small as at this height
  int border_px = 1;        // left empty around the silhouette in each cell, 1 to 16
  int memory_kb = 6000;  // most on the graphics card: where more is needed, cells are lower, down to half; 0: no limit
  int samples = 16;      // a pixel, 1 to 4096; coverage comes in as many steps
  int seed = 0;          // of the sample pattern, >= 0
  int threads = 0;       // 0: one a core; the atlas does not depend on it
  std::filesystem::path log_file;        // keeps what Blender printed; empty: nobody needs it
  std::function<void(double)> progress;  // gets the share that is done, a few times a second; may be empty
};

struct ImpostorStatistics {
  int frames = 0, cells = 0, triangles = 0;
  int width_px = 0, height_px = 0;  // of the atlas
  double fill_rate = 0;             // share of the atlas's texels that show the person
  size_t memory_bytes = 0;          // of the KTX2 pictures on the graphics card
  double blender_cpu_s = 0, blender_wall_s = 0;
  int64_t blender_peak_memory_bytes = 0;
};

// Poses avatar.meshes as the runtime does, has one Blender render all views into one picture, and
// compresses it. Every cell is cropped to its silhouette and the border; the texel follows from the
// greatest height that any cell shows. Shows base colour texture x base colour x vertex colour;
// masked and blended materials are cut out at alpha_cutoff; single-sided ones are not seen from
// behind. A clip the avatar does not have is left out. The same input gives the same bytes.
// `warnings` (may be null) gets one line for each texture that could not be used. Errors: none of
// the clips, no triangles, an option out of range, more than fits into the memory or into an atlas of
// 8192 px, no Blender, whatever Blender complains of (an unreadable texture).
Error BakeImpostor(const Avatar& avatar, const ImpostorOptions& options, ImpostorAtlas* atlas,
                   ImpostorStatistics* statistics, std::vector<std::string>* warnings = nullptr);

// Writes the KTX2 pictures, the PNG ones, and impostor.json (the atlas's other fields by
// their names) into `folder`, which is made where missing; nothing in it is touched before all are
// complete. Errors: a file in the way, no permission, disk full.
Error WriteImpostor(const std::filesystem::path& folder, const ImpostorAtlas& atlas);

}  // namespace flaneur
