// Changes files of every format at random and reads them, each format in processes of its own: crashes, broken
// promises, and inputs that take too long or too much memory are written down and named; the exit status is then 1.
//   fuzz_formats [--seconds N] [--seed N] [--format NAME] [--failures FOLDER] [--most-s S] [--most-mib M]
//   fuzz_formats --replay FOLDER   reads what stands in FOLDER/NAME, by format
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/fuzz/mutator.h"
#include "tests/fuzz/targets.h"

namespace flaneur::fuzz {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Options {
  double seconds = 60, most_s = 1, most_mib = 1024;
  uint64_t seed = 1;
  std::string format, failures = "fuzz_failures", replay;
};

// Of one format: written by the process that reads, read by the one that watches it.
struct Shared {
  uint64_t inputs, bytes;
  double slowest_s;
  char fault[600];
  char input[2 * Mutator::kMostInput_bytes];
};

double ProcessorTime_s() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double PeakMemory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

std::string Attempt(const Target& target, const std::string& input, const fs::path& file, const Options& options,
                    Shared* shared) {
  shared->bytes = std::min(input.size(), sizeof shared->input);
  std::memcpy(shared->input, input.data(), shared->bytes);
  std::ofstream(file, std::ios::binary | std::ios::trunc) << input;
  const double start_s = ProcessorTime_s(), before_mib = PeakMemory_mib();
  std::string fault = target.attempt(file, {reinterpret_cast<const uint8_t*>(input.data()), input.size()});
  const double took_s = ProcessorTime_s() - start_s, peak_mib = PeakMemory_mib();
  shared->slowest_s = std::max(shared->slowest_s, took_s);
  ++shared->inputs;
  if (fault.empty() && took_s > options.most_s) fault = "took " + std::to_string(took_s) + " s";
  if (fault.empty() && peak_mib > options.most_mib && peak_mib > before_mib)
    fault = "took " + std::to_string(peak_mib) + " MiB";
  return fault;
}

// Ends at the first fault: what follows must not begin with its memory.
[[noreturn]] void Read(const Target& target, const Material& material, uint64_t seed, Clock::time_point end,
                       const fs::path& file, const Options& options, Shared* shared) {
  for (const std::string& whole : material.seeds) {  // what libraries read once, such as PROJ's database, is no file's
    std::ofstream(file, std::ios::binary | std::ios::trunc) << whole;
    target.attempt(file, {reinterpret_cast<const uint8_t*>(whole.data()), whole.size()});
  }
  Mutator mutator(target, material, seed);
  while (Clock::now() < end) {
    const std::string fault = Attempt(target, mutator.Next(), file, options, shared);
    if (fault.empty()) continue;
    std::snprintf(shared->fault, sizeof shared->fault, "%s", fault.c_str());
    _exit(3);
  }
  _exit(0);
}

std::string HowItEnded(int status, const Shared& shared) {
  if (WIFSIGNALED(status)) return std::string("died of signal ") + std::to_string(WTERMSIG(status));
  if (shared.fault[0] != '\0') return shared.fault;
  return "ended with status " + std::to_string(WEXITSTATUS(status)) + ", see above";
}

// Waits for it, and ends it where one input takes too long. The status of its end.
int Watch(pid_t child, const Options& options, Shared* shared) {
  uint64_t inputs = 0;
  auto since = Clock::now();
  while (true) {
    int status = 0;
    if (waitpid(child, &status, WNOHANG) == child) return status;
    if (shared->inputs != inputs) inputs = shared->inputs, since = Clock::now();
    const std::chrono::duration<double> waits = Clock::now() - since;
    if (waits.count() > 20 + 20 * options.most_s) {  // the machine may be busy
      std::snprintf(shared->fault, sizeof shared->fault, "hangs");
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      return 3 << 8;
    }
    usleep(20000);
  }
}

void Save(const Target& target, const std::string& name, const Options& options, const Shared& shared) {
  fs::create_directories(options.failures);
  const fs::path path = fs::path(options.failures) / (name + "." + target.extension);
  std::ofstream(path, std::ios::binary).write(shared.input, static_cast<std::streamsize>(shared.bytes));
  std::printf("  %s: %s\n", path.c_str(), shared.fault);
  std::fflush(stdout);
}

int Fuzz(const Target& target, double seconds, const fs::path& file, const Options& options, Shared* shared) {
  constexpr int kMostFaults = 20;
  const Material material = MaterialOf(target, FLANEUR_SOURCE_DIR);
  if (material.seeds.empty()) {
    std::printf("%-10s no seeds in tests/data/fuzz/%s\n", target.name, target.name);
    return 1;
  }
  *shared = {};
  int faults = 0;
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  for (uint64_t part = 0; Clock::now() < end && faults < kMostFaults; ++part) {
    shared->fault[0] = '\0';
    const uint64_t seed = options.seed * 1000003 + part;
    std::fflush(stdout);
    const pid_t child = fork();
    if (child == 0)
      Read(target, material, seed, std::min(end, Clock::now() + std::chrono::seconds(30)), file, options, shared);
    const int status = Watch(child, options, shared);
    if (status == 0) continue;
    std::snprintf(shared->fault, sizeof shared->fault, "%s", HowItEnded(status, *shared).c_str());
    Save(target, std::string(target.name) + "-" + std::to_string(options.seed) + "-" + std::to_string(faults), options,
         *shared);
    ++faults;
  }
  std::printf("%-10s %8llu inputs, %d faults, slowest %.3f s\n", target.name,
              static_cast<unsigned long long>(shared->inputs), faults, shared->slowest_s);
  std::fflush(stdout);
  return faults;
}

int Replay(const fs::path& folder, const Options& options, Shared* shared) {
  int faults = 0, files = 0;
  for (const Target& target : Targets()) {
    std::error_code ec;
    for (const auto& entry : fs::directory_iterator(fs::path(options.replay) / target.name, ec)) {
      std::ifstream in(entry.path(), std::ios::binary);
      const std::string input{std::istreambuf_iterator<char>(in), {}};
      *shared = {};
      ++files;
      const pid_t child = fork();
      if (child == 0) {
        const std::string fault =
            Attempt(target, input, folder / (std::string("input.") + target.extension), options, shared);
        std::snprintf(shared->fault, sizeof shared->fault, "%s", fault.c_str());
        _exit(fault.empty() ? 0 : 3);
      }
      const int status = Watch(child, options, shared);
      if (status == 0) continue;
      ++faults;
      std::printf("%s: %s\n", entry.path().c_str(), HowItEnded(status, *shared).c_str());
    }
  }
  std::printf("%d files, %d faults\n", files, faults);
  return files == 0 ? 1 : faults;
}

int Run(int argc, char** argv) {
  Options o;
  CLI::App app{"Reads files of every format, changed at random."};
  app.add_option("--seconds", o.seconds, "of all formats together");
  app.add_option("--seed", o.seed, "other seeds give other files");
  app.add_option("--format", o.format, "this one alone");
  app.add_option("--failures", o.failures, "folder for what failed");
  app.add_option("--most-s", o.most_s, "processor time that a file may take");
  app.add_option("--most-mib", o.most_mib, "memory that a file may take");
  app.add_option("--replay", o.replay, "folder of files, by format, instead");
  CLI11_PARSE(app, argc, argv);
  void* memory = mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return 2;
  auto* shared = static_cast<Shared*>(memory);
  const fs::path folder = fs::temp_directory_path() / ("flaneur_fuzz_" + std::to_string(getpid()));
  fs::create_directories(folder);
  int faults = 0;
  if (!o.replay.empty()) {
    faults = Replay(folder, o, shared);
  } else {
    const size_t formats = o.format.empty() ? Targets().size() : 1;
    if (!o.format.empty() && TargetNamed(o.format) == nullptr)
      return std::printf("no format %s\n", o.format.c_str()), 2;
    for (const Target& target : Targets()) {
      if (!o.format.empty() && o.format != target.name) continue;
      faults += Fuzz(target, o.seconds / static_cast<double>(formats),
                     folder / (std::string("input.") + target.extension), o, shared);
    }
  }
  fs::remove_all(folder);
  return faults == 0 ? 0 : 1;
}

}  // namespace
}  // namespace flaneur::fuzz

int main(int argc, char** argv) { return flaneur::fuzz::Run(argc, argv); }
