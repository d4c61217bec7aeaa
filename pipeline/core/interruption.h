// Ctrl-C and polite requests to end. Work in progress stops at the next good place, so that temporary files go, child
// processes end and nothing stays half-written.
#pragma once
#include <sys/types.h>

#include "runtime/base/error.h"

namespace flaneur {

// From now on the first SIGINT, SIGTERM or SIGHUP ends the child processes and lets Interrupted() say so; a second one
// ends this process at once.
void CatchInterruptions();

// An error once a signal came, else none. For loops and between the steps of long work.
Error Interrupted();

// Ends this process by the signal that came, as whoever sent it expects; returns where none came.
void EndAsInterrupted();

// The process group of a running child, which ends with the first signal. Forget it before its leader is reaped.
void EndWithUs(pid_t group);
void Forget(pid_t group);

}  // namespace flaneur
