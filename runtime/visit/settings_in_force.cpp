#include "runtime/visit/settings_in_force.h"

#include <algorithm>

#include "runtime/visit/page_look.h"

namespace flaneur {

std::string SpokenLanguage(const PlayerSettings& chosen, const GuidedTour& tour) {
  const std::vector<std::string>& known = tour.languages;
  const bool spoken = std::find(known.begin(), known.end(), chosen.language) != known.end();
  return spoken ? chosen.language : known.empty() ? tour.language : known.front();
}

void HeedSettings(const PlayerSettings& chosen, const OwnView& own, Simulation* s) {
  s->visitor.gentle = chosen.reduced_motion;
  s->visitor.comfort = {chosen.pace, chosen.captions_always, chosen.high_contrast};
  s->visitor.camera.eye_height_m = EyeHeight_m(chosen, own.eye_m);
  SetFieldOfView(chosen.field_of_view_deg > 0 ? chosen.field_of_view_deg * kPi / 180 : own.fov_rad, s);
  const std::string language = SpokenLanguage(chosen, s->visitor.tour);
  if (language != s->visitor.tour.language) SetLanguage(language, &s->visitor.tour);
}

}  // namespace flaneur
