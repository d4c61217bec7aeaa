#include "pipeline/core/child_policy.h"

#include <algorithm>

namespace flaneur {
namespace {

namespace fs = std::filesystem;

ChildPolicy policy_of_this_process;

fs::path Resolved(const fs::path& path) {
  std::error_code ec;
  fs::path resolved = fs::weakly_canonical(fs::absolute(path, ec), ec);
  return ec ? fs::absolute(path, ec).lexically_normal() : resolved;
}

}  // namespace

void SetChildPolicy(ChildPolicy policy) { policy_of_this_process = std::move(policy); }
const ChildPolicy& GetChildPolicy() { return policy_of_this_process; }

bool LiesWithin(const fs::path& path, const std::vector<fs::path>& folders) {
  if (folders.empty()) return true;
  const fs::path file = Resolved(path);
  return std::any_of(folders.begin(), folders.end(), [&](const fs::path& folder) {
    const fs::path root = Resolved(folder);
    return std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first == root.end();
  });
}

Error CheckWithinRoots(const fs::path& path) {
  if (LiesWithin(path, policy_of_this_process.roots)) return Ok();
  return Fail(path.string() + ": lies outside the tour's folder; copy it there, or allow it by --allow-outside");
}

}  // namespace flaneur
