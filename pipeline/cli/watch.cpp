#include "pipeline/cli/watch.h"

#include <unistd.h>

#include <cstdio>
#include <map>

#include "pipeline/cli/bake.h"
#include "pipeline/cli/stage_inputs.h"
#include "pipeline/core/interruption.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

constexpr useconds_t kGlance_us = 300000;

using Ages = std::map<fs::path, fs::file_time_type>;

void Add(const fs::path& file, Ages* ages) {
  std::error_code ec;
  (*ages)[file] = fs::last_write_time(file, ec);
  if (!IsScript(file)) return;
  for (const auto& beside : fs::directory_iterator(file.parent_path(), ec)) {
    if (IsScript(beside.path())) (*ages)[beside.path()] = beside.last_write_time(ec);
  }
}

// A tour that cannot be read now is watched by its own file, and by what it named before.
void AddTour(const fs::path& tour, const Ages& before, Ages* ages) {
  std::vector<fs::path> files;
  if (FilesOfTour(tour, &files)) {
    for (const auto& [file, age] : before) files.push_back(file);
  }
  for (const fs::path& file : files) Add(file, ages);
}

Ages Look(const std::vector<fs::path>& tours, const Ages& before) {
  Ages ages;
  for (const fs::path& tour : tours) AddTour(tour, before, &ages);
  return ages;
}

// What was seen before the last bake, so that what changed during it is not missed.
Ages& Seen() {
  static Ages seen;
  return seen;
}

}  // namespace

void BeginWatching(const std::vector<fs::path>& tours) { Seen() = Look(tours, {}); }

bool AwaitChange(const std::vector<fs::path>& tours) {
  std::fprintf(stderr, "watching %zu files; Ctrl-C ends\n", Seen().size());
  Ages now = Seen();
  for (bool changed = false; !Interrupted();) {
    ::usleep(kGlance_us);
    const Ages last = now;
    now.clear();
    for (const auto& [file, age] : last) Add(file, &now);
    changed = changed || now != Seen();
    if (!changed || now != last) continue;  // nothing, or still being written
    Seen() = Look(tours, now);
    return true;
  }
  return false;
}

}  // namespace flaneur
