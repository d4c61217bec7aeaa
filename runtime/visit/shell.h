// What a visit needs of the program around it: a window's, a page's or a test's.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/base/jobs.h"
#include "runtime/text/fonts.h"
#include "runtime/visit/heard.h"
#include "runtime/visit/player_settings.h"
#include "runtime/visit/visit_log.h"
#include "runtime/visit/window_input.h"

namespace flaneur {

// Where spoken audio goes.
class SoundOutput {
 public:
  virtual ~SoundOutput() = default;
  // From its beginning, instead of what is playing: a file's bytes (WAV, FLAC, Ogg, MP3). name: for a warning.
  virtual void Play(std::vector<uint8_t> sound, std::string name) = 0;
  virtual void Stop() = 0;
  virtual void SetPaused(bool paused) = 0;
  virtual void SetVolume(float share) = 0;  // 1: as recorded
  virtual void Update() = 0;                // once a picture
  // The town's own sounds, by number, made ready beside everything else; once, before Hear. Files outlive it.
  virtual void Prepare(const std::vector<Recording>& recordings) = 0;
  virtual void Hear(const Heard& heard) = 0;  // once a picture
};

// Where what the visitor changes is kept for the next time.
class SettingsStore {
 public:
  virtual ~SettingsStore() = default;
  virtual Error Save(const PlayerSettings& now) = 0;
};

// Who hears of what is not as it should be, and yet goes on.
class Warnings {
 public:
  virtual ~Warnings() = default;
  virtual void Warn(const std::string& what) = 0;
};

// All of them outlive the visit.
struct Shell {
  SoundOutput& sound;
  SettingsStore& settings;
  Warnings& warnings;
  KeyLayout layout;            // may be empty
  Fonts* fonts = nullptr;      // of all that is read; null: the built-in one
  Jobs* jobs = nullptr;        // for photos; null: they are written at once
  VisitLog* visits = nullptr;  // of a kiosk; null: nobody keeps them
};

}  // namespace flaneur
