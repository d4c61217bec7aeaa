#include "runtime/desktop/interruption.h"

#include <csignal>

namespace flaneur {
namespace {

volatile std::sig_atomic_t interrupted = 0;
void Remember(int) { interrupted = 1; }

}  // namespace

void WatchForInterruption() {
  for (int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, Remember);
}

Error CheckInterruption() { return interrupted ? Fail("interrupted; nothing was written") : Ok(); }

}  // namespace flaneur
