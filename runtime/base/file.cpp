#include "runtime/base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include "runtime/base/limits.h"

namespace flaneur {
namespace fs = std::filesystem;
namespace {

Error CannotBeWritten(const fs::path& path, int reason) {
  return Fail(path.string() + ": cannot be written: " + std::strerror(reason));
}

// Without a descriptor: opening a device may do something already.
Error CheckKind(const fs::path& path, const struct stat& is) {
  if (S_ISDIR(is.st_mode)) return Fail(path.string() + ": is a folder, a file is needed");
  if (!S_ISREG(is.st_mode))
    return Fail(path.string() + ": is a device, pipe or socket; copy what it gives into a file and name that");
  if (static_cast<uint64_t>(is.st_size) > kMostFile_bytes) return Fail(path.string() + ": is larger than 4 GiB");
  return Ok();
}

// More of a file that grows meanwhile is left.
Error ReadAll(int fd, const fs::path& path, FileBytes* out) {
  size_t at = 0;
  while (at < out->size()) {
    const ssize_t count = ::read(fd, out->data() + at, out->size() - at);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return Fail(path.string() + ": cannot be read: " + std::strerror(errno));
    if (count == 0) break;
    at += static_cast<size_t>(count);
  }
  out->Shorten(at);
  return Ok();
}

Error ReadAll(int fd, const fs::path& path, auto* out) {
  char buffer[1 << 16];
  while (true) {
    const ssize_t count = ::read(fd, buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return Fail(path.string() + ": cannot be read: " + std::strerror(errno));
    if (count == 0) return Ok();
    if (out->size() + static_cast<size_t>(count) > kMostFile_bytes)
      return Fail(path.string() + ": is larger than 4 GiB");
    out->insert(out->end(), buffer, buffer + count);
  }
}

void MakeRoom(size_t count, FileBytes* out) { *out = FileBytes::Room(count); }
void MakeRoom(size_t count, auto* out) { out->reserve(count); }

Error ReadInto(const fs::path& path, auto* out) {
  if (Error e = CheckReadable(path)) return e;
  // A pipe that has taken the file's place meanwhile would wait for somebody to write.
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) return Fail(path.string() + ": cannot be read: " + std::strerror(errno));
  struct stat is {};
  Error error = ::fstat(fd, &is) == 0 ? CheckKind(path, is) : Fail(path.string() + ": cannot be read");
  *out = {};
  if (!error) {
    MakeRoom(static_cast<size_t>(is.st_size), out);
    error = ReadAll(fd, path, out);
  }
  ::close(fd);
  return error;
}

bool WriteAll(int fd, const uint8_t* data, size_t size) {
  while (size > 0) {
    const ssize_t count = ::write(fd, data, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    data += count;
    size -= static_cast<size_t>(count);
  }
  return true;
}

// Where what is written goes.
struct Target {
  fs::path path;          // behind links
  bool as_it_is = false;  // a terminal, device or pipe: nothing takes its place
};

// Of a process's open file, as /dev/stdout is behind its links, the name in /proc; empty: none.
[[gnu::cold]] std::string OpenFileOf(std::string path) {
  constexpr int kMostLinks = 40;  // as the system's own
  for (int i = 0; i < kMostLinks; ++i) {
    const size_t name = path.rfind('/') + 1;
    char folder[PATH_MAX], link[PATH_MAX];
    const ssize_t size = ::readlink(path.c_str(), link, sizeof link);
    if (size <= 0 || !::realpath(name == 0 ? "." : path.substr(0, name).c_str(), folder)) break;
    const std::string beside = std::string(folder) + "/";
    if (beside.rfind("/proc/", 0) == 0) return beside + path.substr(name);
    path.assign(link, static_cast<size_t>(size));
    if (link[0] != '/') path.insert(0, beside);
  }
  return {};
}

// The number of that file where it is this process's own; -1: it is not.
int OwnDescriptorOf(const fs::path& path) {
  const std::string open_file = OpenFileOf(path), own = "/proc/" + std::to_string(::getpid()) + "/fd/";
  return open_file.rfind(own, 0) == 0 ? std::atoi(open_file.c_str() + own.size()) : -1;
}

Error FindTarget(const fs::path& path, Target* target) {
  target->path = path;
  struct stat is {};
  if (::stat(path.c_str(), &is) != 0) return Ok();
  if (S_ISDIR(is.st_mode)) return Fail(path.string() + ": is a folder, a file is needed");
  if (S_ISBLK(is.st_mode) || S_ISSOCK(is.st_mode))
    return Fail(path.string() + ": is a device or socket; name a file to write");
  std::error_code ec;
  target->as_it_is = !S_ISREG(is.st_mode) || !OpenFileOf(path).empty();
  if (target->as_it_is) return Ok();
  if (const fs::path real = fs::canonical(path, ec); !ec && fs::is_symlink(path, ec)) target->path = real;
  return Ok();
}

// A reader who goes away is an error like any other, not the end of the program.
class NoSignalOfPipes {
 public:
  NoSignalOfPipes() : before_(::signal(SIGPIPE, SIG_IGN)) {}
  NoSignalOfPipes(const NoSignalOfPipes&) = delete;
  NoSignalOfPipes& operator=(const NoSignalOfPipes&) = delete;
  ~NoSignalOfPipes() { ::signal(SIGPIPE, before_); }

 private:
  void (*before_)(int);
};

// One of our own stays where it has come to: what is printed after it neither overwrites it nor is overwritten.
// A pipe is opened without waiting for a reader who may never come.
[[gnu::cold]] int OpenAsItIs(const fs::path& path) {
  if (const int own = OwnDescriptorOf(path); own >= 0) return ::fcntl(own, F_DUPFD_CLOEXEC, 0);
  const int fd = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
  if (fd >= 0) ::fcntl(fd, F_SETFL, O_APPEND);
  return fd;
}

using Parts = std::span<const std::span<const uint8_t>>;

bool WriteAll(int fd, Parts parts) {
  return std::all_of(parts.begin(), parts.end(),
                     [fd](std::span<const uint8_t> part) { return WriteAll(fd, part.data(), part.size()); });
}

Error WriteAsItIs(const fs::path& path, Parts parts) {
  const NoSignalOfPipes quiet;
  const int fd = OpenAsItIs(path);
  if (fd < 0 && errno == ENXIO) return Fail(path.string() + ": cannot be written: nobody reads from this pipe");
  if (fd < 0) return CannotBeWritten(path, errno);
  const bool written = WriteAll(fd, parts);
  const int reason = errno;
  ::close(fd);
  return written ? Ok() : CannotBeWritten(path, reason);
}

// A name beside the target that nobody has, tried by `make`, which tells as system calls do.
bool UnderNewName(const fs::path& target, fs::path* name, auto make) {
  constexpr int kTries = 1000;
  for (int i = 0; i < kTries; ++i) {
    *name = target.string() + ".part-" + std::to_string(::getpid()) + "-" + std::to_string(i);
    if (make(name->c_str()) == 0) return true;
    if (errno != EEXIST) return false;
  }
  return false;
}

fs::path FolderOf(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

// So that the name outlives a power cut too.
void SyncFolder(const fs::path& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  ::fsync(fd);
  ::close(fd);
}

}  // namespace

bool HasExtension(const fs::path& path, std::string_view extension) {
  const std::string own = path.extension().string();
  return std::equal(own.begin(), own.end(), extension.begin(), extension.end(),
                    [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

Error CheckReadable(const fs::path& path) {
  struct stat is {};
  if (::stat(path.c_str(), &is) == 0) return CheckKind(path, is);
  if (errno == ENOENT || errno == ENOTDIR) return Fail(path.string() + ": no such file");
  return Fail(path.string() + ": cannot be read: " + std::strerror(errno));
}

Error ReadFile(const fs::path& path, std::vector<uint8_t>* bytes) { return ReadInto(path, bytes); }
Error ReadFile(const fs::path& path, FileBytes* bytes) { return ReadInto(path, bytes); }
Error ReadTextFile(const fs::path& path, std::string* text) { return ReadInto(path, text); }

bool IsStream(const fs::path& path) {
  Target target;
  return !FindTarget(path, &target) && target.as_it_is;
}

bool IsStandardOutput(const fs::path& path) { return OwnDescriptorOf(path) == STDOUT_FILENO; }

Error CheckWritable(const fs::path& path) {
  Target target;
  if (Error e = FindTarget(path, &target)) return e;
  if (target.as_it_is) return ::access(path.c_str(), W_OK) == 0 ? Ok() : CannotBeWritten(path, errno);
  std::error_code ec;
  fs::path folder = fs::absolute(target.path, ec).parent_path();
  while (!fs::exists(folder, ec) && folder.has_relative_path()) folder = folder.parent_path();
  std::string name = (folder / ".flaneur_XXXXXX").string();
  const int fd = ::mkostemp(name.data(), O_CLOEXEC);
  const bool written = fd >= 0 && ::write(fd, "x", 1) == 1;
  const int reason = errno;
  if (fd >= 0) {
    ::close(fd);
    ::unlink(name.c_str());
  }
  return written ? Ok() : CannotBeWritten(path, reason);
}

Error CheckReplaceable(const fs::path& path) {
  struct stat is {};
  if (::stat(path.c_str(), &is) == 0 && !S_ISREG(is.st_mode) && !S_ISDIR(is.st_mode))
    return Fail(path.string() + ": is a device, pipe or socket; name a file to write");
  return CheckWritable(path);
}

UnfinishedFile::~UnfinishedFile() {
  if (fd_ >= 0) ::close(fd_);
  if (!name_.empty()) ::unlink(name_.c_str());
}

Error UnfinishedFile::Start(const fs::path& path) {
  Target target;
  if (Error e = FindTarget(path, &target)) return e;
  if (target.as_it_is) return Fail(path.string() + ": is a device, pipe or socket; name a file to write");
  target_ = target.path;
  std::error_code ec;
  if (target_.has_parent_path()) fs::create_directories(target_.parent_path(), ec);
#ifdef O_TMPFILE
  fd_ = ::open(FolderOf(target_).c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
  if (fd_ >= 0 && ::access("/proc/self/fd", X_OK) == 0) return Ok();
  if (fd_ >= 0) ::close(fd_);
#endif
  const bool opened = UnderNewName(target_, &name_, [&](const char* name) {
    fd_ = ::open(name, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    return fd_ < 0 ? -1 : 0;
  });
  if (opened) return Ok();
  name_.clear();  // somebody else's
  return CannotBeWritten(path, errno);
}

// In one moment for everybody else.
bool UnfinishedFile::TakeName() {
  if (name_.empty()) {
    const std::string open = "/proc/self/fd/" + std::to_string(fd_);
    const auto link = [&](const char* name) {
      return ::linkat(AT_FDCWD, open.c_str(), AT_FDCWD, name, AT_SYMLINK_FOLLOW);
    };
    if (link(target_.c_str()) == 0) return true;
    if (errno != EEXIST) return false;
    fs::path name;
    if (!UnderNewName(target_, &name, link)) return false;
    name_ = name;
  }
  if (::rename(name_.c_str(), target_.c_str()) != 0) return false;
  name_.clear();
  return true;
}

Error UnfinishedFile::Finish() {
  const bool whole = (::fsync(fd_) == 0 || errno == EINVAL || errno == EROFS) && TakeName();
  if (!whole) return CannotBeWritten(target_, errno);
  SyncFolder(FolderOf(target_));
  return Ok();
}

Error WriteFile(const fs::path& path, std::span<const uint8_t> bytes) { return WriteFile(path, Parts{&bytes, 1}); }

Error WriteFile(const fs::path& path, Parts parts) {
  Target target;
  if (Error e = FindTarget(path, &target)) return e;
  if (target.as_it_is) return WriteAsItIs(path, parts);
  UnfinishedFile file;
  if (Error e = file.Start(path)) return e;
  if (!WriteAll(file.descriptor(), parts)) return CannotBeWritten(path, errno);
  return file.Finish();
}

Error WriteTextFile(const fs::path& path, std::string_view text) {
  return WriteFile(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

}  // namespace flaneur
