// Two processes: one plays, the other watches it, and starts it anew when it ends otherwise than it should or its
// pictures stop. The watching one tells systemd too, where that has started it.
#pragma once
#include <optional>

namespace flaneur {

struct WatchdogOptions {
  float hang_s = 5;     // without a picture
  float begins_s = 30;  // without the first sign of life
  float loads_s = 10;   // without another one before the first picture
};

// Exit status of a player that wants to be started again at once.
inline constexpr int kStartAnewStatus = 75;

// Call before anything else has been begun: no thread, no window. Returns nothing in the process that plays. In the one
// that watches it returns when all is over: the exit status, 0 where the player ended by itself or a signal asked for
// it, 2 where it could not even begin. Whoever plays and loses the other one becomes both again, by `argv`.
std::optional<int> Watch(const WatchdogOptions& options, char** argv);

// Of the process that plays, as often as it likes; without Watch nothing happens.
void TellAlive(bool shows_pictures);

}  // namespace flaneur
