// A tour in a tenth of the time: everything is there, coarsely. Internal to pipeline/cli.
#pragma once
#include "pipeline/cli/tour_settings.h"

namespace flaneur {

// Impostors from few sides and one phase, and levels that are fitted less.
void MakeDraft(TourSettings* settings);

}  // namespace flaneur
