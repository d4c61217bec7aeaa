#include "runtime/desktop/speaker.h"

#include <gtest/gtest.h>
#include <sndfile.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <thread>

#include "runtime/base/file.h"
#include "runtime/desktop/sound.h"
#include "runtime/visit/narration.h"

namespace flaneur {
namespace {

// A tenth of a second of a tone, as WAV.
std::vector<uint8_t> Tone() {
  constexpr uint32_t kRate = 8000, kBytes = kRate / 10 * 2;
  std::vector<uint8_t> wav;
  wav.reserve(44 + kBytes);
  const auto text = [&](const char* four) {
    for (int k = 0; k < 4; ++k) wav.push_back(static_cast<uint8_t>(four[k]));
  };
  const auto word = [&](uint32_t value, int bytes) {
    for (int k = 0; k < bytes; ++k) wav.push_back(static_cast<uint8_t>(value >> (8 * k)));
  };
  text("RIFF"), word(36 + kBytes, 4), text("WAVE"), text("fmt "), word(16, 4), word(1, 2), word(1, 2);
  word(kRate, 4), word(2 * kRate, 4), word(2, 2), word(16, 2), text("data"), word(kBytes, 4);
  for (uint32_t k = 0; k < kBytes / 2; ++k) word(k % 20 < 10 ? 3000 : 62536, 2);
  return wav;
}

// OpenAL plays into a file here, which stands for ears.
class Ears : public ::testing::Environment {
 public:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("flaneur_speaker_" + std::to_string(::getpid()));
    const std::filesystem::path settings = folder_ / "alsoft.conf";
    ASSERT_FALSE(WriteTextFile(settings, "[general]\ndrivers = wave\n[wave]\nfile = " + Heard().string() + "\n"));
    ::setenv("ALSOFT_CONF", settings.c_str(), 1);
    ::setenv("ALSOFT_DRIVERS", "wave", 1);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path Heard() const { return folder_ / "heard.wav"; }

