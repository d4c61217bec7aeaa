#include "pipeline/cli/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "pipeline/core/interruption.h"
#include "pipeline/core/temporary_folder.h"
#include "runtime/base/clock.h"

namespace flaneur {
namespace {

constexpr size_t kMaxWarningsShown = 8;  // of a step on the terminal; the report has all
constexpr useconds_t kGlance_us = 200000;
constexpr double kPatience_s = 1;  // with work of our own that does not hear of an interruption

std::string Duration(double seconds) {
  const long s = std::lround(seconds);
  if (s < 100) return std::to_string(s) + " s";
  return s < 6000 ? std::to_string((s + 30) / 60) + " min" : std::to_string((s + 1800) / 3600) + " h";
}

size_t Columns() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20 ? size.ws_col : 80;
}

void ShowWarnings(const std::vector<std::string>& warnings) {
  for (size_t i = 0; i < std::min(warnings.size(), kMaxWarningsShown); ++i) {
    std::fprintf(stderr, "        warning: %s\n", warnings[i].c_str());
  }
  if (warnings.size() > kMaxWarningsShown) {
    std::fprintf(stderr, "        and %zu more warnings, see report.html\n", warnings.size() - kMaxWarningsShown);
  }
}

}  // namespace

Progress::Progress(size_t count, double all_s, size_t at_a_time, bool)
    : count_(count),
      at_a_time_(at_a_time),
      all_s_(std::max(all_s, 1e-3)),
      start_s_(Now_s()),
      terminal_(::isatty(STDERR_FILENO) != 0),
      painter_(1),
      painting_(StartJob(
          &painter_, [this] { return Watch(); }, Urgency::kMeanwhile)) {}

Progress::~Progress() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
    Erase();
  }
  painting_.Wait();
}

void Progress::Begin(const Step& step) {
  const std::lock_guard lock(mutex_);
  running_.push_back(&step);
}

void Progress::End(const Step& step, double expected_s, bool failed) {
  const std::lock_guard lock(mutex_);
  std::erase(running_, &step);
  ++done_;
  done_s_ += expected_s;
  if (failed || Interrupted()) return;
  Erase();
  std::fprintf(stderr, "[%*zu/%zu] %3.0f %%  %-10s %s ... ", count_ > 9 ? 2 : 1, done_, count_,
               std::floor(100 * done_s_ / all_s_ + 1e-6), step.stage.c_str(), step.item.c_str());
  if (step.report.cached) std::fprintf(stderr, "cached");
  else std::fprintf(stderr, "%.1f s", step.report.seconds);
  const std::string left = Left();
  std::fprintf(stderr, "%s\n", left.empty() ? "" : (", " + left).c_str());
  ShowWarnings(step.warnings);
}

// As fast as it went until now, or as expected.
std::string Progress::Left() const {
  double done_s = done_s_;
  for (const Step* step : running_) done_s += step->progress;  // a second for each: enough to move
  if (done_ == count_) return "";
  const double passed_s = Now_s() - start_s_, share = std::min(done_s / all_s_, 1.0);
  const double planned_s = (all_s_ - done_s) / static_cast<double>(at_a_time_);
  const double left_s = share > 0.05 ? passed_s * (1 - share) / share : planned_s;
  return "about " + Duration(std::max(left_s, 1.0)) + " left";
}

void Progress::Erase() {
  if (drawn_) std::fprintf(stderr, "\r\033[K");
  drawn_ = false;
}

void Progress::Draw() {
  std::string line = std::to_string(std::lround(std::floor(100 * done_s_ / all_s_))) + " %, " + Left() + ":";
  for (const Step* step : running_) {
    line += "  " + step->stage + " " + step->item;
    if (step->progress > 0) line += " " + std::to_string(std::lround(100 * step->progress)) + " %";
  }
  std::fprintf(stderr, "\r\033[K%s", line.substr(0, Columns() - 1).c_str());
  drawn_ = true;
}

bool Progress::Watch() {
  ::usleep(kGlance_us);
  const std::lock_guard lock(mutex_);
  if (over_) return true;
  if (terminal_ && !running_.empty()) Draw();
  if (!Interrupted()) return false;
  if (interrupted_s_ == 0) interrupted_s_ = Now_s();
  if (Now_s() - interrupted_s_ < kPatience_s) return false;
  Erase();
  std::fprintf(stderr, "flaneur: error: %s\n", Interrupted().message.c_str());
  RemoveTemporaryFolders();
  EndAsInterrupted();
  return true;
}

}  // namespace flaneur
