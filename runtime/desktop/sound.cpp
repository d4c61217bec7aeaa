#include "runtime/desktop/sound.h"

#include <sndfile.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "runtime/base/limits.h"

namespace flaneur {
namespace {

constexpr sf_count_t kBlock_frames = 4096;

// The bytes as a file for libsndfile.
struct Memory {
  const std::vector<uint8_t>* bytes;
  sf_count_t at = 0;
};

sf_count_t SizeOf(void* memory) { return static_cast<sf_count_t>(static_cast<Memory*>(memory)->bytes->size()); }

sf_count_t Seek(sf_count_t offset, int whence, void* memory) {
  auto* m = static_cast<Memory*>(memory);
  const sf_count_t from = whence == SEEK_CUR ? m->at : whence == SEEK_END ? SizeOf(memory) : 0;
  m->at = std::clamp<sf_count_t>(from + offset, 0, SizeOf(memory));
  return m->at;
}

sf_count_t Read(void* to, sf_count_t count, void* memory) {
  auto* m = static_cast<Memory*>(memory);
  const sf_count_t n = std::clamp<sf_count_t>(SizeOf(memory) - m->at, 0, count);
  if (n > 0) std::memcpy(to, m->bytes->data() + m->at, static_cast<size_t>(n));
  m->at += n;
  return n;
}

sf_count_t Write(const void*, sf_count_t, void*) { return 0; }
sf_count_t Tell(void* memory) { return static_cast<Memory*>(memory)->at; }

}  // namespace

Sound DecodeSound(const std::vector<uint8_t>& bytes) {
  Memory memory{&bytes};
  SF_VIRTUAL_IO io{SizeOf, Seek, Read, Write, Tell};
  SF_INFO info{};
  const std::unique_ptr<SNDFILE, int (*)(SNDFILE*)> file(sf_open_virtual(&io, SFM_READ, &info, &memory), &sf_close);
  Sound out;
  if (file == nullptr || info.channels < 1 || info.frames < 1 || info.frames > kMostSound_frames) return out;
  out.channels = info.channels == 2 ? 2 : 1;
  out.rate_hz = info.samplerate;
  // Read as floats, -1 to 1 whatever the file holds: as integers a file of floats would be silent.
  std::vector<float> block(static_cast<size_t>(info.channels) * kBlock_frames);
  sf_count_t read = 0;
  while ((read = sf_readf_float(file.get(), block.data(), kBlock_frames)) > 0) {
    for (size_t frame = 0; frame < static_cast<size_t>(read); ++frame) {
      for (int c = 0; c < out.channels; ++c) {
        const float value =
            block[frame * static_cast<size_t>(info.channels) + static_cast<size_t>(c)];  // maybe not a number
        out.samples.push_back(static_cast<int16_t>((value > -1 ? std::min(value, 1.0f) : -1.0f) * 32767));
      }
    }
  }
  return out;
}

}  // namespace flaneur