 private:
  std::filesystem::path folder_;
};
const Ears* const ears = dynamic_cast<Ears*>(::testing::AddGlobalTestEnvironment(new Ears));

// The loudest sample that was heard since OpenAL opened its device last, of 32767.
int Loudest() {
  std::vector<uint8_t> bytes;
  EXPECT_FALSE(ReadFile(ears->Heard(), &bytes));
  const Sound heard = DecodeSound(bytes);
  int loudest = 0;
  for (int16_t sample : heard.samples) loudest = std::max(loudest, std::abs(int{sample}));
  return loudest;
}

// A tone of half a second, as a file of that libsndfile format.
std::vector<uint8_t> Encoded(int format, int channels) {
  const auto path = std::filesystem::temp_directory_path() / ("flaneur_tone_" + std::to_string(::getpid()));
  SF_INFO info{0, 16000, channels, format, 0, 0};
  SNDFILE* file = sf_open(path.c_str(), SFM_WRITE, &info);
  if (file == nullptr) return {};
  std::vector<float> tone(static_cast<size_t>(8000 * channels));
  for (size_t k = 0; k < tone.size(); ++k)
    tone[k] = 0.5f * std::sin(static_cast<float>(k / static_cast<size_t>(channels)) * 0.2f);
  sf_writef_float(file, tone.data(), 8000);
  sf_close(file);
  std::vector<uint8_t> bytes;
  EXPECT_FALSE(ReadFile(path, &bytes));
  std::filesystem::remove(path);
  return bytes;
}

constexpr int kFormats[] = {SF_FORMAT_WAV | SF_FORMAT_PCM_16, SF_FORMAT_FLAC | SF_FORMAT_PCM_16,
                            SF_FORMAT_OGG | SF_FORMAT_VORBIS, SF_FORMAT_OGG | SF_FORMAT_OPUS,
                            SF_FORMAT_WAV | SF_FORMAT_FLOAT};

TEST(Sound, IsReadFromEveryKindOfFile) {
  for (int format : kFormats) {
    for (int channels : {1, 2, 4}) {
      if (channels == 4 && format == kFormats[3]) continue;  // libsndfile writes no such Opus
      const Sound sound = DecodeSound(Encoded(format, channels));
      EXPECT_EQ(sound.channels, channels == 2 ? 2 : 1) << std::hex << format;
      ASSERT_GT(sound.rate_hz, 0) << std::hex << format;
      const auto frames = static_cast<float>(sound.samples.size()) / static_cast<float>(sound.channels);
      EXPECT_NEAR(frames / static_cast<float>(sound.rate_hz), 0.5f, 0.05f) << std::hex << format;
      const auto [low, high] = std::minmax_element(sound.samples.begin(), sound.samples.end());
      EXPECT_NEAR(*high, 16384, 2500) << std::hex << format;
      EXPECT_NEAR(*low, -16384, 2500) << std::hex << format;
    }
  }
}

TEST(Sound, IsNothingWhereTheFileIsNone) {
  EXPECT_TRUE(DecodeSound({}).samples.empty());
  EXPECT_TRUE(DecodeSound({'n', 'o', ' ', 's', 'o', 'u', 'n', 'd'}).samples.empty());
  EXPECT_TRUE(DecodeSound(std::vector<uint8_t>(5000, 7)).samples.empty());
}

TEST(Sound, CutOffAnywhereIsNeverLongerNorHarmful) {
  for (int format : kFormats) {
    const std::vector<uint8_t> whole = Encoded(format, 1);
    const size_t all = DecodeSound(whole).samples.size();
    for (size_t bytes = 0; bytes < whole.size(); bytes += 1 + whole.size() / 60) {
      EXPECT_LE(DecodeSound({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(bytes)}).samples.size(), all);
    }
  }
}

// Whether there is an audio device or not.
TEST(Speaker, PlaysBrokenSoundsWithoutHarm) {
  Speaker speaker;
  std::mt19937 random(3);
  const std::vector<uint8_t> tone = Tone();
  for (int round = 0; round < 40; ++round) {
    std::vector<uint8_t> sound = tone;
    for (int k = 0; k < 4; ++k) sound[random() % 44] = static_cast<uint8_t>(random());
    sound.resize(random() % sound.size());
    speaker.Play(sound, "a stop");
    speaker.SetPaused(round % 3 == 0);
    speaker.Update();
    if (round % 5 == 0) speaker.Stop();
  }
  speaker.Play({}, "a stop");
}

TEST(Speaker, SaysOnceThatASoundCannotBeDecoded) {
  testing::internal::CaptureStderr();
  {
    Speaker speaker;
    for (int round = 0; round < 3; ++round) {
      speaker.Play(std::vector<uint8_t>(5000, 7), "stop 4");
      for (int k = 0; k < 200; ++k) {
        speaker.Update();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    }
  }
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
  EXPECT_NE(said.find("stop 4 cannot be decoded"), std::string::npos) << said;
}

TEST(Speaker, IsHeardAsLoudAsAskedFor) {
  const auto loudest_at = [](float volume) {
    {
      Speaker speaker;
      speaker.SetVolume(volume);
      speaker.Play(Encoded(kFormats[1], 1), "a stop");
      for (int k = 0; k < 60; ++k) {
        speaker.Update();
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
    }
    return Loudest();
  };
  const int full = loudest_at(1), half = loudest_at(0.5f);
  EXPECT_GT(full, 5000);
  EXPECT_NEAR(half, full / 2, full / 8);
  EXPECT_EQ(loudest_at(0), 0);
}

TEST(Speaker, FollowsATourThatStopsAndGoes) {
  Speaker speaker;
  GuidedTour tour;
  TourStop stop;
  stop.caption = "Here.";
  stop.sounds["en"] = {0, 0.1f};
  TakeStops({stop}, "en", &tour);
  tour.stage = {0};
  Narration last;
  const std::vector<std::vector<uint8_t>> sounds{Tone()};
  for (int step = 0; step < 60; ++step) {
    tour.resting = step > 10 && step < 50;
    tour.rested_s = tour.resting ? static_cast<float>(step - 10) / 30 : 0;
    tour.holds = step > 20 && step < 30;
    Narrate(tour, {}, false, sounds, &last, &speaker);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(last.sound, -1);
}

TEST(Speaker, SaysWhatTheTourSaysAtAStopAndHoldsItsBreath) {
  const std::vector<std::vector<uint8_t>> sounds{Encoded(kFormats[2], 1)};
  const auto loudest = [&](bool holds) {
    {
      Speaker speaker;
      GuidedTour tour;
      TourStop stop;
      stop.sounds["en"] = {0, 0.5f};
      TakeStops({stop}, "en", &tour);
      tour.stage = {0};
      tour.resting = true;
      Narration last;
      for (int step = 0; step < 60; ++step) {
        tour.rested_s = static_cast<float>(step) / 100;
        Narrate(tour, {}, holds, sounds, &last, &speaker);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
    }
    return Loudest();
  };
  EXPECT_GT(loudest(false), 5000);
  EXPECT_EQ(loudest(true), 0);
}

// What OpenAL played of the town's sounds for half a second.
int LoudestOfTown(float volume, float gain, bool once) {
  {
    Speaker speaker;
    speaker.SetVolume(volume);
    speaker.Prepare({{SoundKind::kMurmur, 0, nullptr}, {SoundKind::kBell, 0, nullptr}});
    Heard heard;
    for (int step = 0; step < 60; ++step) {
      heard.round.clear();
      heard.once.clear();
      if (once && step % 20 == 5) heard.once.push_back({0, 1, {3, 0, 0}, gain, 1});
      if (!once) heard.round.push_back({7, 0, {0, 4, 0}, gain, 1});
      speaker.Hear(heard);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  return Loudest();
}

TEST(Speaker, LetsTheTownSoundUnlessItIsTurnedOff) {
  EXPECT_GT(LoudestOfTown(1, 1, true), 3000);
  EXPECT_GT(LoudestOfTown(1, 1, false), 1000);
  EXPECT_EQ(LoudestOfTown(0, 1, true), 0);
  EXPECT_EQ(LoudestOfTown(0, 1, false), 0);
  EXPECT_EQ(LoudestOfTown(1, 0, false), 0);
}

TEST(Speaker, WhatIsNoSoundLeavesTheOthersAsTheyAre) {
  const std::vector<uint8_t> noise(500, 7);
  {
    Speaker speaker;
    speaker.Prepare({{SoundKind::kLoop, 0, &noise}, {SoundKind::kBell, 0, nullptr}});
    Heard heard;
    for (int step = 0; step < 60; ++step) {
      heard.round = {{3, 0, {}, 1, 1}, {4, 12, {}, 1, 1}, {5, -1, {}, 1, 1}};
      heard.once.clear();
      if (step == 20) heard.once = {{0, 1, {3, 0, 0}, 1, 1}};
      speaker.Hear(heard);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  EXPECT_GT(Loudest(), 3000);
}

}  // namespace
}  // namespace flaneur
