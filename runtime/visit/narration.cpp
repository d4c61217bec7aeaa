#include "runtime/visit/narration.h"

namespace flaneur {
namespace {

Narration Wanted(const GuidedTour& tour, const Aside& aside) {
  const Narration of_tour{tour.resting ? HaltOf(tour) : 0, tour.resting ? tour.words[HaltOf(tour)].sound : -1, -1,
                          tour.rested_s};
  if (aside.sound < 0 || (of_tour.sound >= 0 && !tour.holds)) return of_tour;
  return {of_tour.stop, aside.sound, aside.hotspot, 0};
}

}  // namespace

void Narrate(const GuidedTour& tour, const Aside& aside, bool holds, const std::vector<std::vector<uint8_t>>& sounds,
             Narration* last, SoundOutput* output) {
  Narration now = Wanted(tour, aside);
  if (now.sound >= static_cast<int>(sounds.size())) now.sound = -1;
  const bool anew = now.sound != last->sound || now.stop != last->stop || now.hotspot != last->hotspot ||
                    now.rested_s < last->rested_s;
  if (now.sound < 0 && last->sound >= 0) output->Stop();
  if (now.sound >= 0 && anew) {
    const bool of_stop = now.hotspot < 0;
    output->Play(sounds[static_cast<size_t>(now.sound)],
                 of_stop ? "stop " + std::to_string(now.stop + 1) : "hotspot " + std::to_string(now.hotspot + 1));
  }
  output->SetPaused(holds || (now.hotspot < 0 && tour.holds));
  output->Update();
  *last = now;
}

}  // namespace flaneur
