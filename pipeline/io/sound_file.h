// Spoken audio for the stops of a guided tour.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "runtime/base/error.h"

namespace flaneur {

struct SoundFile {
  std::vector<uint8_t> bytes;  // as in the file
  float duration_s = 0;
};

// WAV, FLAC, Ogg Vorbis or Opus, MP3. The sound is decoded to its end.
// Errors: unreadable, none of these, broken, silent for want of samples, longer than an hour.
Error ReadSoundFile(const std::filesystem::path& path, SoundFile* sound);

// What makes a sound as loud as `loudness_lufs` by EBU R 128, or less where its peaks would pass `most_peak_dbtp`
// (true peaks, ITU-R BS.1770); 0 for silence and what is shorter than 0.4 s. Errors: as of ReadSoundFile.
Error GainToLoudness_db(const std::filesystem::path& path, double loudness_lufs, double most_peak_dbtp,
                        double* gain_db);

// Writes a sound so much louder as Ogg Opus, for speech, mono or stereo. The same sound gives the same bytes. Errors:
// as of ReadSoundFile, or the file cannot be written.
Error EncodeSpeech(const std::filesystem::path& from, double gain_db, const std::filesystem::path& to);

// Of the library that reads them.
std::string SoundReaderVersion();

}  // namespace flaneur
