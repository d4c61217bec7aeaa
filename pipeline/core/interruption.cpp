#include "pipeline/core/interruption.h"

#include <signal.h>

#include <array>
#include <atomic>

namespace flaneur {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};

// The handler may touch nothing but lock-free atomics.
std::atomic<int> caught{0};
std::array<std::atomic<pid_t>, 1024> groups{};  // 0: free; children beyond that many are waited for

void OnSignal(int signal) {
  caught = signal;
  for (const auto& group : groups) {
    if (const pid_t id = group; id > 0) ::kill(-id, SIGTERM);
  }
}

}  // namespace

void CatchInterruptions() {
  for (int signal : kSignals) {
    struct sigaction action {};
    ::sigaction(signal, nullptr, &action);
    if (action.sa_handler == SIG_IGN) continue;  // as under nohup
    action = {};
    action.sa_handler = OnSignal;
    action.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);
    ::sigaction(signal, &action, nullptr);
  }
}

Error Interrupted() { return caught ? Fail("interrupted; what was there before is kept") : Ok(); }

void EndAsInterrupted() {
  if (!caught) return;
  ::signal(caught, SIG_DFL);
  ::raise(caught);
}

void EndWithUs(pid_t group) {
  for (auto& slot : groups) {
    pid_t free = 0;
    if (slot.compare_exchange_strong(free, group)) break;
  }
  if (caught) ::kill(-group, SIGTERM);  // it came while the child was starting
}

void Forget(pid_t group) {
  for (auto& slot : groups) {
    pid_t id = group;
    if (slot.compare_exchange_strong(id, 0)) return;
  }
}

}  // namespace flaneur
