// What systemd wants to hear of a service with Type=notify. Internal to runtime/desktop.
#pragma once

namespace flaneur {

// Such as "READY=1" or "WATCHDOG=1", by the protocol of sd_notify(3). Without a service manager nothing happens.
void NotifyServiceManager(const char* state);
bool HasServiceManager();

}  // namespace flaneur
