#include "pipeline/core/fingerprint.h"

#include <algorithm>
#include <cstdio>
#include <set>
#include <vector>

#include "runtime/base/file.h"

namespace flaneur {
namespace fs = std::filesystem;
namespace {

std::vector<fs::path> PythonFiles(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code ec;
  for (fs::recursive_directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec)) {
    if (it->path().extension() == ".py") files.push_back(it->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// %20 and its like as the character.
std::string Decoded(const std::string& uri) {
  std::string out;
  for (size_t i = 0; i < uri.size(); ++i) {
    unsigned code = 0;
    if (uri[i] == '%' && std::sscanf(uri.c_str() + i + 1, "%2x", &code) == 1) {
      out += static_cast<char>(code);
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

// The files beside a glTF file that its text names by "uri".
std::vector<fs::path> NamedFiles(const fs::path& gltf, const std::string& text) {
  constexpr std::string_view kKey = "\"uri\"";
  std::vector<fs::path> files;
  for (size_t at = text.find(kKey); at != std::string::npos; at = text.find(kKey, at)) {
    at += kKey.size();
    const size_t open = text.find_first_not_of(" \t\r\n:", at);
    if (open == std::string::npos || text[open] != '"') continue;
    const size_t close = text.find('"', open + 1);
    if (close == std::string::npos) break;
    const std::string uri = text.substr(open + 1, close - open - 1);
    if (uri.rfind("data:", 0) != 0) files.push_back(gltf.parent_path() / Decoded(uri));
  }
  return files;
}

}  // namespace

Fingerprint& Fingerprint::Add(std::string_view part) {
  const auto mix = [this](uint8_t byte) { state_ = (state_ ^ byte) * 1099511628211ull; };
  for (uint64_t size = part.size(), i = 0; i < 8; ++i) mix(static_cast<uint8_t>(size >> (8 * i)));
  for (char c : part) mix(static_cast<uint8_t>(c));
  return *this;
}

Fingerprint& Fingerprint::Add(double number) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", number);
  return Add(text);
}

Fingerprint& Fingerprint::AddFile(const fs::path& path) {
  std::error_code ec;
  if (fs::is_directory(path, ec)) {
    for (const fs::path& file : PythonFiles(path)) Add(file.filename().string()).AddFile(file);
    return *this;
  }
  std::string text;
  if (ReadTextFile(path, &text)) text.clear();
  Add(text);
  if (path.extension() != ".gltf" && path.extension() != ".glb") return *this;
  // What a model names is taken as bytes, whatever it is: models may name themselves, or each other, but name no files
  // in turn that count.
  std::set<fs::path> added;
  for (const fs::path& file : NamedFiles(path, text)) {
    if (!added.insert(file.lexically_normal()).second) continue;
    std::string bytes;
    if (ReadTextFile(file, &bytes)) bytes.clear();
    Add(bytes);
  }
  return *this;
}

std::string Fingerprint::Hex() const {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(state_));
  return text;
}

}  // namespace flaneur
