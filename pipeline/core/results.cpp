#include "pipeline/core/results.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "pipeline/core/fingerprint.h"
#include "pipeline/core/interruption.h"
#include "pipeline/core/temporary_folder.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

// While results are replaced each of them is a link through this one, which is turned from the earlier to the new ones.
constexpr const char* kCurrent = ".flaneur_current";
constexpr useconds_t kLockGlance_us = 100000;

fs::path Through(const std::string& name) { return fs::path(kCurrent) / name; }

bool IsOurLink(const fs::path& path) {
  std::error_code ec;
  return fs::is_symlink(path, ec) && fs::read_symlink(path, ec) == Through(path.filename().string());
}

void Sync(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

Error CannotWrite(const fs::path& path, int reason) {
  return Fail(path.string() + ": cannot be written: " + std::strerror(reason));
}

// Puts what the link in between shows where it shows. Whoever looks sees no change. Whether all went well.
bool Settle(const fs::path& folder) {
  std::error_code ec;
  const fs::path current = folder / kCurrent;
  const fs::path target = fs::read_symlink(current, ec), shown = folder / target;
  if (ec) return true;
  // Folders of strangers may bring a link of that name that shows elsewhere.
  const bool is_ours = target == target.filename() && target.string().rfind(".flaneur_", 0) == 0;
  if (!is_ours || fs::is_symlink(shown, ec)) return ::unlink(current.c_str()) == 0;
  std::vector<fs::path> links;
  for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec)) {
    if (IsOurLink(it->path())) links.push_back(it->path());
  }
  bool settled = !ec;
  for (const fs::path& link : links) {
    const fs::path content = shown / link.filename();
    const bool there = fs::exists(fs::symlink_status(content, ec));
    settled = (there ? ::rename(content.c_str(), link.c_str()) : ::unlink(link.c_str())) == 0 && settled;
  }
  return settled && ::unlink(current.c_str()) == 0;
}

// Makes every name a link through the one in between, which shows the earlier results. Errno, or 0.
int LinkThrough(const fs::path& folder, const fs::path& earlier, const std::vector<std::string>& names) {
  std::error_code ec;
  for (const std::string& name : names) {
    if (!fs::exists(fs::symlink_status(folder / name, ec))) continue;
    if (::link((folder / name).c_str(), (earlier / name).c_str()) != 0) return errno;
  }
  if (::symlink(earlier.filename().c_str(), (folder / kCurrent).c_str()) != 0) return errno;
  const fs::path link = earlier / ".link";
  for (const std::string& name : names) {
    if (::symlink(Through(name).c_str(), link.c_str()) != 0) return errno;
    if (::rename(link.c_str(), (folder / name).c_str()) != 0) return errno;
  }
  return 0;
}

Error ReplaceOneByOne(const fs::path& folder, const fs::path& staging, const std::vector<std::string>& names) {
  std::error_code ec;
  for (const std::string& name : names) {
    const bool there = fs::exists(staging / name, ec);
    if (!there) fs::remove(folder / name, ec);
    else if (::rename((staging / name).c_str(), (folder / name).c_str()) != 0) return CannotWrite(folder / name, errno);
  }
  return Ok();
}

bool KnowsNoLinks(int reason) {
  return reason == EPERM || reason == EOPNOTSUPP || reason == ENOSYS || reason == EMLINK;
}

nlohmann::json ReadManifest(const fs::path& folder) {
  std::string text;
  if (ReadTextFile(folder / kManifest, &text)) return {};
  nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  const bool good = json.is_object() && json.contains("files") && json["files"].is_object() && json.contains("key") &&
                    json["key"].is_string();
  return good ? json : nlohmann::json{};
}

Error AddFiles(nlohmann::json manifest, const fs::path& staging, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    std::string sha256;
    if (Error e = Sha256OfFile(staging / name, &sha256)) return e;
    std::error_code ec;
    manifest["files"][name] = {{"bytes", fs::file_size(staging / name, ec)}, {"sha256", sha256}};
  }
  return WriteTextFile(staging / kManifest, manifest.dump(1) + "\n");
}

}  // namespace

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Error FolderLock::Take(const fs::path& folder) {
  descriptor_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0) return Fail(folder.string() + ": cannot be opened: " + std::strerror(errno));
  for (bool said = false; ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK; said = true) {
    if (Error e = Interrupted()) return e;
    if (!said) std::fprintf(stderr, "%s: waiting for another bake into this folder\n", folder.c_str());
    ::usleep(kLockGlance_us);
  }
  return Ok();
}

void RecoverResults(const fs::path& folder) {
  std::error_code ec;
  if (fs::is_symlink(folder / kCurrent, ec) && !Settle(folder)) return;  // then what it shows must stay
  SweepLeftovers(folder);
}

Error ReplaceTogether(const fs::path& folder, TemporaryFolder* staging, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    std::error_code ec;
    if (fs::is_directory(folder / name, ec)) return Fail((folder / name).string() + ": is a folder, a file is needed");
  }
  const std::lock_guard lock(TemporaryFoldersMutex());
  TemporaryFolder earlier;
  if (Error e = earlier.Create(".flaneur_earlier_", folder)) return e;
  int reason = LinkThrough(folder, earlier.path(), names);
  if (reason == 0) {
    Sync(staging->path());
    Sync(folder);
    const fs::path turn = earlier.path() / ".turn";
    if (::symlink(staging->path().filename().c_str(), turn.c_str()) != 0) reason = errno;
    else if (::rename(turn.c_str(), (folder / kCurrent).c_str()) != 0) reason = errno;  // the moment
  }
  const bool settled = Settle(folder);
  if (!settled) {  // what the links show must stay; whoever comes next settles it
    earlier.Keep();
    staging->Keep();
  }
  if (reason != 0 && KnowsNoLinks(reason) && settled) return ReplaceOneByOne(folder, staging->path(), names);
  if (reason != 0) return CannotWrite(folder, reason);
  Sync(folder);
  return Ok();
}

Error WriteManifest(const fs::path& staging, const std::string& key, const std::vector<std::string>& names) {
  return AddFiles({{"version", 1}, {"key", key}, {"files", nlohmann::json::object()}}, staging, names);
}

Error UpdateManifest(const fs::path& folder, const fs::path& staging, const std::vector<std::string>& names) {
  return AddFiles(ReadManifest(folder), staging, names);
}

bool ResultsAreWhole(const fs::path& folder, const std::string& key) {
  const nlohmann::json manifest = ReadManifest(folder);
  if (manifest.is_null() || manifest.value("key", "") != key) return false;
  for (const auto& [name, file] : manifest["files"].items()) {
    std::string sha256;
    if (!file.is_object() || !file.contains("sha256") || !file["sha256"].is_string()) return false;
    if (Sha256OfFile(folder / name, &sha256) || file["sha256"] != sha256) return false;
  }
  return true;
}

std::vector<std::string> ResultNames(const fs::path& folder) {
  std::vector<std::string> names;
  const nlohmann::json manifest = ReadManifest(folder);
  if (manifest.is_null()) return names;
  for (const auto& [name, file] : manifest["files"].items()) {
    const bool is_here = !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos;
    if (is_here) names.push_back(name);  // a stranger's manifest may name anything
  }
  return names;
}

}  // namespace flaneur
