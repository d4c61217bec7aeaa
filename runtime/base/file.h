// Whole files in and out. Paths in messages are as given by the caller.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/base/file_bytes.h"

namespace flaneur {

// `extension` in small letters, as ".obj"; the file's may be in either.
bool HasExtension(const std::filesystem::path& path, std::string_view extension);

// Files of the disk alone: what devices and pipes give may never end. Errors: missing, a directory, a device, pipe or
// socket, unreadable, larger than kMostFile_bytes (runtime/base/limits.h); each names the path.
Error ReadFile(const std::filesystem::path& path, std::vector<uint8_t>* bytes);
Error ReadFile(const std::filesystem::path& path, FileBytes* bytes);
Error ReadTextFile(const std::filesystem::path& path, std::string* text);

// The same errors, without reading: for whoever hands the name on to another library.
Error CheckReadable(const std::filesystem::path& path);

// A file that has its name only when it is whole: the name stands for the old file or the new one, and nothing is left
// of what was not finished, even where the program is killed. (Where the file system knows no files without a name it
// is one beside the target.) A link's target is written, the link stays. Creates missing parent folders.
class UnfinishedFile {
 public:
  UnfinishedFile() = default;
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;
  ~UnfinishedFile();  // what has not been finished is thrown away
  // Errors: a folder, device, pipe or socket in the way, no permission.
  Error Start(const std::filesystem::path& path);
  int descriptor() const { return fd_; }  // to write to
  Error Finish();                         // Errors: disk full

 private:
  bool TakeName();

  std::filesystem::path target_, name_;  // name_: that it bears until it is finished; empty: none
  int fd_ = -1;
};

// The same at once. A terminal, character device or pipe is written into as it is, and stays. Errors: those of
// UnfinishedFile, a pipe from which nobody reads.
Error WriteFile(const std::filesystem::path& path, std::span<const uint8_t> bytes);
Error WriteFile(const std::filesystem::path& path, std::span<const std::span<const uint8_t>> parts);
Error WriteTextFile(const std::filesystem::path& path, std::string_view text);

// Whether WriteFile adds to what is there and stays: a terminal, device or pipe, or a process's open file.
bool IsStream(const std::filesystem::path& path);
// Of these the one that std::printf writes to: /dev/stdout. Whoever reads it wants nothing else there.
bool IsStandardOutput(const std::filesystem::path& path);

// What WriteFile would complain of by now, told before long work instead of after it: a folder in the way, no
// permission, a disk that is full already. Leaves nothing behind.
Error CheckWritable(const std::filesystem::path& path);
// The same for what is renamed into its place, which no device or pipe can bear.
Error CheckReplaceable(const std::filesystem::path& path);

}  // namespace flaneur
