#include "pipeline/core/keeper.h"

#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <mutex>

namespace flaneur {
namespace {

int owners_end = -1;
pid_t keeper = 0;

// In the keeper. It was forked from a process with threads, so it may call nothing that takes a lock.
[[noreturn]] void WatchOver(int from_owner) {
  ::setsid();  // what ends our owner's group must not end it too
  for (int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) ::signal(signal, SIG_IGN);
  ::dup2(from_owner, STDIN_FILENO);
  ::close_range(STDOUT_FILENO, ~0u, 0);  // whoever waits for the end of our owner's output must not wait for it
  std::array<pid_t, 1024> groups{};
  for (;;) {
    pid_t told = 0;
    const ssize_t size = ::read(STDIN_FILENO, &told, sizeof told);
    if (size < 0 && errno == EINTR) continue;
    if (size != static_cast<ssize_t>(sizeof told)) break;
    const pid_t find = told > 0 ? 0 : -told, put = told > 0 ? told : 0;
    for (pid_t& group : groups) {
      if (group != find) continue;
      group = put;
      break;
    }
  }
  for (const pid_t group : groups) {
    if (group > 0) ::kill(-group, SIGKILL);
  }
  ::_exit(0);
}

void LetKeeperGo() {
  ::close(owners_end);
  ::waitpid(keeper, nullptr, 0);
}

void StartKeeper() {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) return;
  keeper = ::fork();
  if (keeper == 0) {
    ::close(ends[1]);
    WatchOver(ends[0]);
  }
  ::close(ends[0]);
  if (keeper < 0) {
    ::close(ends[1]);
    return;
  }
  owners_end = ends[1];
  std::atexit(LetKeeperGo);
}

void Tell(int to_keeper, pid_t what) {
  if (to_keeper < 0) return;
  while (::send(to_keeper, &what, sizeof what, MSG_NOSIGNAL) < 0 && errno == EINTR) {}
}

}  // namespace

int ToKeeper() {
  static std::once_flag once;
  std::call_once(once, StartKeeper);
  return owners_end;
}

void KeepOwnGroup(int to_keeper) { Tell(to_keeper, ::getpid()); }
void ReleaseGroup(pid_t group) { Tell(ToKeeper(), -group); }

}  // namespace flaneur
