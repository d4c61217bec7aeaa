// Visitors of a kiosk, one after the other: they come to a screen that shows itself, touch it or press a key, walk,
// look about, open pages, map and photos, ask what things are, guess the operator's PIN, and go. The same for the same
// seed.
#pragma once
#include <deque>
#include <random>

#include "runtime/visit/window_input.h"

namespace flaneur {

// No visitor types one of these.
inline constexpr const char* kPinOfNobody = "479947";

class KioskVisitors {
 public:
  explicit KioskVisitors(uint64_t seed) : random_(seed) {}

  // For the next picture, passed_s after the one before. waits: nobody is there as far as the kiosk knows.
  WindowInput Next(bool waits, float passed_s);
  bool does_something() const { return busy_; }  // else hands are still
  long visitors() const { return visitors_; }

 private:
  struct Moment {
    WindowInput hands;
    float seconds = 0;
  };
  float Between(double least, double most) {
    return static_cast<float>(std::uniform_real_distribution<double>(least, most)(random_));
  }
  int Below(int end) { return static_cast<int>(random_() % static_cast<uint64_t>(end)); }
  void Plan();
  void Hold(std::initializer_list<const char*> keys, float seconds);
  void Tap(const char* key);
  void Rest(float seconds);
  void Touch(Vec2 at);
  void Drag();
  void UsePages();
  void GuessPin();

  std::mt19937_64 random_;
  std::deque<Moment> plan_;
  float stays_s_ = 0;  // left, of who is there
  bool busy_ = false;
  long visitors_ = 0;
};

}  // namespace flaneur
