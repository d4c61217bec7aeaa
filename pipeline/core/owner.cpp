#include "pipeline/core/owner.h"

#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "pipeline/core/fingerprint.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace {

constexpr std::string_view kBegin = "-of-";  // in front of a mark
constexpr size_t kDigits = 8;                // of a fingerprint, in a mark

std::string Short(const std::string& text) { return Fingerprint().Add(text).Hex().substr(0, kDigits); }

// The machine, or container, in which process numbers mean what they mean here.
std::string Machine() {
  char name[256] = {};
  ::gethostname(name, sizeof name - 1);
  std::error_code ec;
  return Short(name + std::filesystem::read_symlink("/proc/self/ns/pid", ec).string());
}

std::string Boot() {
  std::string id;
  return ReadTextFile("/proc/sys/kernel/random/boot_id", &id) ? "" : Short(id);
}

// When it was started, in the system's own units: a number that comes back belongs to another one. Empty: it is gone.
std::string StartOf(long process) {
  std::string text;
  if (ReadTextFile("/proc/" + std::to_string(process) + "/stat", &text)) return "";
  size_t at = text.rfind(')');
  for (int field = 2; field < 22 && at != std::string::npos; ++field) at = text.find(' ', at + 1);
  return at == std::string::npos ? "" : text.substr(at + 1, text.find(' ', at + 1) - at - 1);
}

}  // namespace

std::string OwnerMark() {
  static const std::string start = StartOf(::getpid());
  return std::string(kBegin) + Machine() + "-" + Boot() + "-" + std::to_string(::getpid()) + "-" + start + "-";
}

bool OwnerHasEnded(std::string_view name) {
  const size_t begin = name.find(kBegin);
  if (begin == std::string_view::npos) return false;
  const std::string mark(name.substr(begin + kBegin.size()));
  char machine[kDigits + 1] = {}, boot[kDigits + 1] = {}, start[24] = {};
  long process = 0;
  if (std::sscanf(mark.c_str(), "%8[0-9a-f]-%8[0-9a-f]-%ld-%23[0-9]-", machine, boot, &process, start) != 4)
    return false;
  if (machine != Machine()) return false;
  if (boot != Boot()) return true;
  return StartOf(process) != start;
}

}  // namespace flaneur
