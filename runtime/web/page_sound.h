// What is heard, for a page to let it sound: it asks some times a second. Internal to runtime/web.
#pragma once
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "runtime/visit/shell.h"
#include "runtime/visit/synthesis.h"

namespace flaneur {

class PageSound : public SoundOutput {
 public:
  void Play(std::vector<uint8_t> sound, std::string name) override;
  void Stop() override { speaks_ = false; }
  void SetPaused(bool paused) override { paused_ = paused; }
  void SetVolume(float share) override { volume_ = share; }
  void Update() override {}
  void Prepare(const std::vector<Recording>& recordings) override { recordings_ = recordings; }
  void Hear(const Heard& heard) override;

  // What sounds now, from the listener: x to the right, y up, z behind. What begins is told once.
  nlohmann::json Take();
  // A file's bytes, as of the number that Take tells.
  std::span<const uint8_t> Spoken() const { return spoken_; }
  // A file's bytes, which may still be on their way (empty), or one channel of 16-bit samples of kSynthesisRate_hz,
  // which are computed a part a call until they are there (empty).
  std::span<const uint8_t> BytesOf(size_t recording);
  bool IsComputed(size_t recording) const;

 private:
  std::vector<uint8_t> spoken_;
  int number_ = 0;  // of what was spoken so far
  bool speaks_ = false, paused_ = false;
  float volume_ = 1;
  std::vector<Recording> recordings_;
  std::map<size_t, Synthesis> begun_;  // by recording
  std::vector<int16_t> computed_;      // the last one that was finished
  Heard heard_;
  std::vector<HeardSound> once_;  // since Take
};

}  // namespace flaneur
