#include "runtime/visit/tour_end.h"

#include "runtime/visit/page_look.h"
#include "runtime/visit/phrases.h"

namespace flaneur {
namespace {

constexpr float kTakesLeave_s = 2.5f;  // of the guide, before the visitor is asked what next

}  // namespace

void FollowTourEnd(const TourPack& pack, const Simulation& s, bool is_asked, float passed_s, TourEnd* end, Controls* c,
                   CameraInput* wishes, Menu* menu) {
  end->over_s = s.visitor.tour.over && c->follows_tour ? end->over_s + passed_s : 0;
  if (end->over_s <= kTakesLeave_s || is_asked) return;
  *wishes = {};
  c->turn_radps = 0;
  const std::string language = PageLanguage(*c, s), thanks = ThanksOf(pack, language);
  OpenEndOfTour(thanks.empty() ? Say(Phrase::kThanks, language) : thanks, menu);
}

}  // namespace flaneur
