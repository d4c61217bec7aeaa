// Other programs as child processes: any program, and Blender with one of our scripts. No shell is
// involved.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "runtime/base/error.h"

namespace flaneur {

struct RunOptions {
  std::filesystem::path log_file;        // gets what it prints on both streams; empty: dropped
  std::vector<std::string> environment;  // NAME=VALUE, added to this process's own
};

struct ProcessResult {
  int exit_status = 0;  // 128 + the signal's number where a signal ended it
  double wall_s = 0;
  double cpu_s = 0;               // user and system time of all its threads
  int64_t peak_memory_bytes = 0;  // resident
};

// Runs argv[0] (searched on PATH where it has no slash) to its end. Standard input is empty. A
// program that ends with a status other than 0 is no error here. It ends with this process's
// interruption. Errors: no such program, log file not writable, interrupted.
Error RunProcess(const std::vector<std::string>& argv, const RunOptions& options, ProcessResult* result);

// The program FLANEUR_BLENDER names, else `blender` on PATH. Errors: neither is there.
Error FindBlender(std::filesystem::path* program);

// The folder of the scripts that run inside Blender: FLANEUR_BLENDER_SCRIPTS, else that installed with this program,
// else that of the source tree.
std::filesystem::path BlenderScriptsFolder();

struct BlenderOptions {
  std::filesystem::path log_file;  // keeps what Blender printed; empty: nobody needs it
  int threads = 0;                 // 0: one a core
};

// Runs `script` (relative to BlenderScriptsFolder(), or absolute) in Blender without a window, with
// a settings file that holds `settings_json`. `result` may be null. Errors: no Blender, no such
// script, and every end of Blender other than status 0: the script's own `flaneur: error:` line
// where it printed one, else the last line that tells why.
Error RunBlenderScript(const std::filesystem::path& script, const std::string& settings_json,
                       const BlenderOptions& options, ProcessResult* result);

}  // namespace flaneur
