// Watchdog of jams: empties rooms drawn at random and says which stay full.
//
//     bench_rooms [ROOMS] [FIRST]      # 1,000 rooms of 100 people, from number FIRST on; exit status 1: some stay full
#include <cstdio>
#include <cstdlib>

#include "tests/unit/runtime/crowd/rooms.h"

int main(int count, char** words) {
  using namespace flaneur;
  constexpr float kMost_s = 900;
  const int rooms = count > 1 ? std::atoi(words[1]) : 1000, first = count > 2 ? std::atoi(words[2]) : 1;
  int emptied = 0, people = 0;
  double longest_s = 0, slowest_s = 0;
  for (int k = first; k < first + rooms; ++k) {
    const RoomPlan plan = RandomRoom(static_cast<uint64_t>(k));
    Room room = MakeRoom(plan);
    const RoomOutcome o = EmptyRoom(&room, kMost_s);
    people += o.people;
    emptied += o.left == 0 ? 1 : 0;
    if (o.left == 0) slowest_s = std::max(slowest_s, static_cast<double>(o.empty_s));
    longest_s = std::max(longest_s, static_cast<double>(o.longest_s));
    if (o.left > 0) std::printf("%s: %d of %d left\n", Described(plan).c_str(), o.left, o.people);
    std::fflush(stdout);
  }
  std::printf("%d of %d rooms emptied, %d people; the slowest after %.0f s; nobody came out for %.0f s at most\n",
              emptied, rooms, people, slowest_s, longest_s);
  return emptied == rooms ? 0 : 1;
}
