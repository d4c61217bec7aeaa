#include "runtime/visit/leading.h"

#include "runtime/base/array.h"
#include "runtime/visit/page_look.h"
#include "runtime/visit/phrases.h"

namespace flaneur {
namespace {

constexpr float kTappedReach_m = 25;  // from a place tapped on the map to where one can walk

void Tell(const std::string& text, const LeadingIn& in) { TellNotice(text, in.controls, in.s, &in.notices); }

}  // namespace

void LeadToStop(size_t stop, const LeadingIn& in) {
  in.wishes.tour.lead_to = stop;
  in.controls.follows_tour = true;
  in.leading.led = false;
  Tell(Say(Phrase::kLedTo, PageLanguage(in.controls, in.s), {NameOfStop(in.s.visitor.tour, stop)}), in);
}

void LeadToPlace(Vec2 place, const LeadingIn& in) {
  const Walkable& w = in.s.town.walkable;
  const std::string language = PageLanguage(in.controls, in.s);
  const int cell = IsFree(w, place) ? CellAt(w, place) : NearestFreeCell(w, place, kTappedReach_m);
  const int own = NearestFreeCell(w, in.s.visitor.camera.view.position, kTappedReach_m);
  if (cell < 0 || own < 0 || At(w.component, cell) != At(w.component, own))
    return Tell(Say(Phrase::kNoWay, language), in);
  in.wishes.walk_to = IsFree(w, place) ? place : CellCenter(w, cell);
  in.controls.follows_tour = false;
  in.leading.led = true;
  Tell(Say(Phrase::kLedThere, language), in);
}

void StopWhereAsked(const WindowInput& input, const LeadingIn& in) {
  Leading& l = in.leading;
  const std::bitset<kInputCodes> pressed = input.down & ~l.was_down;
  l.was_down = input.down;
  l.led = l.led && (in.wishes.walk_to || !in.s.visitor.point_walk.route.points.empty());
  if (!l.led || in.wishes.walk_to || (pressed.none() && input.clicks.empty())) return;
  l.led = false;
  in.wishes.walk_to = in.s.visitor.camera.view.position;
}

}  // namespace flaneur
