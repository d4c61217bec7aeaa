// A visit's surroundings without a window, a loudspeaker or a file: nothing is heard, saved or warned of.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "runtime/visit/shell.h"

namespace flaneur {

struct SilentSound : SoundOutput {
  void Play(std::vector<uint8_t>, std::string) override {}
  void Stop() override {}
  void SetPaused(bool) override {}
  void SetVolume(float) override {}
  void Update() override {}
  void Prepare(const std::vector<Recording>&) override {}
  void Hear(const Heard&) override {}
};

struct ForgetfulSettings : SettingsStore {
  Error Save(const PlayerSettings&) override { return Ok(); }
};

struct KeptWarnings : Warnings {
  void Warn(const std::string& what) override { all.push_back(what); }
  std::vector<std::string> all;
};

struct SilentShell {
  SilentSound sound;
  ForgetfulSettings settings;
  KeptWarnings warnings;
  Shell shell() { return {sound, settings, warnings, {}}; }
};

}  // namespace flaneur
