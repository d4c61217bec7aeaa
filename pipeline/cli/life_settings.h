// What tour.toml says of a town's life besides its people. Internal to pipeline/cli.
#pragma once
#include "runtime/base/toml_table.h"
#include "runtime/tour_data/tour_data.h"

namespace flaneur {

// [[flock]], [[smoke]]. What is wrong is refused by the tables.
void ReadLifeSettings(TomlTable* root, TourData* tour);

}  // namespace flaneur
