// How like the full geometry a person's coarser levels and impostor look, each at its switch distance.
#pragma once
#include <string>
#include <vector>

#include "runtime/likeness/contact_sheet.h"
#include "runtime/likeness/portraits.h"

namespace flaneur {

struct MeasureOptions {
  int headings = 32, phases = 8, suns = 3;  // 1 or more each; at most 3 suns
  float between = 0;                        // moves every phase and every heading on by so much of their spacing
  ClipKind clip = ClipKind::kWalk;          // of who is never seen to walk, instead of it: kIdle
  bool impostors_only = false;
  float person_px = 0;  // height on screen where all are compared; 0: each at its switch distance
  int sheet_columns = 8;
};

struct LevelLikeness {
  Level level;
  float person_px = 0;   // height on screen where compared
  Likeness mean, worst;  // of all pictures, each figure for itself
};

struct AvatarLikeness {
  std::string name;
  std::vector<LevelLikeness> levels;
  std::vector<std::vector<SheetPair>> sheet;  // a row a level
};

AvatarLikeness Measure(const MeasureOptions& options, int avatar, PortraitStudio* studio);

}  // namespace flaneur
