// Ending early on Ctrl-C or a request to stop, with nothing half-written left behind.
#pragma once
#include "runtime/base/error.h"

namespace flaneur {

// From now on SIGINT, SIGTERM and SIGHUP no longer end the program at once: CheckInterruption sees them.
void WatchForInterruption();
// An error once one of them has come.
Error CheckInterruption();

}  // namespace flaneur
