// Films.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/base/file.h"

namespace flaneur {

// Pipes pictures into ffmpeg. The film appears under its name only when it is whole.
class FilmWriter {
 public:
  FilmWriter() = default;
  FilmWriter(const FilmWriter&) = delete;
  FilmWriter& operator=(const FilmWriter&) = delete;
  ~FilmWriter();  // an unfinished film is thrown away
  // Width and height must be even. Errors: ffmpeg is not there, sizes.
  Error Start(const std::filesystem::path& path, int width_px, int height_px, float frames_per_s);
  Error Add(const std::vector<uint8_t>& rgb);
  Error Finish();

 private:
  Error Failed() const;  // with what ffmpeg says about it

  std::filesystem::path path_;
  UnfinishedFile file_;
  int pipe_ = -1;
  int process_ = -1;
  int complaints_ = -1;  // a file in memory
};

}  // namespace flaneur
