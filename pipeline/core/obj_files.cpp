#include "pipeline/core/obj_files.h"

#include <algorithm>
#include <charconv>

#include "runtime/base/file.h"

namespace flaneur {
namespace fs = std::filesystem;
namespace {

std::string_view NextWord(std::string_view* text) {
  const auto blank = [](char c) { return static_cast<unsigned char>(c) <= ' '; };
  while (!text->empty() && blank(text->front())) text->remove_prefix(1);
  size_t end = 0;
  while (end < text->size() && !blank((*text)[end])) ++end;
  const std::string_view word = text->substr(0, end);
  text->remove_prefix(end);
  return word;
}

bool IsNumber(std::string_view word, float* value) {
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), *value);
  return problem == std::errc() && end == word.data() + word.size();
}

bool IsThere(const fs::path& path) {
  std::error_code ec;
  return fs::is_regular_file(path, ec);
}

// Up to three numbers, the first two of which are taken.
void TakeNumbers(std::string_view* text, Vec2* out) {
  for (int i = 0; i < 3; ++i) {
    std::string_view rest = *text;
    float value = 0;
    if (!IsNumber(NextWord(&rest), &value)) return;
    if (i < 2) (i == 0 ? out->x : out->y) = value;
    *text = rest;
  }
}

}  // namespace

ObjPicture ReadObjPicture(std::string_view text) {
  ObjPicture picture;
  Vec2 unused;
  while (true) {
    std::string_view rest = text;
    const std::string_view word = NextWord(&rest);
    if (word == "-s" || word == "-o" || word == "-t") {
      TakeNumbers(&rest, word == "-s" ? &picture.scale : word == "-o" ? &picture.offset : &unused);
    } else if (word == "-mm") {
      NextWord(&rest), NextWord(&rest);
    } else if (word == "-blendu" || word == "-blendv" || word == "-boost" || word == "-texres" || word == "-clamp" ||
               word == "-bm" || word == "-imfchan" || word == "-type" || word == "-cc") {
      NextWord(&rest);
    } else {
      break;
    }
    text = rest;
  }
  const size_t first = text.find_first_not_of(" \t");
  if (first != std::string_view::npos) picture.file = text.substr(first);
  return picture;
}

fs::path BesideObj(const fs::path& folder, std::string written) {
  std::replace(written.begin(), written.end(), '\\', '/');
  if (written.size() > 1 && written.front() == '"' && written.back() == '"')
    written = written.substr(1, written.size() - 2);
  const fs::path path(written);
  const bool below =
      path.is_relative() && (path.empty() || *path.begin() != "..") && written.find(':') == std::string::npos;
  if (below && IsThere(folder / path)) return folder / path;
  return folder / path.filename();
}

std::vector<fs::path> ObjLibraries(const fs::path& obj, std::string_view named) {
  const fs::path whole = BesideObj(obj.parent_path(), std::string(named));
  if (IsThere(whole)) return {whole};
  std::vector<fs::path> libraries;
  bool any = false;
  for (std::string_view word = NextWord(&named); !word.empty(); word = NextWord(&named)) {
    libraries.push_back(BesideObj(obj.parent_path(), std::string(word)));
    any = any || IsThere(libraries.back());
  }
  return any ? libraries : std::vector<fs::path>{whole};
}

std::vector<fs::path> FilesOfObj(const fs::path& obj, std::string_view text) {
  std::vector<fs::path> files;
  ForObjLines(text, [&](std::string_view key, std::string_view rest) {
    if (key != "mtllib") return;
    for (const fs::path& library : ObjLibraries(obj, rest)) {
      files.push_back(library);
      std::string material_text;
      if (ReadTextFile(library, &material_text)) continue;
      ForObjLines(material_text, [&](std::string_view map, std::string_view picture) {
        if (map == "map_Kd" || map == "map_d")
          files.push_back(BesideObj(library.parent_path(), ReadObjPicture(picture).file));
      });
    }
  });
  return files;
}

}  // namespace flaneur
