#include "runtime/player/notices.h"

#include <algorithm>

#include "runtime/player/menu.h"
#include "runtime/player/phrases.h"

namespace flaneur {
namespace {

constexpr float kHint_s = 14, kHintOnceWalking_s = 2.5f;
constexpr float kNotice_s = 4, kLeaves_s = 0.4f;

std::string Fill(const char* format, const std::string& text) {
  std::string filled = format;
  if (const size_t at = filled.find("%s"); at != std::string::npos) filled.replace(at, 2, text);
  return filled;
}

std::string FirstKey(const Controls& c, Action action, const std::string& language) {
  const auto& codes = c.codes[static_cast<size_t>(action)];
  return codes.empty() ? "" : KeyName(InputLabel(codes.front()), language);
}

void Tell(const std::string& text, Notices* n) {
  n->text = text;
  n->left_s = kNotice_s;
  n->is_hint = false;
}

}  // namespace

void BeginHint(const Controls& c, const Simulation& s, Notices* n) {
  const std::string language = PageLanguage(c, s);
  std::string keys;
  for (Action action : {Action::kWalkAhead, Action::kWalkLeft, Action::kWalkBack, Action::kWalkRight}) {
    const std::string key = FirstKey(c, action, language);
    if (!key.empty()) keys += (keys.empty() ? "" : ", ") + key;
  }
  n->text = c.points ? Say(Phrase::kHintTouch, language) : Fill(Say(Phrase::kHintKeys, language), keys);
  const std::string pages = FirstKey(c, Action::kMenu, language);
  if (!c.points && !pages.empty()) n->text += " " + Fill(Say(Phrase::kHintMenu, language), pages);
  n->left_s = kHint_s;
  n->is_hint = true;
  n->follows = c.follows_tour;
  n->paused = s.tour.paused;
  n->over = s.tour.over;
}

void FollowNotices(const Controls& c, const Simulation& s, float passed_s, Notices* n) {
  n->left_s = std::max(0.0f, n->left_s - passed_s);
  if (n->is_hint && c.acted) n->left_s = std::min(n->left_s, kHintOnceWalking_s);
  const std::string language = PageLanguage(c, s);
  if (HasTour(s.tour)) {
    if (s.tour.paused && !n->paused) Tell(Fill(Say(Phrase::kTourPaused, language), FirstKey(c, Action::kPause, language)), n);
    if (n->paused && !s.tour.paused && c.follows_tour) Tell(Say(Phrase::kTourGoesOn, language), n);
    if (n->follows && !c.follows_tour) Tell(Fill(Say(Phrase::kTourLeft, language), FirstKey(c, Action::kTour, language)), n);
    if (!n->follows && c.follows_tour) Tell(Say(Phrase::kTourGoesOn, language), n);
  }
  if (s.tour.over && !n->over) Tell(Say(Phrase::kTourOver, language), n);
  n->paused = s.tour.paused;
  n->follows = c.follows_tour;
  n->over = s.tour.over;
}

void ShowNotice(const Notices& n, bool fades, FrameInput* frame) {
  if (n.left_s <= 0 || (n.is_hint && !frame->caption.empty())) return;
  frame->caption = n.text;
  frame->caption_share = fades ? std::min(1.0f, n.left_s / kLeaves_s) : 1;
}

}  // namespace flaneur
