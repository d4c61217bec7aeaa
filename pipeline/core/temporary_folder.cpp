#include "pipeline/core/temporary_folder.h"

#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <mutex>
#include <set>
#include <vector>

#include "pipeline/core/owner.h"

namespace flaneur {

namespace fs = std::filesystem;

namespace {

std::set<fs::path>& Living() {
  static std::set<fs::path> folders;
  return folders;
}

// Once a folder, for a temporary one may hold thousands of others' files.
void SweepOnce(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<fs::path> swept;
  {
    const std::lock_guard lock(mutex);
    if (!swept.insert(folder).second) return;
  }
  SweepLeftovers(folder);
}

}  // namespace

void SweepLeftovers(const fs::path& folder) {
  std::error_code ec;
  std::vector<fs::path> left;
  for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec)) {
    const std::string name = it->path().filename().string();
    const bool ours = name.rfind("flaneur_", 0) == 0 || name.rfind(".flaneur_", 0) == 0;
    if (ours && OwnerHasEnded(name)) left.push_back(it->path());
  }
  for (const fs::path& path : left) fs::remove_all(path, ec);
}

std::recursive_mutex& TemporaryFoldersMutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

void RemoveTemporaryFolders() {
  TemporaryFoldersMutex().lock();  // for good
  std::error_code ignored;
  for (const fs::path& folder : Living()) fs::remove_all(folder, ignored);
}

TemporaryFolder::~TemporaryFolder() {
  if (path_.empty()) return;
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  const std::lock_guard lock(TemporaryFoldersMutex());
  Living().erase(path_);
}

void TemporaryFolder::Keep() {
  const std::lock_guard lock(TemporaryFoldersMutex());
  Living().erase(path_);
  path_.clear();
}

Error TemporaryFolder::Create(const std::string& prefix, const fs::path& parent) {
  std::error_code code;
  const fs::path folder = fs::absolute(parent.empty() ? fs::temp_directory_path(code) : parent);
  if (code) return Fail("no folder for temporary files: " + code.message() + "; set TMPDIR");
  SweepOnce(folder);
  const std::lock_guard lock(TemporaryFoldersMutex());
  std::string name = (folder / (prefix + OwnerMark() + "XXXXXX")).string();
  if (!::mkdtemp(name.data())) {
    return Fail(folder.string() + ": cannot make a temporary folder: " + std::strerror(errno));
  }
  path_ = name;
  Living().insert(path_);
  return Ok();
}

}  // namespace flaneur
