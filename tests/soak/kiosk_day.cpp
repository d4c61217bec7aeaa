// A kiosk's day of visitors, with its time as fast as the machine goes: kiosk_day PACK [SECONDS [SEED [PEOPLE]]]. Exit
// status: 0 nothing was wrong, 1 something was, 77 there is no pack or no OpenGL. Of an hour and more memory must be
// flat: what the process holds at the end is at most 5 % above what it held after the first eighth.
#include <malloc.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "runtime/base/clock.h"
#include "runtime/desktop/context.h"
#include "runtime/desktop/kiosk_files.h"
#include "runtime/show/guide_figure.h"
#include "runtime/simulation/scenario.h"
#include "runtime/text/system_fonts.h"
#include "runtime/visit/visit.h"
#include "tests/soak/drivers_stay_loaded.h"
#include "tests/soak/kiosk_visitors.h"
#include "tests/soak/wrong.h"
#include "tests/unit/runtime/visit/silent_shell.h"

namespace flaneur {
namespace {

constexpr int kSkipped = 77;
constexpr int kWidth_px = 160, kHeight_px = 90;
constexpr float kPicture_s = 2.0f / 15;  // as many steps as a picture goes on by at most
constexpr int kShownEvery = 30;          // while nobody does anything: the others count as hidden
constexpr float kTold_s = 1800, kLong_s = 3600;
constexpr double kMostGrowth = 1.05, kSlow_ms = 1000;
constexpr float kWarmUp = 0.125f;  // of the time

struct Memory {
  double held_MiB = 0, in_use_MiB = 0;  // by the process; of it what its allocator has given away
};

Memory MemoryNow() {
  constexpr double kMiB = 1 << 20;
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  const auto heap = ::mallinfo2();
  return {static_cast<double>(resident) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / kMiB,
          static_cast<double>(heap.uordblks + heap.hblkhd) / kMiB};
}

struct Day {
  double longest_ms = 0;  // of a picture
  long pictures = 0, visits = 0;
  Memory warm, end;
};

struct CountedVisits : VisitLog {
  VisitLogFile file;
  long* count;
  CountedVisits(const KioskSettings& settings, long* visits) : file(settings), count(visits) {}
  Error Note(const VisitRecord& visit) override {
    ++*count;
    return file.Note(visit);
  }
};

void Tell(float time_s, const Day& day, const Memory& m) {
  std::printf("%5.2f h: %5ld visits, %8ld pictures, %6.1f MiB held, %6.1f MiB in use, longest picture %.0f ms\n",
              static_cast<double>(time_s) / 3600, day.visits, day.pictures, m.held_MiB, m.in_use_MiB, day.longest_ms);
  std::fflush(stdout);
}

Error PlayDay(Visit* visit, Simulation* s, float seconds, KioskVisitors* visitors, Day* day) {
  Records records;
  float told_s = 0;
  for (float time_s = 0; time_s < seconds; time_s += kPicture_s) {
    const WindowInput hands = visitors->Next(visit->waits_for_visitors(), kPicture_s);
    const bool still = hands.down.none() && !hands.pressed && hands.clicks.empty();
    const bool shown =
        (visitors->does_something() && !still) || visit->shows_pages() || day->pictures % kShownEvery == 0;
    const double began_s = Now_s();
    if (Error e = visit->Picture(hands, shown ? kWidth_px : 0, shown ? kHeight_px : 0, kPicture_s, &records)) return e;
    const double took_ms = 1000 * (Now_s() - began_s);
    if (took_ms > kSlow_ms)
      std::printf("a slow picture of %.0f ms after %.0f s%s\n", took_ms, static_cast<double>(time_s),
                  visit->shows_pages() ? ", with pages" : "");
    day->longest_ms = std::max(day->longest_ms, took_ms);
    ++day->pictures;
    if (const std::string wrong = WhatIsWrong(*s); !wrong.empty()) return Fail(wrong);
    if (visit->ends() || visit->starts_anew()) return Fail("a visitor has ended the kiosk");
    if (day->warm.held_MiB <= 0 && time_s > kWarmUp * seconds) day->warm = MemoryNow();
    if (time_s - told_s < kTold_s) continue;
    told_s = time_s;
    Tell(time_s, *day, MemoryNow());
  }
  visit->Leave();
  day->end = MemoryNow();
  Tell(seconds, *day, day->end);
  return Ok();
}

Error Run(const std::filesystem::path& path, float seconds, uint64_t seed, int people,
          const std::filesystem::path& folder) {
  TourPack pack;
  PackFile file;
  if (Error e = file.Open(path, &pack)) return e;
  AddGuideFigure(&pack);
  Scenario scenario = ScenarioOf(pack);
  if (people >= 0) scenario.crowd.people = people;
  Jobs jobs(2);
  Simulation s;
  if (Error e = StartSimulation(&pack, scenario, &s, &jobs)) return e;
  HeadlessContext context;
  if (Error e = context.Create()) return e;
  Loader loader(&jobs);
  loader.Start(std::move(file), pack);
  KioskSettings kiosk;
  kiosk.pin = kPinOfNobody;
  kiosk.idle_s = 15;
  kiosk.statistics_folder = folder;
  PlayerSettings settings;
  settings.kiosk = true;
  settings.pointer = kiosk.pointer;
  settings.photos = (folder / "photos").string();
  settings.photo_link = "https://museum.example/{file}";
  settings.photos_most = 20;
  Day day;
  SilentShell silent;
  Fonts fonts(SystemFonts());
  CountedVisits visits(kiosk, &day.visits);
  Visit visit(pack, &loader, settings, {silent.sound, silent.settings, silent.warnings, {}, &fonts, &jobs, &visits}, &s,
              kiosk);
  if (Error e = visit.Begin()) return e;
  for (bool there = false; !there;) {
    if (Error e = visit.Load(&there)) return e;
  }
  if (Error e = visit.Enter(false)) return e;
  KioskVisitors visitors(seed);
  const double began_s = Now_s();
  if (Error e = PlayDay(&visit, &s, seconds, &visitors, &day)) return e;
  const double growth = day.end.held_MiB / day.warm.held_MiB;
  std::printf("%.0f s of a kiosk in %.0f s: %ld visits, memory %+.1f %% since the first eighth, %zu warnings\n",
              static_cast<double>(seconds), Now_s() - began_s, day.visits, 100 * (growth - 1),
              silent.warnings.all.size());
  for (size_t k = 0; k < std::min<size_t>(5, silent.warnings.all.size()); ++k)
    std::printf("  %s\n", silent.warnings.all[k].c_str());
  if (day.visits == 0) return Fail("nobody has come");
  if (1e-3 * day.longest_ms > static_cast<double>(kiosk.hang_s)) return Fail("a picture took as long as a hang");
  if (seconds >= kLong_s && growth > kMostGrowth) return Fail("memory grows");
  return Ok();
}

}  // namespace
}  // namespace flaneur

int main(int argc, char** argv) {
  using namespace flaneur;
  if (argc < 2) {
    std::fprintf(stderr, "kiosk_day PACK [SECONDS [SEED [PEOPLE]]]\n");
    return 2;
  }
  std::error_code ec;
  if (!std::filesystem::exists(argv[1], ec)) {
    std::printf("no %s: bake the demo tour with ./demo\n", argv[1]);
    return kSkipped;
  }
  if (HeadlessContext context; Error e = context.Create()) {
    std::printf("%s\n", e.message.c_str());
    return kSkipped;
  }
  const auto folder = std::filesystem::temp_directory_path() / ("flaneur_kiosk_day_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder, ec);
  const Error error =
      Run(argv[1], argc > 2 ? std::strtof(argv[2], nullptr) : 180, argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1,
          argc > 4 ? std::atoi(argv[4]) : -1, folder);
  std::filesystem::remove_all(folder, ec);
  if (error) std::printf("wrong: %s\n", error.message.c_str());
  return error ? 1 : 0;
}
