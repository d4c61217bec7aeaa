#include "runtime/visit/visit_log.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "runtime/base/file.h"

namespace flaneur {
namespace fs = std::filesystem;
namespace {

constexpr const char* kHead = "began,length_s,language,stops_reached,stops\n";

fs::path LogPath(const fs::path& folder, int age) {
  return folder / (age == 0 ? "visits.csv" : "visits." + std::to_string(age) + ".csv");
}

std::string LineOf(const VisitRecord& visit) {
  char began[32] = "";
  std::tm local{};
  if (::localtime_r(&visit.began, &local) != nullptr) std::strftime(began, sizeof began, "%Y-%m-%d %H:%M", &local);
  std::string language;
  for (char c : visit.language) language += c >= ' ' && c != ',' && c != '"' ? c : ' ';
  return std::string(began) + "," + std::to_string(std::lround(visit.length_s)) + "," + language + "," +
         std::to_string(visit.stops_reached) + "," + std::to_string(visit.stops) + "\n";
}

void MakeRoom(const fs::path& folder) {
  std::error_code ec;
  if (fs::file_size(LogPath(folder, 0), ec) < kMostVisitLog_bytes || ec) return;
  fs::remove(LogPath(folder, kOldLogs), ec);
  for (int age = kOldLogs; age > 0; --age) fs::rename(LogPath(folder, age - 1), LogPath(folder, age), ec);
}

void TakeAwayUnfinishedLine(const fs::path& path) {
  std::string text;
  if (ReadTextFile(path, &text) || text.empty() || text.back() == '\n') return;
  std::error_code ec;
  fs::resize_file(path, text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1, ec);
}

}  // namespace

Error AppendVisit(const fs::path& folder, const VisitRecord& visit) {
  std::error_code ec;
  fs::create_directories(folder, ec);
  MakeRoom(folder);
  const fs::path path = LogPath(folder, 0);
  TakeAwayUnfinishedLine(path);
  const auto fail = [&] { return Fail(path.string() + ": cannot be written: " + std::strerror(errno)); };
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (file < 0) return fail();
  const bool is_new = ::lseek(file, 0, SEEK_END) == 0;
  const std::string line = (is_new ? kHead : "") + LineOf(visit);
  const bool written = ::write(file, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  const bool kept = written && ::fdatasync(file) == 0;
  const Error error = kept ? Ok() : fail();
  ::close(file);
  return error;
}

fs::path VisitLogFolder() {
  const char* state = std::getenv("XDG_STATE_HOME");
  const char* home = std::getenv("HOME");
  if (state != nullptr && state[0] == '/') return fs::path(state) / "flaneur";
  if (home != nullptr && home[0] == '/') return fs::path(home) / ".local" / "state" / "flaneur";
  return {};
}

}  // namespace flaneur
