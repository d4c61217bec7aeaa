// Spoken audio and the sounds of the town, each from its place. Without an audio device it is silent, and says so once;
// as it does of a sound that cannot be decoded.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "runtime/base/jobs.h"
#include "runtime/visit/shell.h"

namespace flaneur {

class Speaker : public SoundOutput {
 public:
  // `jobs` outlives it.
  explicit Speaker(Jobs* jobs = nullptr);
  ~Speaker() override;
  // Opens the device and decodes meanwhile, where there are threads; else in the next Update.
  void Play(std::vector<uint8_t> sound, std::string name) override;
  void Stop() override;
  void SetPaused(bool paused) override;
  void SetVolume(float share) override;
  void Update() override;
  // Likewise opens the device and makes them ready meanwhile; until then nothing is heard of them.
  void Prepare(const std::vector<Recording>& recordings) override;
  void Hear(const Heard& heard) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flaneur
