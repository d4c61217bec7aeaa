#include "runtime/visit/one_handed.h"

#include <algorithm>

namespace flaneur {
namespace {

struct HalfKeys {
  Action action;
  std::vector<std::string> keys;
};

const std::vector<HalfKeys>& HalfOf(const std::string& one_handed) {
  static const std::vector<HalfKeys> none;
  static const std::vector<HalfKeys> left_keys{
      {Action::kWalkAhead, {"w"}},   {Action::kWalkBack, {"s"}},  {Action::kTurnLeft, {"a"}},
      {Action::kTurnRight, {"d"}},   {Action::kWalkLeft, {"q"}},  {Action::kWalkRight, {"e"}},
      {Action::kLookUp, {"r"}},      {Action::kLookDown, {"f"}},  {Action::kTour, {"tab"}},
      {Action::kPause, {"space"}},   {Action::kNext, {"c"}},      {Action::kBack, {"x"}},
      {Action::kLanguage, {"g"}},    {Action::kPointer, {"v"}},   {Action::kWider, {"1"}},
      {Action::kNarrower, {"2"}},    {Action::kViews, {"f1"}},    {Action::kAdaptation, {"f2"}},
      {Action::kFullscreen, {"f4"}}, {Action::kMenu, {"escape"}}, {Action::kMap, {"t"}},
      {Action::kPhoto, {"z"}},       {Action::kAsk, {"b"}}};
  static const std::vector<HalfKeys> right_keys{{Action::kWalkAhead, {"up", "i"}},
                                                {Action::kWalkBack, {"down", "k"}},
                                                {Action::kTurnLeft, {"left", "j"}},
                                                {Action::kTurnRight, {"right", "l"}},
                                                {Action::kWalkLeft, {"u"}},
                                                {Action::kWalkRight, {"o"}},
                                                {Action::kLookUp, {"page_up", "p"}},
                                                {Action::kLookDown, {"page_down", "semicolon"}},
                                                {Action::kTour, {"enter"}},
                                                {Action::kPause, {"space"}},
                                                {Action::kNext, {"period"}},
                                                {Action::kBack, {"comma"}},
                                                {Action::kLanguage, {"m"}},
                                                {Action::kPointer, {"n"}},
                                                {Action::kWider, {"minus"}},
                                                {Action::kNarrower, {"equal"}},
                                                {Action::kViews, {"f12"}},
                                                {Action::kAdaptation, {"f9"}},
                                                {Action::kFullscreen, {"f11"}},
                                                {Action::kMenu, {"backspace"}},
                                                {Action::kMap, {"0"}},
                                                {Action::kPhoto, {"9"}},
                                                {Action::kAsk, {"8"}}};
  static const std::vector<HalfKeys> left_pad{{Action::kTour, {"pad_up"}},    {Action::kPause, {"pad_left_stick"}},
                                              {Action::kNext, {"pad_right"}}, {Action::kBack, {"pad_left"}},
                                              {Action::kAsk, {"pad_down"}},   {Action::kMenu, {"pad_back"}}};
  static const std::vector<HalfKeys> right_pad{{Action::kTour, {"pad_y"}},          {Action::kPause, {"pad_a"}},
                                               {Action::kNext, {"pad_b"}},          {Action::kBack, {"pad_x"}},
                                               {Action::kAsk, {"pad_right_stick"}}, {Action::kMenu, {"pad_start"}}};
  return one_handed == "left_keys"    ? left_keys
         : one_handed == "right_keys" ? right_keys
         : one_handed == "left_pad"   ? left_pad
         : one_handed == "right_pad"  ? right_pad
                                      : none;
}

using Keys = std::array<std::vector<std::string>, kActions>;

// A key that somebody gave to an action is no longer another's that merely has its first keys.
Keys WithoutFirstKeysGivenAway(Keys keys) {
  static const Keys first = PlayerSettings{}.keys;
  std::vector<std::string> given;
  for (size_t k = 0; k < kActions; ++k) {
    if (keys[k] != first[k]) given.insert(given.end(), keys[k].begin(), keys[k].end());
  }
  for (size_t k = 0; k < kActions; ++k) {
    if (keys[k] != first[k]) continue;
    std::erase_if(keys[k], [&](const std::string& key) { return std::count(given.begin(), given.end(), key) > 0; });
  }
  return keys;
}

}  // namespace

Keys KeysInForce(const PlayerSettings& settings) {
  Keys keys = WithoutFirstKeysGivenAway(settings.keys);
  const std::vector<HalfKeys>& half = HalfOf(settings.one_handed);
  if (half.empty()) return keys;
  const bool pad = settings.one_handed == "left_pad" || settings.one_handed == "right_pad";
  for (auto& of_action : keys)
    std::erase_if(of_action, [&](const std::string& key) { return IsGamepadCode(InputCode(key)) == pad; });
  for (const HalfKeys& own : half) {
    auto& of_action = keys[static_cast<size_t>(own.action)];
    of_action.insert(of_action.begin(), own.keys.begin(), own.keys.end());
  }
  // Whoever needs them can still point.
  if (!pad) keys[static_cast<size_t>(Action::kMenu)].push_back("mouse_right");
  return keys;
}

StickWishes WishesOfSticks(const WindowInput& input, const PlayerSettings& settings) {
  const bool left = settings.one_handed == "left_pad", right = settings.one_handed == "right_pad";
  if (!left && !right) return {input.left_stick, input.right_stick};
  const Vec2 stick = left ? input.left_stick : input.right_stick;
  const char* shoulder = left ? "pad_left_bumper" : "pad_right_bumper";
  if (input.down[static_cast<size_t>(InputCode(shoulder))]) return {{stick.x, 0}, {0, stick.y}};
  return {{0, stick.y}, {stick.x, 0}};
}

}  // namespace flaneur
