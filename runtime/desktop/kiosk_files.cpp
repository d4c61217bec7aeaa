#include "runtime/desktop/kiosk_files.h"

#include "runtime/desktop/warn.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {
namespace {

constexpr double kLook_s = 5, kSettles_s = 10;  // a copy that is under way still changes

}  // namespace

VisitLogFile::VisitLogFile(const KioskSettings& settings) {
  if (settings.statistics) folder_ = settings.statistics_folder.empty() ? VisitLogFolder() : settings.statistics_folder;
}

Error VisitLogFile::Note(const VisitRecord& visit) { return folder_.empty() ? Ok() : AppendVisit(folder_, visit); }

PackWatch::PackWatch(std::filesystem::path path) : path_(std::move(path)) { played_ = seen_ = Look(); }

PackWatch::Mark PackWatch::Look() const {
  std::error_code ec;
  Mark mark;
  mark.written = std::filesystem::last_write_time(path_, ec);
  if (!ec) mark.bytes = std::filesystem::file_size(path_, ec);
  return ec ? Mark{} : mark;
}

bool PackWatch::IsReplaced(double now_s) {
  if (now_s - looked_s_ < kLook_s) return false;
  looked_s_ = now_s;
  const Mark mark = Look();
  if (mark != seen_) {
    seen_ = mark;
    seen_s_ = now_s;
  }
  if (mark == played_ || mark.bytes == 0 || now_s - seen_s_ < kSettles_s) return false;
  played_ = mark;  // looked at once
  TourPack pack;
  PackFile file;
  const Error error = file.Open(path_, &pack);
  if (error) Warn(error.message + "; the tour that is there goes on");
  return !error;
}

}  // namespace flaneur
