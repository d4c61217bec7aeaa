#include "runtime/desktop/watchdog.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>

#include "runtime/base/clock.h"
#include "runtime/desktop/service_manager.h"
#include "runtime/desktop/warn.h"

namespace flaneur {
namespace {

constexpr double kBeat_s = 0.2;             // between two signs of life
constexpr int kLook_ms = 250;               // between two looks at them
constexpr double kEnds_s = 3;               // that a player has to end when it is asked to
constexpr double kLongPause_s = 5;          // between two tries, where one after the other fails soon
constexpr double kSoon_s = 10;              // after its first picture
constexpr char kLoads = 'l', kShows = 's';  // signs of life

// Of the process that plays.
int beats_to = -1;
double last_beat_s = 0;
char** own_arguments = nullptr;

// Of the one that watches.
volatile std::sig_atomic_t asked_to_end = 0;
void RememberToEnd(int) { asked_to_end = 1; }

void BecomeBoth() {
  if (HasServiceManager()) std::_Exit(1);  // which starts both again
  Warn("the process that watches the player was lost; starting anew");
  ::execv("/proc/self/exe", own_arguments);
  std::_Exit(1);
}

struct Player {
  pid_t id = -1;
  int beats = -1;
  double began_s = 0, shows_since_s = 0;  // 0: it has not shown a picture yet
  double silent_after_s = 0;              // when its next sign of life is overdue
};

enum class Outcome { kEnds, kCannotBegin, kStartAnew, kFailed };

// In the player: nothing of the watching process' stays. False: this is the watching one.
bool Start(const WatchdogOptions& options, Player* player) {
  int ends[2] = {-1, -1};
  if (::pipe2(ends, O_CLOEXEC) != 0) std::_Exit(1);
  player->id = ::fork();
  if (player->id == 0) {
    ::close(ends[0]);
    beats_to = ends[1];
    ::fcntl(beats_to, F_SETFL, O_NONBLOCK);
    for (int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
    std::signal(SIGPIPE, SIG_IGN);
    return true;
  }
  ::close(ends[1]);
  player->beats = ends[0];
  player->began_s = Now_s();
  player->shows_since_s = 0;
  player->silent_after_s = player->began_s + static_cast<double>(options.begins_s);
  return false;
}

void TakeBeats(const WatchdogOptions& options, Player* player) {
  char beats[64];
  const ssize_t count = ::read(player->beats, beats, sizeof beats);
  if (count <= 0) return;
  const bool shows = std::any_of(beats, beats + count, [](char beat) { return beat == kShows; });
  if (shows && player->shows_since_s <= 0) {
    player->shows_since_s = Now_s();
    NotifyServiceManager("READY=1\nSTATUS=Playing");
  }
  player->silent_after_s =
      Now_s() +
      static_cast<double>(player->shows_since_s > 0 ? options.hang_s : std::max(options.hang_s, options.loads_s));
}

void AskToEnd(Player* player, int* status) {
  NotifyServiceManager("STOPPING=1");
  ::kill(player->id, SIGTERM);
  ::kill(player->id, SIGCONT);  // who is stopped hears nothing
  const double until_s = Now_s() + kEnds_s;
  while (::waitpid(player->id, status, WNOHANG) == 0) {
    if (Now_s() > until_s) ::kill(player->id, SIGKILL);
    ::poll(nullptr, 0, 20);
  }
}

std::string HowItEnded(int status) {
  if (WIFSIGNALED(status)) return std::string("the player crashed (") + ::strsignal(WTERMSIG(status)) + ")";
  return "the player ended with status " + std::to_string(WEXITSTATUS(status));
}

Outcome OutcomeOf(int status, const Player& player) {
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (code == 0) return Outcome::kEnds;
  if (code == kStartAnewStatus) return Outcome::kStartAnew;
  if (code == 2 && player.shows_since_s <= 0) return Outcome::kCannotBegin;
  Warn(HowItEnded(status) + "; starting anew");
  return Outcome::kFailed;
}

// Until it has ended.
Outcome WatchOver(const WatchdogOptions& options, Player* player) {
  int status = 0;
  bool hangs = false;
  double looked_s = Now_s();
  while (::waitpid(player->id, &status, WNOHANG) == 0) {
    if (asked_to_end) {
      AskToEnd(player, &status);
      return Outcome::kEnds;
    }
    pollfd beats{player->beats, POLLIN, 0};
    if (::poll(&beats, 1, kLook_ms) > 0) {
      TakeBeats(options, player);
      if ((beats.revents & POLLHUP) != 0) ::poll(nullptr, 0, 20);  // it is about to end
    }
    // Who could not look for a while, as on a machine that slept, gives the player its time anew.
    const double now_s = Now_s();
    if (now_s - looked_s > 1) player->silent_after_s = std::max(player->silent_after_s, now_s + 2);
    looked_s = now_s;
    NotifyServiceManager("WATCHDOG=1");
    if (hangs || now_s < player->silent_after_s) continue;
    Warn("the player hangs; starting anew");
    ::kill(player->id, SIGKILL);
    hangs = true;
  }
  if (asked_to_end) return Outcome::kEnds;
  return hangs ? Outcome::kFailed : OutcomeOf(status, *player);
}

// Waits while it fails again and again, so that a machine is not busy with that alone.
void WaitBeforeNext(const Player& player, int* failures) {
  const bool soon = player.shows_since_s <= 0 || Now_s() - player.shows_since_s < kSoon_s;
  *failures = soon ? *failures + 1 : 0;
  const double until_s = Now_s() + std::min(kLongPause_s, 0.5 * *failures);
  while (Now_s() < until_s && !asked_to_end) {
    NotifyServiceManager("WATCHDOG=1");
    ::poll(nullptr, 0, 100);
  }
}

}  // namespace

std::optional<int> Watch(const WatchdogOptions& options, char** argv) {
  own_arguments = argv;
  bool has_shown = false;
  for (int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, RememberToEnd);
  for (int failures = 0;;) {
    Player player;
    if (Start(options, &player)) return std::nullopt;
    const Outcome outcome = WatchOver(options, &player);
    ::close(player.beats);
    has_shown = has_shown || player.shows_since_s > 0;
    if (outcome == Outcome::kEnds || asked_to_end) return 0;
    if (outcome == Outcome::kCannotBegin && !has_shown) return 2;
    NotifyServiceManager("STATUS=Starting anew");
    if (outcome != Outcome::kStartAnew) WaitBeforeNext(player, &failures);
  }
}

void TellAlive(bool shows_pictures) {
  if (beats_to < 0) return;
  const double now_s = Now_s();
  if (now_s - last_beat_s < kBeat_s && last_beat_s > 0) return;
  last_beat_s = now_s;
  const char beat = shows_pictures ? kShows : kLoads;
  if (::write(beats_to, &beat, 1) < 0 && errno == EPIPE) BecomeBoth();
}

}  // namespace flaneur
