// Other programs as child processes. No shell is involved.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "runtime/base/error.h"

namespace flaneur {

struct RunOptions {
  std::filesystem::path log_file;        // gets what it prints on both streams; empty: dropped
  std::vector<std::string> environment;  // NAME=VALUE, added to this process's own
  std::function<void()> meanwhile;       // called a few times a second while it runs; may be empty
};

struct ProcessResult {
  int exit_status = 0;  // 128 + the signal's number where a signal ended it
  double wall_s = 0;
  double cpu_s = 0;               // user and system time of all its threads
  int64_t peak_memory_bytes = 0;  // resident
};

// Runs argv[0] (searched on PATH where it has no slash) to its end. Standard input is empty. A program that ends with
// a status other than 0 is no error here. It ends with this process, however that ends, and so does whatever it has
// started itself and left running; where it does not end when asked to, it is killed after three seconds. Errors: no
// such program, log file not writable, interrupted, longer than the ChildPolicy's time limit.
Error RunProcess(const std::vector<std::string>& argv, const RunOptions& options, ProcessResult* result);

}  // namespace flaneur
