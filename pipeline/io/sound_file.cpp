#include "pipeline/io/sound_file.h"

#include <ebur128.h>
#include <opusenc.h>
#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "runtime/base/file.h"

namespace flaneur {
namespace {

constexpr float kMaxDuration_s = 3600;
constexpr int kSpeech_bps = 28000;  // for each channel
constexpr sf_count_t kBlock_frames = 1 << 14;

// Decodes a sound to its end: `take` gets it in blocks of interleaved samples.
Error Decode(const std::filesystem::path& path, SF_INFO* info,
             const std::function<void(const float* samples, size_t frames)>& take) {
  const std::unique_ptr<SNDFILE, int (*)(SNDFILE*)> file(sf_open(path.c_str(), SFM_READ, info), &sf_close);
  if (file == nullptr)
    return Fail(
        path.string() +
        ": not a sound that can be played; give WAV, FLAC, Ogg Vorbis or Opus, or MP3 (ffmpeg -i FILE sound.flac " +
        "makes one of an .m4a)");
  std::vector<float> block(static_cast<size_t>(kBlock_frames) * static_cast<size_t>(info->channels));
  sf_count_t frames = 0, read = 0;
  while ((read = sf_readf_float(file.get(), block.data(), kBlock_frames)) > 0) {
    frames += read;
    take(block.data(), static_cast<size_t>(read));
  }
  if (sf_error(file.get()) != SF_ERR_NO_ERROR || frames == 0)
    return Fail(path.string() + ": the sound is broken or empty; save it anew");
  return Ok();
}

}  // namespace

std::string SoundReaderVersion() { return sf_version_string(); }

Error ReadSoundFile(const std::filesystem::path& path, SoundFile* sound) {
  if (Error e = ReadFile(path, &sound->bytes)) return e;
  SF_INFO info{};
  size_t frames = 0;
  if (Error e = Decode(path, &info, [&](const float*, size_t more) { frames += more; })) return e;
  sound->duration_s = static_cast<float>(frames) / static_cast<float>(info.samplerate);
  if (sound->duration_s > kMaxDuration_s) return Fail(path.string() + ": the sound is longer than an hour; cut it");
  return Ok();
}

Error GainToLoudness_db(const std::filesystem::path& path, double loudness_lufs, double most_peak_dbtp,
                        double* gain_db) {
  SF_INFO info{};
  const auto destroy = [](ebur128_state* state) { ebur128_destroy(&state); };
  std::unique_ptr<ebur128_state, decltype(destroy)> meter(nullptr, destroy);
  const Error error = Decode(path, &info, [&](const float* samples, size_t frames) {
    if (meter == nullptr)
      meter.reset(ebur128_init(static_cast<unsigned>(info.channels), static_cast<unsigned long>(info.samplerate),
                               EBUR128_MODE_I | EBUR128_MODE_TRUE_PEAK));
    if (meter != nullptr) ebur128_add_frames_float(meter.get(), samples, frames);
  });
  if (error) return error;
  double loudness = -HUGE_VAL, peak = 0;
  if (meter != nullptr) ebur128_loudness_global(meter.get(), &loudness);
  for (unsigned channel = 0; meter != nullptr && channel < static_cast<unsigned>(info.channels); ++channel) {
    double own = 0;
    if (ebur128_true_peak(meter.get(), channel, &own) == EBUR128_SUCCESS) peak = std::max(peak, own);
  }
  *gain_db = std::isfinite(loudness) && peak > 0
                 ? std::min(loudness_lufs - loudness, most_peak_dbtp - 20 * std::log10(peak))
                 : 0;
  return Ok();
}

Error EncodeSpeech(const std::filesystem::path& from, double gain_db, const std::filesystem::path& to) {
  const std::unique_ptr<OggOpusComments, void (*)(OggOpusComments*)> comments(ope_comments_create(),
                                                                              &ope_comments_destroy);
  std::unique_ptr<OggOpusEnc, void (*)(OggOpusEnc*)> encoder(nullptr, &ope_encoder_destroy);
  SF_INFO info{};
  int status = OPE_OK;
  std::vector<float> louder;
  const float gain = static_cast<float>(std::pow(10, gain_db / 20));
  const Error error = Decode(from, &info, [&](const float* samples, size_t frames) {
    if (encoder == nullptr && status == OPE_OK) {
      encoder.reset(ope_encoder_create_file(to.c_str(), comments.get(), info.samplerate, info.channels, 0, &status));
      if (encoder == nullptr) return;
      ope_encoder_ctl(encoder.get(), OPUS_SET_BITRATE(kSpeech_bps * info.channels));
      ope_encoder_ctl(encoder.get(), OPUS_SET_SIGNAL(OPUS_SIGNAL_VOICE));
      ope_encoder_ctl(encoder.get(), OPE_SET_SERIALNO(1));  // else it is drawn by chance
    }
    if (status != OPE_OK) return;
    louder.assign(samples, samples + frames * static_cast<size_t>(info.channels));
    for (float& sample : louder) sample *= gain;
    status = ope_encoder_write_float(encoder.get(), louder.data(), static_cast<int>(frames));
  });
  if (error) return error;
  if (status == OPE_OK) status = ope_encoder_drain(encoder.get());
  return status == OPE_OK ? Ok() : Fail(to.string() + ": cannot be written as Opus: " + ope_strerror(status));
}

}  // namespace flaneur
