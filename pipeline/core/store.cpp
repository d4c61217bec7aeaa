#include "pipeline/core/store.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "pipeline/core/fingerprint.h"
#include "pipeline/core/temporary_folder.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr size_t kPrefix = 2;  // of keys: names the subfolder, so that none holds too many files
constexpr const char* kDescription = ".json";

fs::path Beside(const Store& store, const std::string& key, const std::string& extension) {
  return store.folder / key.substr(0, kPrefix) / (key + extension);
}

// The description is checked by a checksum of its own, which it carries.
std::string TextOf(const StoreEntry& entry) {
  Json json{{"step", entry.step},           {"extension", entry.extension}, {"seconds", entry.seconds},
            {"memory_mb", entry.memory_mb}, {"bytes", entry.bytes},         {"sha256", entry.sha256}};
  json["reads"] = Json::array();
  for (const auto& [path, sha256] : entry.reads) json["reads"].push_back({path, sha256});
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  return Sha256(text) + "\n" + text + "\n";
}

bool FromText(const std::string& text, StoreEntry* entry) {
  const size_t line = text.find('\n');
  if (line == std::string::npos || text.back() != '\n') return false;
  const std::string body = text.substr(line + 1, text.size() - line - 2);
  if (text.substr(0, line) != Sha256(body)) return false;
  const Json json = Json::parse(body, nullptr, false);
  if (!json.is_object() || !json.contains("reads")) return false;
  entry->step = json.value("step", "");
  entry->extension = json.value("extension", "");
  entry->seconds = json.value("seconds", 0.0);
  entry->memory_mb = json.value("memory_mb", 0.0);
  entry->bytes = json.value("bytes", uintmax_t{0});
  entry->sha256 = json.value("sha256", "");
  entry->reads.clear();
  for (const Json& read : json["reads"])
    entry->reads.emplace_back(read[0].get<std::string>(), read[1].get<std::string>());
  return true;
}

bool ReadDescription(const Store& store, const std::string& key, StoreEntry* entry) {
  std::string text;
  return !ReadTextFile(Beside(store, key, kDescription), &text) && FromText(text, entry);
}

bool ReadsAreAsBefore(const StoreEntry& entry) {
  return std::all_of(entry.reads.begin(), entry.reads.end(), [](const auto& read) {
    std::string now;
    return !Sha256OfFile(read.first, &now) && now == read.second;
  });
}

std::string Named(const std::string& step) { return Sha256(step).substr(0, 16); }

void Touch(const fs::path& path) { ::utimensat(AT_FDCWD, path.c_str(), nullptr, 0); }

double DaysSince(const fs::path& path) {
  struct stat is {};
  if (::stat(path.c_str(), &is) != 0) return 0;
  const auto now = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  return std::max(0.0, (now - static_cast<double>(is.st_mtim.tv_sec)) / 86400);
}

Error Move(const fs::path& from, const fs::path& to) {
  std::error_code ec;
  fs::rename(from, to, ec);
  return ec ? Fail(to.string() + ": cannot be written: " + ec.message()) : Ok();
}

// Written elsewhere and moved there, so that a kill leaves nothing that the next sweep does not find.
Error Place(const Store& store, const fs::path& path, const std::string& text) {
  std::error_code ec;
  fs::create_directories(path.parent_path(), ec);
  TemporaryFolder folder;
  if (Error e = folder.Create(".flaneur_note_", store.folder)) return e;
  if (Error e = WriteTextFile(folder.path() / "text", text)) return e;
  return Move(folder.path() / "text", path);
}

