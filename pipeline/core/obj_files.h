// What a Wavefront OBJ names beside itself: material libraries, and the pictures that these name.
#pragma once
#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/math.h"

namespace flaneur {

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
std::filesystem::path BesideObj(const std::filesystem::path& folder, std::string written);

// All of them, of an OBJ with this text.
std::vector<std::filesystem::path> FilesOfObj(const std::filesystem::path& obj, std::string_view text);

// ---- Definitions ----

template <typename Use>
void ForObjLines(std::string_view text, Use use) {
  const auto blank = [](char c) { return static_cast<unsigned char>(c) <= ' '; };
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    while (!line.empty() && blank(line.front())) line.remove_prefix(1);
    while (!line.empty() && blank(line.back())) line.remove_suffix(1);
    size_t word = 0, rest = 0;
    while (word < line.size() && !blank(line[word])) ++word;
    for (rest = word; rest < line.size() && blank(line[rest]);) ++rest;
    if (word > 0) use(line.substr(0, word), line.substr(rest));
  }
}

}  // namespace flaneur
