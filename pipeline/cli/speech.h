// Texts spoken by espeak-ng, as small sound files. Internal to pipeline/cli.
#pragma once
#include <filesystem>
#include <string>

#include "pipeline/core/store.h"
#include "runtime/base/error.h"

namespace flaneur {

struct Speech {
  std::string text;   // UTF-8
  std::string voice;  // of espeak-ng, such as "en-gb" or "de"
  int words_per_minute = 145;
};

// Makes an Ogg Opus file in the store, or finds the one that an earlier bake made of the same. Errors: no espeak-ng
// on PATH, an unknown voice.
Error Speak(const Speech& speech, const Store& store, std::filesystem::path* file);

}  // namespace flaneur