// Content and description change together for all who hold it. Where a file system knows no locks, it holds nothing:
// then two who write one entry at the same moment may both have to make it again.
class StoreLock {
 public:
  explicit StoreLock(const Store& store)
      : descriptor_(::open((store.folder / "lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
    if (descriptor_ >= 0) ::flock(descriptor_, LOCK_EX);
  }
  StoreLock(const StoreLock&) = delete;
  StoreLock& operator=(const StoreLock&) = delete;
  ~StoreLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

 private:
  int descriptor_;
};

bool ReadWhole(const Store& store, const std::string& key, StoreEntry* entry, std::string* content) {
  return FindEntry(store, key, entry) && !ReadTextFile(Beside(store, key, entry->extension), content) &&
         Sha256(*content) == entry->sha256;
}

void Remove(const Store& store, const std::string& key) {
  StoreEntry entry;
  std::error_code ec;
  const bool known = ReadDescription(store, key, &entry);
  fs::remove(Beside(store, key, kDescription), ec);
  if (known) fs::remove(Beside(store, key, entry.extension), ec);
}

// Contents whose description is not there: of who was killed between the two.
void RemoveOrphans(const Store& store) {
  constexpr double kOld_days = 1.0 / 24;  // others may be between the two now
  std::error_code ec;
  std::vector<fs::path> orphans;
  for (fs::recursive_directory_iterator it(store.folder, ec), end; !ec && it != end; it.increment(ec)) {
    const fs::path path = it->path();
    const bool content =
        it.depth() == 1 && path.parent_path().filename().string().size() == kPrefix && path.extension() != kDescription;
    if (content && DaysSince(path) > kOld_days && !fs::exists(fs::path(path).replace_extension(kDescription), ec))
      orphans.push_back(path);
  }
  for (const fs::path& path : orphans) fs::remove(path, ec);
}

}  // namespace

fs::path EntryFile(const Store& store, const std::string& key, const std::string& extension) {
  return Beside(store, key, extension);
}

bool FindEntry(const Store& store, const std::string& key, StoreEntry* entry) {
  StoreEntry found;
  std::error_code ec;
  if (!ReadDescription(store, key, &found) || !ReadsAreAsBefore(found)) return false;
  if (fs::file_size(Beside(store, key, found.extension), ec) != found.bytes || ec) return false;
  *entry = std::move(found);
  return true;
}

bool ReadEntry(const Store& store, const std::string& key, StoreEntry* entry, std::string* content) {
  StoreEntry found;
  std::string text;
  if (!FindEntry(store, key, &found)) return false;
  if (!ReadWhole(store, key, &found, &text)) {
    const StoreLock lock(store);  // perhaps somebody was just writing it
    if (!ReadWhole(store, key, &found, &text)) return Remove(store, key), false;
  }
  Touch(Beside(store, key, kDescription));
  *entry = std::move(found);
  if (content) *content = std::move(text);
  return true;
}

Error PutEntry(const Store& store, const std::string& key, StoreEntry entry, std::string_view content,
               const fs::path& file) {
  std::error_code ec;
  const fs::path final = Beside(store, key, entry.extension);
  fs::create_directories(final.parent_path(), ec);
  if (ec) return Fail(final.parent_path().string() + ": cannot make this folder: " + ec.message());
  TemporaryFolder folder;
  if (Error e = folder.Create(".flaneur_entry_", store.folder)) return e;
  fs::path made = file;
  if (file.empty()) {
    made = folder.path() / "content";
    entry.sha256 = Sha256(content);
    entry.bytes = content.size();
    if (Error e = WriteTextFile(made, content)) return e;
  } else {
    if (Error e = Sha256OfFile(file, &entry.sha256)) return e;
    entry.bytes = fs::file_size(file, ec);
  }
  const fs::path description = folder.path() / "description";
  if (Error e = WriteTextFile(description, TextOf(entry))) return e;
  {
    const StoreLock lock(store);
    StoreEntry there;
    std::string text;
    if (!ReadWhole(store, key, &there, &text)) {  // else somebody was quicker, and others may read it already
      if (Error e = Move(made, final)) return e;
      if (Error e = Move(description, Beside(store, key, kDescription))) return e;
    }
  }
  const Json taken{{"step", entry.step}, {"seconds", entry.seconds}, {"memory_mb", entry.memory_mb}};
  return Place(store, store.folder / "taken" / (Named(entry.step) + kDescription),
               taken.dump(-1, ' ', false, Json::error_handler_t::replace));
}

void DropEntry(const Store& store, const std::string& key) {
  const StoreLock lock(store);
  Remove(store, key);
}

bool LastTaken(const Store& store, const std::string& step, double* seconds, double* memory_mb) {
  std::string text;
  if (ReadTextFile(store.folder / "taken" / (Named(step) + kDescription), &text)) return false;
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("seconds") || !json["seconds"].is_number()) return false;
  *seconds = json["seconds"];
  *memory_mb = json.value("memory_mb", 0.0);
  return true;
}

