#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>

#include "pipeline/cli/arguments.h"
#include "pipeline/cli/verbs.h"
#include "pipeline/core/store.h"
#include "runtime/base/option_range.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

struct CacheArguments {
  fs::path folder;
  bool verify = false, list = false;
  double most_mb = -1, most_days = -1;
};

void PrintSummary(const std::vector<StoreListing>& all) {
  struct Sum {
    size_t entries = 0;
    double mb = 0, seconds = 0;
  };
  std::map<std::string, Sum> stages;
  Sum total;
  for (const StoreListing& each : all) {
    const std::string stage = each.entry.step.substr(0, each.entry.step.find(':'));
    for (Sum* sum : {&stages[stage], &total}) {
      ++sum->entries;
      sum->mb += static_cast<double>(each.entry.bytes) / 1e6;
      sum->seconds += each.entry.seconds;
    }
  }
  std::printf("%-12s %8s %10s %12s\n", "stage", "entries", "MB", "work, s");
  for (const auto& [stage, sum] : stages)
    std::printf("%-12s %8zu %10.1f %12.1f\n", stage.c_str(), sum.entries, sum.mb, sum.seconds);
  std::printf("%-12s %8zu %10.1f %12.1f\n", "all", total.entries, total.mb, total.seconds);
}

void PrintList(const std::vector<StoreListing>& all) {
  for (const StoreListing& each : all) {
    std::printf("%.16s  %8.2f MB  %7.1f days  %s\n", each.key.c_str(), static_cast<double>(each.entry.bytes) / 1e6,
                each.unused_days, each.entry.step.c_str());
  }
}

}  // namespace

int RunCache(const Arguments& args) {
  CLI::App app{
      "Shows what steps have made and keeps (entries, megabytes, the processor seconds that they spare), verifies or "
      "trims it. Others may use the folder meanwhile.",
      "flaneur cache"};
  CacheArguments a;
  if (const char* named = std::getenv("FLANEUR_CACHE")) a.folder = named;
  app.add_option("DIR", a.folder, "The cache: an output's folder cache, or a shared one (default: FLANEUR_CACHE)");
  app.add_flag("--list", a.list, "Each entry: key, size, days since it was last of use, step");
  app.add_flag("--verify", a.verify,
               "Read all and compare checksums; what is damaged goes. Exit status 1 where any was");
  app.add_option("--trim-mb", a.most_mb, "Remove what was unused for longest until so many megabytes are left")
      ->check(NumberFrom(0.0, 1e9));
  app.add_option("--trim-days", a.most_days, "Remove what was of no use for so many days")->check(NumberFrom(0.0, 1e6));
  if (const int status = ParseArguments(&app, args); status >= 0) return status;
  std::error_code ec;
  if (a.folder.empty()) return Report(Fail("name the cache's folder, or set FLANEUR_CACHE"));
  if (!fs::is_directory(a.folder, ec)) return Report(Fail(a.folder.string() + ": no such folder"));
  const Store store{a.folder};
  size_t damaged = 0;
  if (a.verify) {
    damaged = VerifyStore(store);
    std::printf("%zu damaged, removed\n", damaged);
  }
  if (a.most_mb >= 0 || a.most_days >= 0) {
    constexpr double kAny = std::numeric_limits<double>::max();
    const uintmax_t bytes =
        a.most_mb < 0 ? std::numeric_limits<uintmax_t>::max() : static_cast<uintmax_t>(a.most_mb * 1e6);
    std::printf("%zu removed\n", TrimStore(store, bytes, a.most_days < 0 ? kAny : a.most_days));
  }
  a.list ? PrintList(ListStore(store)) : PrintSummary(ListStore(store));
  return damaged > 0 ? 1 : 0;
}

}  // namespace flaneur
