#include "runtime/player/speaker.h"

#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <thread>

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

// Whether there is an audio device or not.
TEST(Speaker, PlaysBrokenSoundsWithoutHarm) {
  Speaker speaker;
  std::mt19937 random(3);
  const std::vector<uint8_t> tone = Tone();
  for (int round = 0; round < 40; ++round) {
    std::vector<uint8_t> sound = tone;
    for (int k = 0; k < 4; ++k) sound[random() % 44] = static_cast<uint8_t>(random());
    sound.resize(random() % sound.size());
    speaker.Play(sound);
    speaker.SetPaused(round % 3 == 0);
    speaker.Update();
    if (round % 5 == 0) speaker.Stop();
  }
  speaker.Play({});
}

TEST(Speaker, FollowsATourThatStopsAndGoes) {
  Speaker speaker;
  Tour tour;
  TourStop stop;
  stop.caption = "Here.";
  stop.sounds["en"] = {0, 0.1f};
  TakeTour({stop}, "en", &tour);
  tour.stage = {0};
  Narration last;
  const std::vector<std::vector<uint8_t>> sounds{Tone()};
  for (int step = 0; step < 60; ++step) {
    tour.resting = step > 10 && step < 50;
    tour.rested_s = tour.resting ? static_cast<float>(step - 10) / 30 : 0;
    tour.holds = step > 20 && step < 30;
    Narrate(tour, false, sounds, &last, &speaker);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(last.sound, -1);
}

}  // namespace
}  // namespace flaneur
