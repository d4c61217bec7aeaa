// What steps have made, kept under keys that name all it was made from: a folder that tours, machines and users may
// share. Nothing in it is trusted unread: what is damaged counts as missing, goes, and is made again.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/base/error.h"

namespace flaneur {

struct Store {
  std::filesystem::path folder;
};

struct StoreEntry {
  std::string step;                   // what made it, such as "avatar:monk"
  std::string extension;              // of its file, such as ".glb"
  double seconds = 0, memory_mb = 0;  // what that took
  // Files that were read besides those in the key, by path, each with its SHA-256: where one has changed, the entry
  // does not count.
  std::vector<std::pair<std::string, std::string>> reads;
  // Filled in by PutEntry.
  uintmax_t bytes = 0;
  std::string sha256;
};

// Where the entry's content is, whether it is there or not.
std::filesystem::path EntryFile(const Store& store, const std::string& key, const std::string& extension);

// Whether there is an entry that counts, by its description alone.
bool FindEntry(const Store& store, const std::string& key, StoreEntry* entry);

// Reads it and compares its checksum. Whether it is whole; a damaged one is removed. `content` may be null.
bool ReadEntry(const Store& store, const std::string& key, StoreEntry* entry, std::string* content);

// The content is taken from `content`, or moved from `file` where that is not empty. Several processes may put and read
// the same at once: each sees nothing or all, and the first whole one stays. Errors: no permission, disk full.
Error PutEntry(const Store& store, const std::string& key, StoreEntry entry, std::string_view content,
               const std::filesystem::path& file = {});
void DropEntry(const Store& store, const std::string& key);

// What a step took last, in whatever version; false: nobody has done it here yet.
bool LastTaken(const Store& store, const std::string& step, double* seconds, double* memory_mb);

// The checksum of a program, which is read once and remembered by its path, size and age.
std::string ProgramSha256(const Store& store, const std::filesystem::path& program);

struct StoreListing {
  std::string key;
  StoreEntry entry;
  double unused_days = 0;  // since it was last of use
};
std::vector<StoreListing> ListStore(const Store& store);

// Reads all. Returns how many were damaged, which are removed.
size_t VerifyStore(const Store& store);

// Removes the entries that were of no use for longest, until all are at most so many bytes and days old. Returns how
// many. Whoever uses one at this moment makes it again.
size_t TrimStore(const Store& store, uintmax_t most_bytes, double most_days);

}  // namespace flaneur
