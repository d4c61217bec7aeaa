#include "pipeline/core/subprocess.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>

#include "pipeline/core/child_policy.h"
#include "pipeline/core/interruption.h"
#include "pipeline/core/keeper.h"
#include "runtime/base/clock.h"
#include "runtime/base/limits.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

constexpr double kGrace_s = 3;   // from being asked to end to being killed
constexpr int kGlance_ms = 200;  // between looks at the clock and at what the child prints
constexpr int kGroupSignals[] = {SIGTERM, SIGKILL};

std::vector<char*> Pointers(std::vector<std::string>* texts) {
  std::vector<char*> pointers;
  for (std::string& text : *texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

// This process's variables, those in `added` taking the place of others of the same name.
std::vector<std::string> Environment(const std::vector<std::string>& added) {
  std::vector<std::string> all = added;
  for (char** variable = environ; *variable; ++variable) {
    const std::string text = *variable;
    const std::string name = text.substr(0, text.find('=') + 1);
    bool replaced = false;
    for (const std::string& other : added) replaced = replaced || other.rfind(name, 0) == 0;
    if (!replaced) all.push_back(text);
  }
  return all;
}

Error OpenLog(const fs::path& path, int* descriptor) {
  const char* name = path.empty() ? "/dev/null" : path.c_str();
  *descriptor = ::open(name, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (*descriptor < 0) return Fail(std::string(name) + ": cannot write: " + std::strerror(errno));
  return Ok();
}

// In the child, forked from a process with threads: nothing here may take a lock.
[[noreturn]] void Become(char** arguments, char** variables, pid_t parent, int to_keeper, int log, int complaint) {
  ::setpgid(0, 0);  // a group of its own, so that it can be ended with all that it started
  KeepOwnGroup(to_keeper);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);
  for (int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) ::signal(signal, SIG_DFL);
  const int nothing = ::open("/dev/null", O_RDONLY);
  if (nothing >= 0) ::dup2(nothing, STDIN_FILENO);
  ::dup2(log, STDOUT_FILENO);
  ::dup2(log, STDERR_FILENO);
  ::execvpe(arguments[0], arguments, variables);
  const int reason = errno;
  [[maybe_unused]] const ssize_t told = ::write(complaint, &reason, sizeof reason);
  ::_exit(127);
}

// 0, or why it could not be started.
int Spawn(const std::vector<std::string>& argv, const RunOptions& options, int log, pid_t* child) {
  std::vector<std::string> arguments = argv, variables = Environment(options.environment);
  const std::vector<char*> argument_pointers = Pointers(&arguments), variable_pointers = Pointers(&variables);
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return errno;
  const pid_t parent = ::getpid();
  const int to_keeper = ToKeeper();
  *child = ::fork();
  if (*child == 0)
    Become(const_cast<char**>(argument_pointers.data()), const_cast<char**>(variable_pointers.data()), parent,
           to_keeper, log, ends[1]);
  int reason = *child < 0 ? errno : 0;
  ::close(ends[1]);
  if (*child > 0) {
    ::setpgid(*child, *child);  // whoever of the two comes first
    while (::read(ends[0], &reason, sizeof reason) < 0 && errno == EINTR) {}
    if (reason != 0) {
      ReleaseGroup(*child);
      ::waitpid(*child, nullptr, 0);
    }
  }
  ::close(ends[0]);
  return reason;
}

// Whether it has ended. It stays a zombie until it is reaped, so that its id cannot mean another one meanwhile.
bool HasEnded(pid_t child) {
  siginfo_t ended{};
  const int code = ::waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT | WNOHANG);
  return code < 0 ? errno != EINTR : ended.si_pid == child;
}

void WaitALittle(int process) {
  pollfd descriptor{process, POLLIN, 0};
  ::poll(&descriptor, process < 0 ? 0 : 1, process < 0 ? kGlance_ms / 10 : kGlance_ms);
}

bool PrintedTooMuch(const fs::path& log) {
  std::error_code ec;
  const auto size = log.empty() ? 0 : fs::file_size(log, ec);
  return !ec && size > kMostLog_bytes;
}

// Waits until it has ended, and sees to it where it should and does not. Why it was ended, where it was.
std::string AwaitEnd(pid_t child, const RunOptions& options) {
  const double limit_s = GetChildPolicy().time_limit_s, start_s = Now_s();
  double asked_s = 0;
  size_t next_signal = 0;
  std::string why;
  const int process = static_cast<int>(::syscall(SYS_pidfd_open, child, 0));
  while (!HasEnded(child)) {
    WaitALittle(process);
    const double now_s = Now_s();
    if (options.meanwhile) options.meanwhile();
    if (why.empty() && limit_s > 0 && now_s - start_s > limit_s)
      why = "after " + std::to_string(std::lround(limit_s)) + " s, its time limit; --time-limit sets another";
    if (why.empty() && PrintedTooMuch(options.log_file))
      why = "after it had printed " + std::to_string(kMostLog_bytes >> 20) + " MiB; let it print less";
    if (why.empty() && !Interrupted()) continue;
    if (next_signal < std::size(kGroupSignals) && (next_signal == 0 || now_s - asked_s > kGrace_s)) {
      ::kill(-child, kGroupSignals[next_signal++]);
      asked_s = now_s;
    }
  }
  if (process >= 0) ::close(process);
  ::kill(-child, SIGKILL);  // what it started and left behind
  return why;
}

double Seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

std::string NameOf(const std::string& program) { return fs::path(program).filename().string(); }

}  // namespace

Error RunProcess(const std::vector<std::string>& argv, const RunOptions& options, ProcessResult* result) {
  *result = {};
  if (argv.empty()) return Fail("no program to run was named");
  int log = -1;
  if (Error error = OpenLog(options.log_file, &log)) return error;
  const double start_s = Now_s();
  pid_t child = 0;
  const int code = Spawn(argv, options, log, &child);
  ::close(log);
  if (code) return Fail(argv[0] + ": cannot run: " + std::strerror(code));
  EndWithUs(child);
  const std::string why_ended = AwaitEnd(child, options);
  Forget(child);
  ReleaseGroup(child);
  int status = 0;
  rusage usage{};
  if (::wait4(child, &status, 0, &usage) < 0) return Fail(argv[0] + ": cannot wait for it: " + std::strerror(errno));
  if (Error e = Interrupted()) return e;
  if (!why_ended.empty()) return Fail(NameOf(argv[0]) + " was stopped " + why_ended);
  result->wall_s = Now_s() - start_s;
  result->cpu_s = Seconds(usage.ru_utime) + Seconds(usage.ru_stime);
  result->peak_memory_bytes = static_cast<int64_t>(usage.ru_maxrss) * 1024;
  result->exit_status = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  return Ok();
}

}  // namespace flaneur