std::string ProgramSha256(const Store& store, const fs::path& program) {
  struct stat is {};
  std::error_code ec;
  const fs::path real = fs::canonical(program, ec);
  if (ec || ::stat(real.c_str(), &is) != 0) return "";
  const std::string identity = real.string() + "\n" + std::to_string(is.st_size) + "\n" + std::to_string(is.st_ino) +
                               "\n" + std::to_string(is.st_mtim.tv_sec) + "." + std::to_string(is.st_mtim.tv_nsec) +
                               "\n" + std::to_string(is.st_ctim.tv_sec) + "." + std::to_string(is.st_ctim.tv_nsec);
  const fs::path remembered = store.folder / "programs" / Sha256(identity).substr(0, 16);
  std::string hex;
  if (!ReadTextFile(remembered, &hex) && hex.size() == Sha256("").size()) return hex;
  if (Sha256OfFile(real, &hex)) return "";
  const Error not_remembered = Place(store, remembered, hex);  // then it is read again next time
  return hex;
}

std::vector<StoreListing> ListStore(const Store& store) {
  std::vector<StoreListing> all;
  std::error_code ec;
  for (fs::recursive_directory_iterator it(store.folder, ec), end; !ec && it != end; it.increment(ec)) {
    const std::string name = it->path().filename().string();
    if (it.depth() == 0 && (name.size() != kPrefix || !it->is_directory(ec))) {
      it.disable_recursion_pending();
      continue;
    }
    StoreListing listing;
    listing.key = it->path().stem().string();
    if (it.depth() != 1 || it->path().extension() != kDescription) continue;
    if (!ReadDescription(store, listing.key, &listing.entry)) listing.entry.step = "damaged";
    listing.unused_days = DaysSince(it->path());
    all.push_back(std::move(listing));
  }
  std::sort(all.begin(), all.end(), [](const StoreListing& a, const StoreListing& b) {
    return a.entry.step != b.entry.step ? a.entry.step < b.entry.step : a.key < b.key;
  });
  return all;
}

size_t VerifyStore(const Store& store) {
  size_t damaged = 0;
  for (const StoreListing& listing : ListStore(store)) {
    StoreEntry entry;
    std::string text;
    const StoreLock lock(store);
    if (ReadDescription(store, listing.key, &entry) &&
        !ReadTextFile(Beside(store, listing.key, entry.extension), &text) && Sha256(text) == entry.sha256)
      continue;
    Remove(store, listing.key);
    ++damaged;
  }
  return damaged;
}

size_t TrimStore(const Store& store, uintmax_t most_bytes, double most_days) {
  SweepLeftovers(store.folder);
  RemoveOrphans(store);
  std::vector<StoreListing> all = ListStore(store);
  std::sort(all.begin(), all.end(),
            [](const StoreListing& a, const StoreListing& b) { return a.unused_days < b.unused_days; });
  uintmax_t kept = 0;
  size_t removed = 0;
  for (const StoreListing& listing : all) {
    if (listing.unused_days <= most_days && kept + listing.entry.bytes <= most_bytes) {
      kept += listing.entry.bytes;
      continue;
    }
    DropEntry(store, listing.key);
    ++removed;
  }
  return removed;
}

}  // namespace flaneur
