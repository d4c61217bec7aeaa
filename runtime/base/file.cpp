#include "runtime/base/file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace flaneur {
namespace fs = std::filesystem;
namespace {

Error ReadInto(const fs::path& path, auto* out) {
  std::error_code ec;
  if (!fs::exists(path, ec)) return Fail(path.string() + ": no such file");
  if (fs::is_directory(path, ec)) return Fail(path.string() + ": is a folder, a file is needed");
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return Fail(path.string() + ": cannot be read: " + std::strerror(errno));
  out->clear();
  const auto size = fs::file_size(path, ec);
  if (!ec) out->reserve(size);
  char buffer[1 << 16];
  ssize_t count = 0;
  while ((count = ::read(fd, buffer, sizeof buffer)) > 0) out->insert(out->end(), buffer, buffer + count);
  const int read_errno = errno;
  ::close(fd);
  if (count < 0) return Fail(path.string() + ": cannot be read: " + std::strerror(read_errno));
  return Ok();
}

bool WriteAll(int fd, const uint8_t* data, size_t size) {
  while (size > 0) {
    const ssize_t count = ::write(fd, data, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    data += count;
    size -= static_cast<size_t>(count);
  }
  return ::fsync(fd) == 0 || errno == EINVAL;
}

}  // namespace

bool HasExtension(const fs::path& path, std::string_view extension) {
  const std::string own = path.extension().string();
  return std::equal(own.begin(), own.end(), extension.begin(), extension.end(),
                    [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

Error ReadFile(const fs::path& path, std::vector<uint8_t>* bytes) { return ReadInto(path, bytes); }
Error ReadTextFile(const fs::path& path, std::string* text) { return ReadInto(path, text); }

Error CheckWritable(const fs::path& path) {
  std::error_code ec;
  if (fs::is_directory(path, ec)) return Fail(path.string() + ": is a folder, a file is needed");
  fs::path folder = fs::absolute(path, ec).parent_path();
  while (!fs::exists(folder, ec) && folder.has_relative_path()) folder = folder.parent_path();
  std::string name = (folder / ".flaneur_XXXXXX").string();
  const int fd = ::mkostemp(name.data(), O_CLOEXEC);
  const bool written = fd >= 0 && ::write(fd, "x", 1) == 1;
  const int reason = errno;
  if (fd >= 0) {
    ::close(fd);
    ::unlink(name.c_str());
  }
  return written ? Ok() : Fail(path.string() + ": cannot be written: " + std::strerror(reason));
}

Error WriteFile(const fs::path& path, std::span<const uint8_t> bytes) {
  std::error_code ec;
  if (fs::is_directory(path, ec)) return Fail(path.string() + ": is a folder, a file is needed");
  if (path.has_parent_path()) fs::create_directories(path.parent_path(), ec);
  const std::string temporary = path.string() + ".part-" + std::to_string(::getpid());
  const int fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (fd < 0) return Fail(path.string() + ": cannot be written: " + std::strerror(errno));
  const bool written = WriteAll(fd, bytes.data(), bytes.size());
  const int write_errno = errno;
  const bool closed = ::close(fd) == 0;
  if (!written || !closed || ::rename(temporary.c_str(), path.c_str()) != 0) {
    const int reason = written ? errno : write_errno;
    ::unlink(temporary.c_str());
    return Fail(path.string() + ": cannot be written: " + std::strerror(reason));
  }
  return Ok();
}

Error WriteTextFile(const fs::path& path, std::string_view text) {
  return WriteFile(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

}  // namespace flaneur
