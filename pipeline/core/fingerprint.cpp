#include "pipeline/core/fingerprint.h"

#include <openssl/evp.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <map>
#include <mutex>
#include <set>
#include <tuple>
#include <vector>

#include "pipeline/core/obj_files.h"
#include "pipeline/core/ply_header.h"
#include "pipeline/core/uri.h"
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
    if (uri.rfind("data:", 0) != 0) files.push_back(gltf.parent_path() / DecodedUri(uri));
  }
  return files;
}

// The pictures that CityGML's appearances name.
std::vector<fs::path> NamedPictures(const fs::path& model, const std::string& text) {
  constexpr std::string_view kElement = "imageURI>";
  std::vector<fs::path> files;
  for (size_t at = text.find(kElement); at != std::string::npos; at = text.find(kElement, at)) {
    at += kElement.size();
    const size_t end = text.find('<', at);
    if (end == std::string::npos) break;
    if (end > at) files.push_back(model.parent_path() / text.substr(at, end - at));
  }
  return files;
}

// The pictures that a PLY's comments name.
std::vector<fs::path> PicturesOfPly(const fs::path& ply, const std::string& text) {
  PlyHeader header;
  std::vector<fs::path> files;
  if (ReadPlyHeader(text, &header)) return files;
  for (const std::string& name : header.pictures) files.push_back(BesideModel(ply.parent_path(), name));
  return files;
}

bool IsGltf(const fs::path& path) { return HasExtension(path, ".gltf") || HasExtension(path, ".glb"); }

std::vector<fs::path> FilesOfModel(const fs::path& path, const std::string& text) {
  if (IsGltf(path)) return NamedFiles(path, text);
  if (HasExtension(path, ".obj")) return FilesOfObj(path, text);
  if (HasExtension(path, ".ply")) return PicturesOfPly(path, text);
  if (HasExtension(path, ".gml") || HasExtension(path, ".xml") || HasExtension(path, ".citygml"))
    return NamedPictures(path, text);
  return {};
}

struct Digest {
  Digest() : context(EVP_MD_CTX_new()) { EVP_DigestInit_ex(context, EVP_sha256(), nullptr); }
  Digest(const Digest&) = delete;
  Digest& operator=(const Digest&) = delete;
  ~Digest() { EVP_MD_CTX_free(context); }

  void Add(const void* data, size_t size) { EVP_DigestUpdate(context, data, size); }
  std::string Hex() {
    unsigned char bytes[EVP_MAX_MD_SIZE];
    unsigned size = 0;
    EVP_DigestFinal_ex(context, bytes, &size);
    constexpr const char* kDigits = "0123456789abcdef";
    std::string hex;
    for (unsigned i = 0; i < size; ++i) hex.append({kDigits[bytes[i] >> 4], kDigits[bytes[i] & 15]});
    return hex;
  }

  EVP_MD_CTX* context;
};

struct Content {
  std::string sha256;           // of nothing where it cannot be read
  std::vector<fs::path> named;  // by a model
};

// By what changes whenever a file does.
using Version = std::tuple<dev_t, ino_t, off_t, time_t, long, time_t, long>;

bool VersionOf(const fs::path& path, Version* version, time_t* changed_s) {
  struct stat is {};
  if (::stat(path.c_str(), &is) != 0) return false;
  *version = {is.st_dev,          is.st_ino,         is.st_size,        is.st_mtim.tv_sec,
              is.st_mtim.tv_nsec, is.st_ctim.tv_sec, is.st_ctim.tv_nsec};
  *changed_s = is.st_ctim.tv_sec;
  return true;
}

// Read once while it stays as it is: a tour of hundreds asks for the same files again and again. What was changed a
// moment ago might be changed once more within the same tick of the file system's clock, and is not kept.
Content ContentOf(const fs::path& path) {
  constexpr time_t kSettled_s = 2;
  static std::mutex mutex;
  static std::map<fs::path, std::pair<Version, Content>> known;
  Version before{}, after{};
  time_t changed_s = 0;
  const bool there = VersionOf(path, &before, &changed_s);
  {
    const std::lock_guard lock(mutex);
    const auto found = known.find(path);
    if (there && found != known.end() && found->second.first == before) return found->second.second;
  }
  Content content;
  std::string text;
  if (ReadTextFile(path, &text)) text.clear();
  content.sha256 = Sha256(text);
  content.named = FilesOfModel(path, text);
  const bool settled = VersionOf(path, &after, &changed_s) && std::time(nullptr) - changed_s > kSettled_s;
  if (there && settled && before == after) {
    const std::lock_guard lock(mutex);
    known[path] = {before, content};
  }
  return content;
}

}  // namespace

struct Fingerprint::State : Digest {};

Fingerprint::Fingerprint() : state_(std::make_unique<State>()) {}
Fingerprint::~Fingerprint() = default;
Fingerprint::Fingerprint(Fingerprint&&) noexcept = default;
Fingerprint& Fingerprint::operator=(Fingerprint&&) noexcept = default;

Fingerprint& Fingerprint::Add(std::string_view part) {
  const uint64_t size = part.size();
  state_->Add(&size, sizeof size);
  state_->Add(part.data(), part.size());
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
  const Content content = ContentOf(path);
  Add(content.sha256);
  // What a model names is taken as bytes, whatever it is: models may name themselves, or each other, but name no files
  // in turn that count.
  std::set<fs::path> added;
  for (const fs::path& file : content.named) {
    if (added.insert(file.lexically_normal()).second) Add(ContentOf(file).sha256);
  }
  return *this;
}

std::string Fingerprint::Hex() { return state_->Hex(); }

std::string Sha256(std::string_view bytes) {
  Digest digest;
  digest.Add(bytes.data(), bytes.size());
  return digest.Hex();
}

Error Sha256OfFile(const fs::path& path, std::string* hex) {
  std::string bytes;
  if (Error e = ReadTextFile(path, &bytes)) return e;
  *hex = Sha256(bytes);
  return Ok();
}

}  // namespace flaneur
