// Spoken audio, decoded. Internal to runtime/desktop.
#pragma once
#include <cstdint>
#include <vector>

namespace flaneur {

struct Sound {
  std::vector<int16_t> samples;   // frame by frame
  int channels = 0, rate_hz = 0;  // one channel or two
};

// Of a file's bytes: WAV, FLAC, Ogg, MP3. Of more than two channels the first is heard. Empty where the bytes are no
// sound; what a truncated file still holds.
Sound DecodeSound(const std::vector<uint8_t>& bytes);

}  // namespace flaneur
