// Spoken audio. Without an audio device it is silent, and says so once; as it does of a sound that cannot be decoded.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "runtime/visit/shell.h"

namespace flaneur {

class Speaker : public SoundOutput {
 public:
  Speaker();
  ~Speaker() override;
  // Decodes meanwhile, in another thread.
  void Play(std::vector<uint8_t> sound, std::string name) override;
  void Stop() override;
  void SetPaused(bool paused) override;
  void SetVolume(float share) override;
  void Update() override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flaneur
