// What a Wavefront OBJ names beside itself: material libraries, and the pictures that these name. Its words and names
// are read like those of a PLY.
#pragma once
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/math.h"

namespace flaneur {

// Cuts the next word off, by blanks, tabs and the ends of lines; empty at the end.
std::string_view NextWord(std::string_view* text);
// Without blanks and the like at either end.
std::string_view Trimmed(std::string_view text);
// Whether the word is a number as a whole.
template <typename Number>
bool ReadNumber(std::string_view word, Number* value);
// Cuts off up to three finite numbers, as many as come next.
std::vector<float> TakeNumbers(std::string_view* text);

// A map of a material library: "-s 2 2 1 wall.jpg".
struct ObjPicture {
  std::string file;  // as it is written
  Vec2 scale{1, 1}, offset{};
};
ObjPicture ReadObjPicture(std::string_view text);

// Calls with every line's first word and the rest, blanks cut off.
template <typename Use>
void ForObjLines(std::string_view text, Use use);

// Of what follows "mtllib": one for each word where any of these is there, else one file, whose name may hold blanks.
std::vector<std::filesystem::path> ObjLibraries(const std::filesystem::path& obj, std::string_view named);

// The file that a name written on any system means: below the folder as it stands, else the bare name in the folder,
// as when a path of the artist's own disk was written.
std::filesystem::path BesideModel(const std::filesystem::path& folder, std::string written);

// All of them, of an OBJ with this text.
std::vector<std::filesystem::path> FilesOfObj(const std::filesystem::path& obj, std::string_view text);

// ---- Definitions ----

template <typename Number>
bool ReadNumber(std::string_view word, Number* value) {
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), *value);
  return problem == std::errc() && end == word.data() + word.size();
}

template <typename Use>
void ForObjLines(std::string_view text, Use use) {
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::string_view word = NextWord(&line);
    if (!word.empty()) use(word, Trimmed(line));
  }
}

}  // namespace flaneur
