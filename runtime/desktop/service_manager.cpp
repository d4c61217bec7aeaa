#include "runtime/desktop/service_manager.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace flaneur {
namespace {

const char* SocketName() { return std::getenv("NOTIFY_SOCKET"); }

}  // namespace

bool HasServiceManager() { return SocketName() != nullptr; }

void NotifyServiceManager(const char* state) {
  sockaddr_un address{};
  const char* name = SocketName();
  if (name == nullptr || (name[0] != '/' && name[0] != '@') || std::strlen(name) >= sizeof address.sun_path) return;
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, name, sizeof address.sun_path - 1);
  if (name[0] == '@') address.sun_path[0] = 0;  // a name of its own space, not a file's
  const int to = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (to < 0) return;
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + std::strlen(name));
  // Who does not listen just now hears the next one.
  static_cast<void>(!::sendto(to, state, std::strlen(state), MSG_NOSIGNAL | MSG_DONTWAIT,
                              reinterpret_cast<const sockaddr*>(&address), length));
  ::close(to);
}

}  // namespace flaneur
