// Which clips besides walk, idle and talk people need: those of the places of work and of flocks, and no others, so
// that nothing is baked that nobody does.
#pragma once
#include <string>
#include <vector>

#include "pipeline/cli/tour_settings.h"
#include "pipeline/pack/write_tour_pack.h"
#include "runtime/base/error.h"

namespace flaneur {

// Leaves of each avatar's clips those that a place of work or a flock has them do, and adds what places name and
// tour.toml does not describe. `warnings`: places that name somebody whom there is not. Errors: an avatar with more
// than kMaxOtherClips.
Error ChooseWorkClips(const std::vector<Place>& places, const std::vector<Flock>& flocks,
                      std::vector<AvatarSettings>* avatars, std::vector<std::string>* warnings);

// A line for each clip that places ask for and nobody has who may be there; for a play with the speed of a run.
std::vector<std::string> WarningsOfWork(const TourParts& tour);

}  // namespace flaneur
