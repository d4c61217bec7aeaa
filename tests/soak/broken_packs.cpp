// A pack damaged at random, again and again, and each of those played: broken_packs PACK [HOW_OFTEN [SEED]]. What is
// refused must be refused in one line; the rest must give pictures. Run it with the address sanitizer too. Exit status:
// 0 nothing was wrong, 1 something was, 77 there is no OpenGL.
#include <sys/time.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "runtime/desktop/context.h"
#include "runtime/show/guide_figure.h"
#include "runtime/simulation/scenario.h"
#include "runtime/visit/visit.h"
#include "tests/soak/drivers_stay_loaded.h"
#include "tests/unit/runtime/visit/silent_shell.h"

namespace flaneur {
namespace {

constexpr int kSkipped = 77;
constexpr int kLongest_s = 120;  // of processor time for one pack; who takes longer hangs
constexpr int kPictures = 8;
constexpr size_t kHeader_bytes = 20;

class Damage {
 public:
  Damage(std::string whole, uint64_t seed) : whole_(std::move(whole)), random_(seed) {
    json_bytes_ = std::min<size_t>(static_cast<uint8_t>(whole_[12]) | size_t{static_cast<uint8_t>(whole_[13])} << 8 |
                                       size_t{static_cast<uint8_t>(whole_[14])} << 16,
                                   whole_.size() - kHeader_bytes);
  }
  // One to four bits anywhere, or bits or a digit of the text at its beginning, which says what all the rest means.
  std::string Next() {
    std::string bytes = whole_;
    const bool in_text = Below(2) == 0;
    for (size_t k = 0, count = 1 + Below(4); k < count; ++k) {
      const size_t at = in_text ? kHeader_bytes + Below(json_bytes_) : Below(bytes.size());
      if (in_text && Below(3) > 0) ReplaceDigit(at, &bytes);
      else bytes[at] = static_cast<char>(bytes[at] ^ 1 << Below(8));
    }
    return bytes;
  }

 private:
  size_t Below(size_t end) { return random_() % end; }
  void ReplaceDigit(size_t from, std::string* bytes) {
    const size_t at = bytes->find_first_of("0123456789", from);
    if (at < kHeader_bytes + json_bytes_) (*bytes)[at] = "0123456789-.e"[Below(13)];
  }

  std::string whole_;
  size_t json_bytes_ = 0;
  std::mt19937_64 random_;
};

struct Counts {
  int refused = 0, played = 0;
};

Error Play(const std::filesystem::path& path, Counts* counts) {
  Jobs jobs(static_cast<size_t>(counts->played + counts->refused) % 4);
  TourPack pack;
  PackFile file;
  if (Error e = file.Open(path, &pack)) return e;
  AddGuideFigure(&pack);
  Scenario scenario = ScenarioOf(pack);
  scenario.crowd.people = 20;
  Simulation s;
  if (Error e = StartSimulation(&pack, scenario, &s, &jobs)) return e;
  HeadlessContext context;  // one a pack: what was drawn with goes with it
  if (Error e = context.Create()) return e;
  SilentShell silent;
  Loader loader(&jobs);
  loader.Start(std::move(file), pack);
  Visit visit(pack, &loader, {}, silent.shell(), &s);
  if (Error e = visit.Begin()) return e;
  for (bool there = false; !there;) {
    if (Error e = visit.Load(&there)) return e;
  }
  if (Error e = visit.Enter(true)) return e;
  Records records;
  for (int k = 0; k < kPictures || !loader.Done(); ++k) {
    if (Error e = visit.Picture({}, 64, 36, k < kPictures ? 0.1f : 0, &records)) return e;
  }
  ++counts->played;
  return Ok();
}

bool IsOneLine(const std::string& text) { return !text.empty() && text.find_first_of("\r\n") == std::string::npos; }

int Run(const std::filesystem::path& pack, int how_often, uint64_t seed) {
  if (HeadlessContext context; Error e = context.Create()) {
    std::printf("%s\n", e.message.c_str());
    return kSkipped;
  }
  std::ifstream whole(pack, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(whole), {}};
  if (bytes.size() <= kHeader_bytes) {
    std::fprintf(stderr, "broken_packs: %s is no pack\n", pack.c_str());
    return 1;
  }
  Damage damage(std::move(bytes), seed);
  const auto path = std::filesystem::temp_directory_path() / ("flaneur_broken_" + std::to_string(::getpid()) + ".glb");
  Counts counts;
  std::error_code ec;
  for (int k = 0; k < how_often; ++k) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << damage.Next();
    const itimerval limit{{}, {kLongest_s, 0}};
    ::setitimer(ITIMER_PROF, &limit, nullptr);
    const Error error = Play(path, &counts);
    if (!error) continue;
    ++counts.refused;
    if (IsOneLine(error.message)) continue;
    std::printf("wrong: pack %d is refused in other than one line: '%s'; it is kept as %s\n", k, error.message.c_str(),
                path.c_str());
    return 1;
  }
  std::filesystem::remove(path, ec);
  std::printf("seed %llu: %d broken packs, %d refused, %d played\n", static_cast<unsigned long long>(seed), how_often,
              counts.refused, counts.played);
  return 0;
}

}  // namespace
}  // namespace flaneur

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "broken_packs PACK [HOW_OFTEN [SEED]]\n");
    return 2;
  }
  return flaneur::Run(argv[1], argc > 2 ? std::atoi(argv[2]) : 1000,
                      argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1);
}
