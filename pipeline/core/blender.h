// Blender without a window, with one of our scripts or of a user's.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "pipeline/core/subprocess.h"
#include "runtime/base/error.h"

namespace flaneur {

// The program FLANEUR_BLENDER names, else `blender` on PATH. Errors: neither is there.
Error FindBlender(std::filesystem::path* program);

// The folder of the scripts that run inside Blender: FLANEUR_BLENDER_SCRIPTS, else that installed with this program,
// else that of the source tree.
std::filesystem::path BlenderScriptsFolder();

struct BlenderOptions {
  std::filesystem::path log_file;  // keeps what Blender printed; empty: nobody needs it
  int threads = 0;                 // 0: one a core
  // Somebody else's file or script: where bubblewrap is installed and may work, Blender sees no network, writes nowhere
  // but to its temporary folder and `writable`, and of folders that hold people's files sees `readable` alone.
  bool sandboxed = false;
  std::vector<std::filesystem::path> readable, writable;
  // Where not null: gets the files that the script opened or that Blender loaded for it, beside those of the system.
  std::vector<std::filesystem::path>* files_read = nullptr;
  std::function<void(double)> progress;  // gets the share that is done where Blender or the script tells it
};

// Runs `script` (relative to BlenderScriptsFolder(), or absolute) with a settings file that holds `settings_json`;
// scripts in Blender files are not run. `result` may be null. Errors: no Blender, no such script, and every end of
// Blender other than status 0: the script's own `flaneur: error:` line where it printed one, else the last line that
// tells why; as for RunProcess.
Error RunBlenderScript(const std::filesystem::path& script, const std::string& settings_json,
                       const BlenderOptions& options, ProcessResult* result);

}  // namespace flaneur
