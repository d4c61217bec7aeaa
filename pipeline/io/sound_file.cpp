#include "pipeline/io/sound_file.h"

#include <sndfile.h>

#include <memory>

#include "runtime/base/file.h"

namespace flaneur {
namespace {

constexpr float kMaxDuration_s = 3600;
constexpr sf_count_t kBlock_frames = 1 << 14;

}  // namespace

std::string SoundReaderVersion() { return sf_version_string(); }

Error ReadSoundFile(const std::filesystem::path& path, SoundFile* sound) {
  if (Error e = ReadFile(path, &sound->bytes)) return e;
  SF_INFO info{};
  const std::unique_ptr<SNDFILE, int (*)(SNDFILE*)> file(sf_open(path.c_str(), SFM_READ, &info), &sf_close);
  if (file == nullptr)
    return Fail(path.string() + ": not a sound that can be played; give WAV, FLAC, Ogg Vorbis or Opus, or MP3");
  std::vector<float> block(static_cast<size_t>(kBlock_frames) * static_cast<size_t>(info.channels));
  sf_count_t frames = 0, read = 0;
  while ((read = sf_readf_float(file.get(), block.data(), kBlock_frames)) > 0) frames += read;
  sound->duration_s = static_cast<float>(frames) / static_cast<float>(info.samplerate);
  if (sf_error(file.get()) != SF_ERR_NO_ERROR || frames == 0)
    return Fail(path.string() + ": the sound is broken or empty; save it anew");
  if (sound->duration_s > kMaxDuration_s) return Fail(path.string() + ": the sound is longer than an hour; cut it");
  return Ok();
}

}  // namespace flaneur
