#include "pipeline/core/subprocess.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include "pipeline/core/interruption.h"
#include "pipeline/core/temporary_folder.h"
#include "runtime/base/file.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

constexpr char kErrorPrefix[] = "flaneur: error: ";

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

int Spawn(const std::vector<std::string>& argv, const RunOptions& options, int log, pid_t* child) {
  std::vector<std::string> arguments = argv;
  std::vector<std::string> variables = Environment(options.environment);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, log, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, log, STDERR_FILENO);
  posix_spawnattr_t attributes;  // a group of its own, so that it can be ended with all that it started
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  const int code = ::posix_spawnp(child, argv[0].c_str(), &actions, &attributes, Pointers(&arguments).data(),
                                  Pointers(&variables).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return code;
}

// Waits until it has ended. It stays a zombie until it is reaped, so that its id cannot mean another one meanwhile.
int AwaitEnd(pid_t child) {
  siginfo_t ended{};
  int code = 0;
  EndWithUs(child);
  while ((code = ::waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT)) < 0 && errno == EINTR) {}
  Forget(child);
  return code;
}

double Seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

bool IsProgram(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && ::access(path.c_str(), X_OK) == 0;
}

// Half of Blender's start is compiling its own Python scripts, which a distribution does not do beforehand: a folder of
// our own keeps them, and folders named __pycache__ appear nowhere.
void AddByteCodeCache(std::vector<std::string>* environment) {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  fs::path folder;  // the base directory specification has relative paths ignored
  if (cache && cache[0] == '/') folder = cache;
  else if (home && home[0] == '/') folder = fs::path(home) / ".cache";
  if (folder.empty()) return environment->push_back("PYTHONDONTWRITEBYTECODE=1");
  environment->push_back("PYTHONDONTWRITEBYTECODE=");
  environment->push_back("PYTHONPYCACHEPREFIX=" + (folder / "flaneur" / "python").string());
}

// Blender's own last words are about its exit; a Python exception says more.
std::string Reason(const fs::path& log_file) {
  std::string text, line, last, exception, ours;
  if (Error error = ReadTextFile(log_file, &text)) return error.message;
  std::istringstream lines(text);
  while (std::getline(lines, line)) {
    const size_t at = line.find(kErrorPrefix);
    if (at == 0) ours = line.substr(sizeof(kErrorPrefix) - 1);
    const size_t colon = line.find("Error: ");
    if (colon != std::string::npos && line.find(' ') > colon && line[0] != 'E') exception = line;
    if (!line.empty()) last = line;
  }
  if (!ours.empty()) return OneLine(ours);
  return OneLine(exception.empty() ? last : exception);
}

}  // namespace

Error RunProcess(const std::vector<std::string>& argv, const RunOptions& options, ProcessResult* result) {
  *result = {};
  if (argv.empty()) return Fail("no program to run was named");
  int log = -1;
  if (Error error = OpenLog(options.log_file, &log)) return error;
  const auto start = std::chrono::steady_clock::now();
  pid_t child = 0;
  const int code = Spawn(argv, options, log, &child);
  ::close(log);
  if (code) return Fail(argv[0] + ": cannot run: " + std::strerror(code));
  int status = 0;
  rusage usage{};
  if (AwaitEnd(child) < 0 || ::wait4(child, &status, 0, &usage) < 0) {
    return Fail(argv[0] + ": cannot wait for it: " + std::strerror(errno));
  }
  if (Error e = Interrupted()) return e;
  result->wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result->cpu_s = Seconds(usage.ru_utime) + Seconds(usage.ru_stime);
  result->peak_memory_bytes = static_cast<int64_t>(usage.ru_maxrss) * 1024;
  result->exit_status = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  return Ok();
}

Error FindBlender(fs::path* program) {
  const char* named = std::getenv("FLANEUR_BLENDER");
  if (named && *named) {
    *program = named;
    if (IsProgram(*program)) return Ok();
    return Fail("Blender not found: FLANEUR_BLENDER names '" + OneLine(named) +
                "', which is no program; install the Debian package blender or correct it");
  }
  const char* folders = std::getenv("PATH");
  std::istringstream list(folders ? folders : "");
  for (std::string folder; std::getline(list, folder, ':');) {
    *program = fs::path(folder) / "blender";
    if (IsProgram(*program)) return Ok();
  }
  return Fail("Blender not found: install the Debian package blender or set FLANEUR_BLENDER");
}

fs::path BlenderScriptsFolder() {
  const char* named = std::getenv("FLANEUR_BLENDER_SCRIPTS");
  if (named && *named) return named;
  std::error_code ec;
  const fs::path installed =
      fs::read_symlink("/proc/self/exe", ec).parent_path().parent_path() / "share/flaneur/blender_scripts";
  return fs::is_directory(installed, ec) ? installed : fs::path(FLANEUR_BLENDER_SCRIPTS_FOLDER);
}

Error RunBlenderScript(const fs::path& script, const std::string& settings_json, const BlenderOptions& options,
                       ProcessResult* result) {
  fs::path blender;
  if (Error error = FindBlender(&blender)) return error;
  const fs::path path = fs::absolute(BlenderScriptsFolder() / script);
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) {
    return Fail(path.string() + ": no such Blender script; set FLANEUR_BLENDER_SCRIPTS to the " +
                "folder blender_scripts of Flaneur");
  }
  TemporaryFolder folder;
  if (Error error = folder.Create("flaneur_blender_")) return error;
  const fs::path settings = folder.path() / "settings.json";
  if (Error error = WriteTextFile(settings, settings_json)) return error;
  RunOptions run;
  run.log_file = options.log_file.empty() ? folder.path() / "log.txt" : options.log_file;
  // A distribution's Blender takes the modules of the first python3 on PATH: let that be the one beside it, not a
  // pyenv's or conda's.
  const char* folders = std::getenv("PATH");
  run.environment = {"TMPDIR=" + folder.path().string(),
                     "PATH=" + blender.parent_path().string() + ":" + (folders ? folders : "")};
  AddByteCodeCache(&run.environment);
  std::vector<std::string> argv = {blender.string(), "--background", "--factory-startup", "--python-exit-code", "1"};
  if (options.threads > 0) argv.insert(argv.end(), {"--threads", std::to_string(options.threads)});
  argv.insert(argv.end(), {"--python", path.string(), "--", settings.string()});
  ProcessResult process;
  if (Error error = RunProcess(argv, run, &process)) return error;
  if (result) *result = process;
  if (process.exit_status == 0) return Ok();
  return Fail(path.filename().string() + ": " + Reason(run.log_file) + " (Blender ended with status " +
              std::to_string(process.exit_status) + ")");
}

}  // namespace flaneur
