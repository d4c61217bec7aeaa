// Spoken audio. Without an audio device it is silent, and says so once; as it does of a sound that cannot be decoded.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "runtime/player/tour.h"

namespace flaneur {

class Speaker {
 public:
  Speaker();
  ~Speaker();
  // From its beginning, instead of what is playing. The file's bytes (WAV, FLAC, Ogg, MP3) are decoded meanwhile, in another thread.
  // name: for a warning.
  void Play(std::vector<uint8_t> sound, std::string name);
  void Stop();
  void SetPaused(bool paused);
  void SetVolume(float share);  // 1: as recorded
  void Update();  // once a picture

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// What the tour says where it rests now. holds: everything stands still.
struct Narration { size_t stop = 0; int sound = -1; float rested_s = 0; };
void Narrate(const Tour& tour, bool holds, const std::vector<std::vector<uint8_t>>& sounds, Narration* last, Speaker* speaker);

}  // namespace flaneur
