#include "pipeline/core/obj_files.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/file.h"

namespace flaneur {
namespace fs = std::filesystem;
namespace {

bool IsThere(const fs::path& path) {
  std::error_code ec;
  return fs::is_regular_file(path, ec);
}

}  // namespace

std::string_view NextWord(std::string_view* text) {
  const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text->empty() && is_space(text->front())) text->remove_prefix(1);
  size_t end = 0;
  while (end < text->size() && !is_space((*text)[end])) ++end;
  const std::string_view word = text->substr(0, end);
  text->remove_prefix(end);
  return word;
}

std::string_view Trimmed(std::string_view text) {
  while (!text.empty() && static_cast<unsigned char>(text.front()) <= ' ') text.remove_prefix(1);
  while (!text.empty() && static_cast<unsigned char>(text.back()) <= ' ') text.remove_suffix(1);
  return text;
}

std::vector<float> TakeNumbers(std::string_view* text) {
  std::vector<float> numbers;
  while (numbers.size() < 3) {
    std::string_view rest = *text;
    const std::string_view word = NextWord(&rest);
    float value = 0;
    if (!ReadNumber(word, &value) || !std::isfinite(value)) break;
    numbers.push_back(value);
    *text = rest;
  }
  return numbers;
}

ObjPicture ReadObjPicture(std::string_view text) {
  ObjPicture picture;
  while (true) {
    std::string_view rest = text;
    const std::string_view word = NextWord(&rest);
    if (word == "-s" || word == "-o" || word == "-t") {
      const std::vector<float> numbers = TakeNumbers(&rest);
      Vec2* told = word == "-s" ? &picture.scale : word == "-o" ? &picture.offset : nullptr;
      if (told && !numbers.empty()) told->x = numbers[0];
      if (told && numbers.size() > 1) told->y = numbers[1];
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
  picture.file = Trimmed(text);
  return picture;
}

fs::path BesideModel(const fs::path& folder, std::string written) {
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
  const fs::path whole = BesideModel(obj.parent_path(), std::string(named));
  if (IsThere(whole)) return {whole};
  std::vector<fs::path> libraries;
  bool any = false;
  for (std::string_view word = NextWord(&named); !word.empty(); word = NextWord(&named)) {
    libraries.push_back(BesideModel(obj.parent_path(), std::string(word)));
    any = any || IsThere(libraries.back());
  }
  return any ? libraries : std::vector<fs::path>{whole};
}

std::vector<fs::path> FilesOfObj(const fs::path& obj, std::string_view text) {
  std::vector<fs::path> files;
  constexpr std::string_view kKey = "mtllib";  // looked for alone: nothing else in many megabytes matters
  for (size_t at = text.find(kKey); at != std::string_view::npos; at = text.find(kKey, at)) {
    const size_t line = text.substr(0, at).rfind('\n') + 1;  // 0 where there is none before
    at += kKey.size();
    std::string_view rest = text.substr(line, text.find('\n', line) - line);
    if (NextWord(&rest) != kKey) continue;
    for (const fs::path& library : ObjLibraries(obj, Trimmed(rest))) {
      files.push_back(library);
      std::string material_text;
      if (ReadTextFile(library, &material_text)) continue;
      ForObjLines(material_text, [&](std::string_view map, std::string_view picture) {
        if (map == "map_Kd" || map == "map_d")
          files.push_back(BesideModel(library.parent_path(), ReadObjPicture(picture).file));
      });
    }
  }
  return files;
}

}  // namespace flaneur
