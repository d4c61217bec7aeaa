#include "runtime/visit/controls.h"

#include <algorithm>
#include <cmath>

#include "runtime/visit/kiosk.h"
#include "runtime/visit/one_handed.h"
#include "runtime/walk/point_walk.h"

namespace flaneur {
namespace {

constexpr float kRadiansPerPixel = 0.0025f;
constexpr float kMaxPitch_rad = 1.2f;
constexpr float kStickDeadZone = 0.18f;  // sticks at rest are not quite at rest
constexpr float kViewStep_deg = 5, kMinFieldOfView_deg = 30, kMaxFieldOfView_deg = 120;
constexpr float kCalmSnap_deg = 30;  // of keys and sticks with less motion: a view that flows makes some people ill
constexpr float kRadians = kPi / 180;

struct Held {
  const WindowInput& input;
  Controls* controls;

  bool Down(Action action) const {
    const auto& codes = controls->codes[static_cast<size_t>(action)];
    return std::any_of(codes.begin(), codes.end(), [&](int code) { return input.down[static_cast<size_t>(code)]; });
  }
  float Axis(Action more, Action less) const { return static_cast<float>(Down(more)) - static_cast<float>(Down(less)); }
  bool Pressed(Action action) const { return Down(action) && !controls->was_down[static_cast<size_t>(action)]; }
};

Vec2 FromStick(Vec2 stick) {
  const float length = Length(stick);
  if (length < kStickDeadZone) return {};
  return stick * (std::min(1.0f, (length - kStickDeadZone) / (1 - kStickDeadZone)) / length);
}

void TurnAndLook(const Held& held, float passed_s, Controls* c) {
  const PlayerSettings& s = c->settings;
  const float inverted = s.invert_look ? -1.0f : 1.0f, mouse = kRadiansPerPixel * s.mouse_speed;
  // Dragging takes the picture along; a caught mouse takes the eye along.
  const float drag = c->points ? -1.0f : 1.0f;
  const Vec2 stick = FromStick(WishesOfSticks(held.input, s).look);
  c->to_turn_rad -= drag * mouse * held.input.turned_px.x;
  c->to_look_rad -= drag * mouse * held.input.turned_px.y * inverted;
  c->to_look_rad += kRadians * s.turn_speed_dps * passed_s *
                    std::clamp(held.Axis(Action::kLookUp, Action::kLookDown) + stick.y * inverted, -1.0f, 1.0f);
  const float turn = std::clamp(held.Axis(Action::kTurnLeft, Action::kTurnRight) - stick.x, -1.0f, 1.0f);
  const float snap_deg = s.snap_turn_deg <= 0 && s.reduced_motion ? kCalmSnap_deg : s.snap_turn_deg;
  if (snap_deg <= 0) {
    c->turn_radps = kRadians * s.turn_speed_dps * turn;
    return;
  }
  constexpr float kPushed = 0.6f, kReleased = 0.3f;
  if (std::abs(turn) > kPushed && c->snap_ready) c->to_turn_rad += std::copysign(kRadians * snap_deg, turn);
  if (std::abs(turn) > kPushed) c->snap_ready = false;
  if (std::abs(turn) < kReleased) c->snap_ready = true;
  c->turn_radps = 0;
}

void Walk(const Held& held, float yaw_rad, Controls* c, CameraInput* camera) {
  const Vec2 stick = FromStick(WishesOfSticks(held.input, c->settings).walk);
  const Vec2 keys{held.Axis(Action::kWalkRight, Action::kWalkLeft), held.Axis(Action::kWalkAhead, Action::kWalkBack)};
  const Vec2 way = keys + stick;
  const float share = std::min(1.0f, Length(way));
  const Vec2 ahead{std::cos(yaw_rad), std::sin(yaw_rad)}, right{ahead.y, -ahead.x};
  const Vec2 wanted = ahead * way.y + right * way.x;
  camera->direction = share > 0 ? wanted * (1 / Length(wanted)) : Vec2{};
  camera->walk_to_mps = c->settings.walk_speed_mps * c->settings.pace;
  camera->speed_mps = share * camera->walk_to_mps;
  if (share > 0) c->follows_tour = false;
}

void ChangeView(const Held& held, const Simulation& s, Controls* c) {
  const float step =
      static_cast<float>(held.Pressed(Action::kWider)) - static_cast<float>(held.Pressed(Action::kNarrower));
  if (step == 0) return;
  const float now_deg = s.visitor.camera.view.fov_rad / kRadians;
  c->settings.field_of_view_deg =
      std::clamp(std::round(now_deg) + kViewStep_deg * step, kMinFieldOfView_deg, kMaxFieldOfView_deg);
  c->changed = c->applies = true;
}

void NextLanguage(const Simulation& s, Controls* c) {
  const std::vector<std::string>& all = c->offered_languages.empty() ? s.visitor.tour.languages : c->offered_languages;
  if (all.size() < 2) return;
  const std::string& language = c->settings.language.empty() ? s.visitor.tour.language : c->settings.language;
  const size_t now = static_cast<size_t>(std::find(all.begin(), all.end(), language) - all.begin());
  c->settings.language = all[(now + 1) % all.size()];
  c->changed = c->applies = true;
}

// Whatever asks something of the tour leads back to it.
void AskTour(const Held& held, const Simulation& s, Controls* c, TourWish* wish) {
  if (s.visitor.legs.empty() && s.visitor.tour.stops.empty()) return;
  const bool was_led = c->follows_tour, holds = held.Pressed(Action::kPause);
  const bool next = held.Pressed(Action::kNext), back = held.Pressed(Action::kBack);
  if (held.Pressed(Action::kTour)) c->follows_tour = !was_led;
  if (holds || next || back) c->follows_tour = true;
  if (holds && was_led) wish->toggle_pause = !wish->toggle_pause;
  wish->next = wish->next || next;
  wish->back = wish->back || back;
}

// A kiosk is closed by its operator alone.
bool Closes(const WindowInput& input, const Controls& c) { return input.close && !c.settings.kiosk; }

void Press(const Held& held, const Simulation& s, Controls* c, CameraInput* camera) {
  AskTour(held, s, c, &camera->tour);
  if (held.Pressed(Action::kLanguage)) NextLanguage(s, c);
  if (held.Pressed(Action::kPointer)) {
    c->points = !c->points;
    c->settings.pointer = c->points ? "point" : "look";
    c->changed = c->applies = true;
  }
  c->toggles_views = c->toggles_views || held.Pressed(Action::kViews);
  c->switches_adaptation = c->switches_adaptation || held.Pressed(Action::kAdaptation);
  if (held.Pressed(Action::kFullscreen)) {
    c->settings.fullscreen = !c->settings.fullscreen;
    c->changed = true;
  }
  ChangeView(held, s, c);
  c->opens_pages = c->opens_pages || held.Pressed(Action::kMenu);
  c->opens_map = c->opens_map || held.Pressed(Action::kMap);
  c->takes_photo = c->takes_photo || held.Pressed(Action::kPhoto);
  c->asks = c->asks || held.Pressed(Action::kAsk);
  c->quits = c->quits || Closes(held.input, *c) || held.Pressed(Action::kQuit);
}

}  // namespace

void TakeKeys(Controls* c) {
  const auto keys = KeysInForce(c->settings);
  for (size_t k = 0; k < kActions; ++k) {
    c->codes[k].clear();
    if (c->settings.kiosk && IsLocked(static_cast<Action>(k))) continue;
    for (const std::string& key : keys[k]) c->codes[k].push_back(InputCode(key));
  }
}

Controls MakeControls(const PlayerSettings& settings, const KeyLayout& layout, const Simulation& s) {
  Controls c;
  c.layout = layout;
  c.settings = settings;
  c.points = settings.pointer == "point";
  c.follows_tour = !s.visitor.legs.empty() || !s.visitor.tour.stops.empty();
  TakeKeys(&c);
  return c;
}

bool Rebind(Action action, int code, Controls* c) {
  const std::string name = InputName(code);
  const auto& of_pages = c->codes[static_cast<size_t>(Action::kMenu)];
  if (name.empty() || std::find(of_pages.begin(), of_pages.end(), code) != of_pages.end()) return false;
  c->settings.keys = KeysInForce(c->settings);  // from here on they are the visitor's own
  c->settings.one_handed = "off";
  for (auto& keys : c->settings.keys) std::erase(keys, name);
  auto& keys = c->settings.keys[static_cast<size_t>(action)];
  std::erase_if(keys, [&](const std::string& key) { return IsGamepadCode(InputCode(key)) == IsGamepadCode(code); });
  keys.push_back(name);
  TakeKeys(c);
  c->changed = true;
  return true;
}

void ResetKeys(Controls* c) {
  c->settings.keys = PlayerSettings().keys;
  c->settings.one_handed = "off";
  TakeKeys(c);
  c->changed = true;
}

void TakeInput(const WindowInput& input, float passed_s, float aspect, bool pages, const Simulation& s, Controls* c,
               CameraInput* camera) {
  const Held held{input, c};
  if (pages) {
    c->quits = c->quits || Closes(input, *c);
  } else {
    Press(held, s, c, camera);
    TurnAndLook(held, passed_s, c);
    Walk(held, s.visitor.camera.view.yaw_rad, c, camera);
  }
  for (const Vec2& click : input.clicks) {
    camera->walk_to = GroundAt(s.town.walkable, s.visitor.camera, click, aspect);
    if (camera->walk_to) c->follows_tour = false;
  }
  c->acted =
      c->acted || camera->speed_mps > 0 || Length(input.turned_px) > 0 || c->turn_radps != 0 || !input.clicks.empty();
  for (size_t k = 0; k < kActions; ++k) c->was_down[k] = held.Down(static_cast<Action>(k));
}

CameraInput NextStep(const CameraInput& camera, const Simulation& s, Controls* c) {
  CameraInput step = camera;
  step.active = !c->follows_tour || (s.visitor.finished && !s.visitor.tour.over);
  const float most_rad = MaxYawRate_radps(s.control.settings) * Step_s(s);
  const float held_rad = std::clamp(c->turn_radps * Step_s(s), -most_rad, most_rad);
  const float turn_rad = std::clamp(c->to_turn_rad + held_rad, -most_rad, most_rad);
  c->to_turn_rad -= turn_rad - held_rad;
  c->turned_rad += turn_rad - held_rad;
  // What is turned faster than people can be readied for is caught up with, but not for long.
  c->to_turn_rad = std::clamp(c->to_turn_rad, -kPi / 2, kPi / 2);
  step.yaw_rate_radps = turn_rad / Step_s(s);
  step.pitch_rad = std::clamp(s.visitor.camera.pitch_rad + c->to_look_rad, -kMaxPitch_rad, kMaxPitch_rad);
  c->to_look_rad = 0;
  return step;
}

float TurnUntil(float share, const Simulation& s, const Controls& c) {
  const float most_rad = MaxYawRate_radps(s.control.settings) * Step_s(s) * share;
  return std::clamp(c.to_turn_rad, -most_rad, most_rad);
}

float LookUntilNow(const Simulation& s, const Controls& c) {
  return std::clamp(s.visitor.camera.pitch_rad + c.to_look_rad, -kMaxPitch_rad, kMaxPitch_rad) -
         s.visitor.camera.pitch_rad;
}

}  // namespace flaneur
