#include "runtime/visit/notices.h"

#include <algorithm>

#include "runtime/visit/page_look.h"
#include "runtime/visit/phrases.h"

namespace flaneur {
namespace {

constexpr float kHint_s = 14, kHintOnceWalking_s = 2.5f;
constexpr float kNotice_s = 4, kLeaves_s = 0.4f;

std::string FirstKey(const Controls& c, Action action, const std::string& language) {
  const auto& codes = c.codes[static_cast<size_t>(action)];
  return codes.empty() ? "" : KeyName(InputLabel(codes.front(), c.layout), language);
}

// Who has no keys has a button that leads to the pages, and there on.
std::string HowTo(const Controls& c, Action action, const std::string& language) {
  return c.points ? Say(Phrase::kCornerButton, language) : FirstKey(c, action, language);
}

void Tell(const std::string& text, Notices* n) {
  n->text = text;
  n->left_s = kNotice_s;
  n->is_hint = n->gives_way = false;
}

void Remember(const Controls& c, const Simulation& s, Notices* n) {
  n->paused = s.visitor.tour.paused;
  n->follows = c.follows_tour;
  n->over = s.visitor.tour.over;
  n->halt = HaltOf(s.visitor.tour);
  n->language = s.visitor.tour.language;
}

Phrase HintFor(const Controls& c, const Simulation& s) {
  const bool led = c.follows_tour && HasTour(s.visitor.tour);
  if (c.points) return led ? Phrase::kHintLedTouch : Phrase::kHintTouch;
  return led ? Phrase::kHintLedKeys : Phrase::kHintKeys;
}

bool IsAsBefore(const Controls& c, const Simulation& s, const Notices& n) {
  const GuidedTour& t = s.visitor.tour;
  return n.paused == t.paused && n.follows == c.follows_tour && n.over == t.over && n.halt == HaltOf(t);
}

void TellOfTour(const Controls& c, const Simulation& s, const std::string& language, Notices* n) {
  const GuidedTour& t = s.visitor.tour;
  const bool goes = c.follows_tour && !t.paused, went = n->follows && !n->paused;
  if (t.paused && !n->paused) Tell(Say(Phrase::kTourPaused, language, {FirstKey(c, Action::kPause, language)}), n);
  if (n->follows && !c.follows_tour) Tell(Say(Phrase::kTourLeft, language, {HowTo(c, Action::kTour, language)}), n);
  if (goes && !went) Tell(Say(Phrase::kTourGoesOn, language), n);
  const std::string next = NameOfStop(t, HaltOf(t));
  if (n->halt == HaltOf(t) || !goes || next.empty()) return;
  Tell(Say(Phrase::kNextStop, language, {next}), n);
  n->gives_way = true;
}

// The keys of these actions, one of each.
std::string KeysOf(std::initializer_list<Action> actions, const Controls& c, const std::string& language) {
  std::string keys;
  for (const Action action : actions) {
    const std::string key = FirstKey(c, action, language);
    if (!key.empty()) keys += (keys.empty() ? "" : ", ") + key;
  }
  return keys;
}

}  // namespace

void BeginHint(const Controls& c, const Simulation& s, Notices* n) {
  const std::string language = PageLanguage(c, s);
  const bool one_hand = c.settings.one_handed == "left_keys" || c.settings.one_handed == "right_keys";
  if (one_hand && !c.points)
    n->text = Say(Phrase::kHintOneHand, language,
                  {KeysOf({Action::kWalkAhead, Action::kWalkBack}, c, language),
                   KeysOf({Action::kTurnLeft, Action::kTurnRight}, c, language)});
  else
    n->text =
        Say(HintFor(c, s), language,
            {KeysOf({Action::kWalkAhead, Action::kWalkLeft, Action::kWalkBack, Action::kWalkRight}, c, language)});
  const std::string pages = FirstKey(c, Action::kMenu, language);
  if (!c.points && !pages.empty()) n->text += " " + Say(Phrase::kHintMenu, language, {pages});
  n->left_s = kHint_s;
  n->is_hint = n->gives_way = true;
  Remember(c, s, n);
}

void FollowNotices(const Controls& c, const Simulation& s, float passed_s, Notices* n) {
  n->left_s = std::max(0.0f, n->left_s - passed_s);
  if (n->is_hint && c.acted) n->left_s = std::min(n->left_s, kHintOnceWalking_s);
  const std::string language = PageLanguage(c, s);
  if (!n->is_hint && !IsAsBefore(c, s, *n)) n->left_s = 0;  // what it says may be so no longer
  if (HasTour(s.visitor.tour)) TellOfTour(c, s, language, n);
  if (s.visitor.tour.over && !n->over) Tell(Say(Phrase::kTourOver, language), n);
  if (s.visitor.tour.language != n->language && !n->is_hint)
    Tell(Say(Phrase::kPair, language, {Say(Phrase::kLanguage, language), LanguageName(language)}), n);
  Remember(c, s, n);
}

void TellNotice(const std::string& text, const Controls& c, const Simulation& s, Notices* n) {
  Tell(text, n);
  Remember(c, s, n);
}

void ShowNotice(const Notices& n, bool fades, bool caption_stays, FrameInput* frame) {
  if (n.left_s <= 0 || (n.gives_way && !frame->caption.empty())) return;
  if (caption_stays && !frame->caption.empty()) {
    frame->caption = n.text + "\n" + frame->caption;
    return;
  }
  frame->caption = n.text;
  frame->caption_passed = -1;
  frame->caption_share = fades ? std::min(1.0f, n.left_s / kLeaves_s) : 1;
}

}  // namespace flaneur
