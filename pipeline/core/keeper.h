// Child processes that must not outlive this one, not even where it is killed without a chance to end them. A small
// process of our own waits for our end and then kills their groups. Internal to pipeline/core.
#pragma once
#include <sys/types.h>

namespace flaneur {

// Where a child tells the keeper, which is started by the first call; -1: there is none. Before it is forked.
int ToKeeper();
// In the child, before it becomes another program: its group ends, at the latest, with the process that made
// `to_keeper`. Takes no lock. What would be told by the parent might be told too late: the program runs already.
void KeepOwnGroup(int to_keeper);
// It has ended: its number may come to mean another one. Before its leader is reaped.
void ReleaseGroup(pid_t group);

}  // namespace flaneur
