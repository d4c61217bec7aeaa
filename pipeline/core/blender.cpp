#include "pipeline/core/blender.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "pipeline/core/sandbox.h"
#include "pipeline/core/temporary_folder.h"
#include "runtime/base/file.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

constexpr char kErrorPrefix[] = "flaneur: error: ";
constexpr const char* kRecordReads = "common/record_reads.py";

bool IsProgram(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && ::access(path.c_str(), X_OK) == 0;
}

// Half of Blender's start is compiling its own Python scripts, which a distribution does not do beforehand: a folder of
// our own keeps them, and folders named __pycache__ appear nowhere. Empty: there is no home for it.
fs::path ByteCodeCache() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  fs::path folder;  // the base directory specification has relative paths ignored
  if (cache && cache[0] == '/') folder = cache;
  else if (home && home[0] == '/') folder = fs::path(home) / ".cache";
  return folder.empty() ? folder : folder / "flaneur" / "python";
}

// The end of what may be long.
Error ReadLastWords(const fs::path& log_file, std::string* text) {
  constexpr std::streamoff kMost_bytes = 1 << 20;
  if (Error e = CheckReadable(log_file)) return e;
  std::ifstream file(log_file, std::ios::binary | std::ios::ate);
  const std::streamoff size = file.tellg(), count = std::min(size, kMost_bytes);
  if (size < 0) return Fail(log_file.string() + ": cannot be read");
  file.seekg(size - count);
  text->assign(static_cast<size_t>(count), '\0');
  file.read(text->data(), count);
  text->resize(static_cast<size_t>(file.gcount()));
  return Ok();
}

// Blender's own last words are about its exit; a Python exception says more.
std::string Reason(const fs::path& log_file) {
  std::string text, line, last, exception, ours;
  if (Error error = ReadLastWords(log_file, &text)) return error.message;
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

// The last of what a script says ("flaneur: progress FROM TO", what it now does of all), and within that Blender
// ("Sample 3/16").
double ShareDone(const fs::path& log_file) {
  constexpr std::string_view kOurs = "flaneur: progress ", kSample = "Sample ";
  std::string text;
  if (ReadLastWords(log_file, &text)) return 0;
  double from = 0, to = 1, sample = 0, samples = 0;
  const size_t ours = text.rfind(kOurs), blenders = text.rfind(kSample);
  if (ours != std::string::npos) std::sscanf(text.c_str() + ours + kOurs.size(), "%lf %lf", &from, &to);
  const bool newer = blenders != std::string::npos && (ours == std::string::npos || blenders > ours);
  if (!newer || std::sscanf(text.c_str() + blenders + kSample.size(), "%lf/%lf", &sample, &samples) != 2) return from;
  return samples > 0 ? from + (to - from) * sample / samples : from;
}

std::vector<fs::path> Lines(const fs::path& file) {
  std::vector<fs::path> lines;
  std::string text;
  if (ReadTextFile(file, &text)) return lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.emplace_back(line);
  return lines;
}

std::vector<std::string> Command(const fs::path& blender, const fs::path& script, const fs::path& settings,
                                 const BlenderOptions& options) {
  const std::string record = fs::absolute(BlenderScriptsFolder() / kRecordReads).string();
  std::vector<std::string> argv = {blender.string(),    "--background", "--factory-startup", "--python-exit-code", "1",
                                   "--disable-autoexec"};
  if (options.threads > 0) argv.insert(argv.end(), {"--threads", std::to_string(options.threads)});
  if (options.files_read) argv.insert(argv.end(), {"--python", record});
  argv.insert(argv.end(), {"--python", script.string()});
  if (options.files_read) argv.insert(argv.end(), {"--python", record});
  argv.insert(argv.end(), {"--", settings.string()});
  return argv;
}

std::vector<std::string> InSandbox(const std::vector<std::string>& argv, const fs::path& blender,
                                   const fs::path& script, const fs::path& temporary, const BlenderOptions& options) {
  if (!options.sandboxed || !HasSandbox()) return argv;
  std::error_code ec;
  std::vector<fs::path> readable = options.readable, writable = options.writable;
  for (const fs::path& each :
       {blender.parent_path(), fs::canonical(blender, ec).parent_path(), script.parent_path(), BlenderScriptsFolder()})
    readable.push_back(each);
  if (const fs::path cache = ByteCodeCache(); !cache.empty()) readable.push_back(cache);
  writable.push_back(temporary);
  return Sandboxed(argv, readable, writable);
}

}  // namespace

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
  const fs::path settings = folder.path() / "settings.json", reads = folder.path() / "reads.txt";
  if (Error error = WriteTextFile(settings, settings_json)) return error;
  RunOptions run;
  run.log_file = options.log_file.empty() ? folder.path() / "log.txt" : options.log_file;
  // A distribution's Blender takes the modules of the first python3 on PATH: let that be the one beside it, or the
  // distribution's where a script elsewhere starts it, not a pyenv's or conda's.
  const char* folders = std::getenv("PATH");
  run.environment = {"TMPDIR=" + folder.path().string(), "FLANEUR_READS=" + reads.string(),
                     "PATH=" + blender.parent_path().string() + ":/usr/bin:" + (folders ? folders : "")};
  const fs::path cache = ByteCodeCache();
  if (cache.empty()) run.environment.push_back("PYTHONDONTWRITEBYTECODE=1");
  else
    run.environment.insert(run.environment.end(),
                           {"PYTHONDONTWRITEBYTECODE=", "PYTHONPYCACHEPREFIX=" + cache.string()});
  if (options.progress) run.meanwhile = [&] { options.progress(ShareDone(run.log_file)); };
  const std::vector<std::string> argv =
      InSandbox(Command(blender, path, settings, options), blender, path, folder.path(), options);
  ProcessResult process;
  if (Error error = RunProcess(argv, run, &process)) return Fail(path.filename().string() + ": " + error.message);
  if (result) *result = process;
  if (options.files_read) *options.files_read = Lines(reads);
  if (process.exit_status == 0) return Ok();
  return Fail(path.filename().string() + ": " + Reason(run.log_file) + " (Blender ended with status " +
              std::to_string(process.exit_status) + ")");
}

}  // namespace flaneur
