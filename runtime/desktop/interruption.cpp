#include "runtime/desktop/interruption.h"

#include <unistd.h>

#include <csignal>

namespace flaneur {
namespace {

constexpr unsigned kPatience_s = 1;
constexpr char kInterrupted[] = "flaneur-player: error: interrupted; nothing more was written\n";

volatile std::sig_atomic_t interrupted = 0, watching = 0, child = 0;

void Remember(int) {
  interrupted = 1;
  if (watching != 0) ::alarm(kPatience_s);
}

// Of what may be called here nothing can wait for the picture.
void Leave(int) {
  if (watching == 0) return;
  if (child > 0) ::kill(static_cast<pid_t>(child), SIGKILL);
  [[maybe_unused]] const auto said = ::write(STDERR_FILENO, kInterrupted, sizeof kInterrupted - 1);
  ::_exit(2);
}

}  // namespace

void WatchForInterruption() {
  watching = 1;
  std::signal(SIGALRM, Leave);
  for (int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, Remember);
}

Error CheckInterruption() { return interrupted != 0 ? Fail("interrupted; nothing more was written") : Ok(); }

Error EndWatching() {
  watching = 0;
  return CheckInterruption();
}

void EndsWithUs(int process) { child = process; }

}  // namespace flaneur
