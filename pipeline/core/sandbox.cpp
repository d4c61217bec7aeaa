#include "pipeline/core/sandbox.h"

#include <algorithm>
#include <iterator>

#include "pipeline/core/subprocess.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "bwrap";
// What a system brings. All other folders at the root (home, tmp, mnt, var ...) may hold what is people's own.
constexpr const char* kSystemFolders[] = {"/bin", "/dev", "/etc",  "/lib",  "/lib32", "/lib64", "/libx32",
                                          "/nix", "/opt", "/proc", "/sbin", "/sys",   "/usr"};

std::vector<std::string> Isolated() {
  return {kProgram, "--unshare-all", "--die-with-parent", "--new-session", "--ro-bind", "/", "/"};
}

void Add(std::vector<std::string>* argv, std::initializer_list<std::string> more) {
  argv->insert(argv->end(), more.begin(), more.end());
}

}  // namespace

bool HasSandbox() {
  static const bool works = [] {
    std::vector<std::string> argv = Isolated();
    Add(&argv, {"--dev", "/dev", "--proc", "/proc", "true"});
    ProcessResult result;
    return !RunProcess(argv, {}, &result) && result.exit_status == 0;
  }();
  return works;
}

std::vector<std::string> Sandboxed(const std::vector<std::string>& argv, const std::vector<fs::path>& readable,
                                   const std::vector<fs::path>& writable) {
  std::vector<std::string> all = Isolated();
  std::error_code ec;
  for (const auto& entry : fs::directory_iterator("/", fs::directory_options::skip_permission_denied, ec)) {
    const bool system =
        std::find(std::begin(kSystemFolders), std::end(kSystemFolders), entry.path()) != std::end(kSystemFolders);
    if (!system && entry.is_directory(ec) && !entry.is_symlink(ec)) Add(&all, {"--tmpfs", entry.path().string()});
  }
  Add(&all, {"--dev", "/dev", "--proc", "/proc"});
  for (const fs::path& folder : readable) {
    const std::string real = fs::weakly_canonical(fs::absolute(folder), ec).string();
    if (real == "/" || !fs::exists(real, ec)) continue;
    Add(&all, {"--ro-bind", real, fs::absolute(folder).lexically_normal().string(), "--ro-bind", real, real});
  }
  for (const fs::path& folder : writable) {
    const std::string path = fs::absolute(folder).lexically_normal().string();
    Add(&all, {"--bind", path, path});
  }
  all.insert(all.end(), argv.begin(), argv.end());
  return all;
}

}  // namespace flaneur
