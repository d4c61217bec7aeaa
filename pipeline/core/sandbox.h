// Programs that open strangers' files run where they can do no harm, by bubblewrap. Internal to pipeline/core.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace flaneur {

// Whether bubblewrap is installed and may work here. Asked once.
bool HasSandbox();

// The command that runs `argv` without network and without writing anywhere but in `writable`; of the folders that
// hold people's files (home, temporary and mounted ones) it sees `readable` and `writable` alone.
std::vector<std::string> Sandboxed(const std::vector<std::string>& argv,
                                   const std::vector<std::filesystem::path>& readable,
                                   const std::vector<std::filesystem::path>& writable);

}  // namespace flaneur
