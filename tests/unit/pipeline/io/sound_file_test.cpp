#include "pipeline/io/sound_file.h"

#include <gtest/gtest.h>
#include <sndfile.h>

#include <cmath>

#include "pipeline/core/temporary_folder.h"

namespace flaneur {
namespace {

constexpr int kRate_hz = 22050;

// Three seconds of one tone, the first `silent_s` of them silent.
std::filesystem::path Tone(const TemporaryFolder& folder, double amplitude, double hz, double silent_s = 0) {
  const std::filesystem::path path = folder.path() / "tone.wav";
  SF_INFO info{};
  info.samplerate = kRate_hz;
  info.channels = 1;
  info.format = SF_FORMAT_WAV | SF_FORMAT_PCM_16;
  SNDFILE* file = sf_open(path.c_str(), SFM_WRITE, &info);
  std::vector<double> samples(3 * kRate_hz);
  for (size_t i = 0; i < samples.size(); ++i) {
    const double t_s = static_cast<double>(i) / kRate_hz;
    samples[i] = t_s < silent_s ? 0 : amplitude * std::sin(2 * M_PI * hz * t_s);
  }
  sf_write_double(file, samples.data(), static_cast<sf_count_t>(samples.size()));
  sf_close(file);
  return path;
}

double Gain_db(const std::filesystem::path& path, double loudness_lufs, double most_peak_dbtp) {
  double gain_db = -1000;
  const Error error = GainToLoudness_db(path, loudness_lufs, most_peak_dbtp, &gain_db);
  EXPECT_FALSE(error) << error.message;
  return gain_db;
}

// ITU-R BS.1770-4: a sine of 997 Hz at 0 dBFS in one channel is -3.01 LKFS.
TEST(GainToLoudness, BringsATonesLoudnessToWhatIsAsked) {
  TemporaryFolder folder;
  ASSERT_FALSE(folder.Create("flaneur_sound_"));
  EXPECT_NEAR(Gain_db(Tone(folder, 0.1, 997), -18, -2), -18 + 20 + 3.01, 0.1);
  EXPECT_NEAR(Gain_db(Tone(folder, 0.9, 997), -18, -2), -18 + 0.915 + 3.01, 0.1);
  EXPECT_NEAR(Gain_db(Tone(folder, 0.1, 997, 1.5), -18, -2), -18 + 20 + 3.01, 0.6) << "pauses do not count";
}

TEST(GainToLoudness, LeavesRoomForPeaksAndSilenceAlone) {
  TemporaryFolder folder;
  ASSERT_FALSE(folder.Create("flaneur_sound_"));
  EXPECT_NEAR(Gain_db(Tone(folder, 0.1, 997), -4, -6), 14, 0.1) << "peaks at -6 dB";
  EXPECT_EQ(Gain_db(Tone(folder, 0, 997), -18, -2), 0);
}

TEST(EncodeSpeech, IsAsLongAndAsLoudAsAskedAndTheSameEachTime) {
  TemporaryFolder folder;
  ASSERT_FALSE(folder.Create("flaneur_sound_"));
  const std::filesystem::path tone = Tone(folder, 0.1, 997), once = folder.path() / "once", again = folder.path() / "2";
  ASSERT_FALSE(EncodeSpeech(tone, Gain_db(tone, -18, -2), once));
  ASSERT_FALSE(EncodeSpeech(tone, Gain_db(tone, -18, -2), again));
  SoundFile first, second;
  ASSERT_FALSE(ReadSoundFile(once, &first));
  ASSERT_FALSE(ReadSoundFile(again, &second));
  EXPECT_NEAR(first.duration_s, 3, 0.01f);
  EXPECT_NEAR(Gain_db(once, -18, -2), 0, 0.5);
  EXPECT_LT(first.bytes.size(), 15000u);
  EXPECT_EQ(first.bytes, second.bytes);
}

TEST(EncodeSpeech, SaysWhatCannotBeWritten) {
  TemporaryFolder folder;
  ASSERT_FALSE(folder.Create("flaneur_sound_"));
  const Error error = EncodeSpeech(Tone(folder, 0.1, 997), 0, folder.path() / "missing" / "out.ogg");
  EXPECT_NE(error.message.find("missing/out.ogg"), std::string::npos) << error.message;
}

TEST(GainToLoudness, SaysWhatIsNoSound) {
  double gain_db = 0;
  const Error error = GainToLoudness_db("/dev/null", -18, -2, &gain_db);
  EXPECT_NE(error.message.find("/dev/null"), std::string::npos) << error.message;
}

}  // namespace
}  // namespace flaneur
