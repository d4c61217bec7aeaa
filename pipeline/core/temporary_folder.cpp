#include "pipeline/core/temporary_folder.h"

#include <stdlib.h>

#include <cerrno>
#include <cstring>

namespace flaneur {

namespace fs = std::filesystem;

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

Error TemporaryFolder::Create(const std::string& prefix, const fs::path& parent) {
  std::error_code code;
  const fs::path folder = parent.empty() ? fs::temp_directory_path(code) : parent;
  if (code) return Fail("no folder for temporary files: " + code.message() + "; set TMPDIR");
  std::string name = (fs::absolute(folder) / (prefix + "XXXXXX")).string();
  if (!::mkdtemp(name.data())) {
    return Fail(folder.string() + ": cannot make a temporary folder: " + std::strerror(errno));
  }
  path_ = name;
  return Ok();
}

}  // namespace flaneur
