#include "runtime/visit/narration.h"

namespace flaneur {

void Narrate(const GuidedTour& tour, bool holds, const std::vector<std::vector<uint8_t>>& sounds, Narration* last,
             SoundOutput* output) {
  Narration now{tour.resting ? HaltOf(tour) : 0, tour.resting ? tour.words[HaltOf(tour)].sound : -1, tour.rested_s};
  if (now.sound >= static_cast<int>(sounds.size())) now.sound = -1;
  const bool anew = now.sound != last->sound || now.stop != last->stop || now.rested_s < last->rested_s;
  if (now.sound < 0 && last->sound >= 0) output->Stop();
  if (now.sound >= 0 && anew)
    output->Play(sounds[static_cast<size_t>(now.sound)], "stop " + std::to_string(now.stop + 1));
  output->SetPaused(holds || tour.holds);
  output->Update();
  *last = now;
}

}  // namespace flaneur
