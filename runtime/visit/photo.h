// A visitor's photo: what they see, with the museum's line under it, kept as a file, and the code that leads to it.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/text/fonts.h"

namespace flaneur {

struct Photo {
  int width_px = 0, height_px = 0;
  std::vector<uint8_t> rgb;  // top row first
};

// With a strip below that says `line`; none where that is empty.
Photo WithLine(Photo photo, const std::string& line, const std::string& language, Fonts* fonts);

// Letters and digits that nobody guesses, and that say nothing of anybody.
std::string NewPhotoId();
std::string PhotoFileName(const std::string& id);
// The link, with {file} and {id} filled in.
std::string PhotoLink(std::string pattern, const std::string& id);

// Into the folder, as JPEG. Of more photos than `most` there the eldest are deleted. Errors: those of WriteFile.
Error KeepPhoto(const Photo& photo, const std::filesystem::path& folder, const std::string& id, size_t most);

// A square of black and white pixels, RGBA, with its quiet border.
struct QrPicture {
  int side_px = 0;
  std::vector<uint8_t> rgba;
};
// Nothing where the text is too long for a QR code.
std::optional<QrPicture> QrOf(const std::string& text);

}  // namespace flaneur
