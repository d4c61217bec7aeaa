// Child processes that must not outlive this one, not even where it is killed without a chance to end them. A small
// process of our own waits for our end and then kills their groups. Internal to pipeline/core.
#pragma once
#include <sys/types.h>

namespace flaneur {

// The process group ends, at the latest, with this process.
void KeepGroup(pid_t group);
// It has ended: its number may come to mean another one. Before its leader is reaped.
void ReleaseGroup(pid_t group);

}  // namespace flaneur
