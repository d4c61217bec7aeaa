// Ending early on Ctrl-C or a request to stop, with nothing half-written left behind.
#pragma once
#include "runtime/base/error.h"

namespace flaneur {

// From now on SIGINT, SIGTERM and SIGHUP no longer end the program at once: CheckInterruption sees them. Where nobody
// looks for a second, in the middle of a picture, the program ends all the same: no file has its name before it is
// whole.
void WatchForInterruption();
// An error once one of them has come.
Error CheckInterruption();
// The same for the last time, before a run's last files are written: each is written to its end.
Error EndWatching();
// A child that would outlive the program where it ends so; 0: none any more.
void EndsWithUs(int process);

}  // namespace flaneur
