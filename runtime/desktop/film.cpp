#include "runtime/desktop/film.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "runtime/base/text.h"
#include "runtime/desktop/interruption.h"

extern char** environ;

namespace flaneur {

namespace {

// Ffmpeg writes into a file that has no name yet: none of which it could take a part for a protocol or an option.
constexpr int kFilmDescriptor = 3;
constexpr const char* kFilmInFfmpeg = "file:/proc/self/fd/3";

// Of what has been written to it.
std::string LastLine(int file) {
  char text[2000];
  const ssize_t size = file < 0 ? 0 : ::lseek(file, 0, SEEK_END);
  const ssize_t read =
      size <= 0 ? 0 : ::pread(file, text, sizeof text, std::max<ssize_t>(0, size - static_cast<ssize_t>(sizeof text)));
  std::string line(text, static_cast<size_t>(std::max<ssize_t>(0, read)));
  line.erase(line.find_last_not_of(" \r\n") + 1);
  return OneLine(line.substr(line.find_last_of('\n') + 1));
}

}  // namespace

FilmWriter::~FilmWriter() {
  if (pipe_ >= 0) ::close(pipe_);
  if (process_ > 0) {
    ::kill(process_, SIGKILL);  // what it wrote so far is of no use
    ::waitpid(process_, nullptr, 0);
  }
  if (complaints_ >= 0) ::close(complaints_);
}

Error FilmWriter::Start(const std::filesystem::path& path, int width_px, int height_px, float frames_per_s) {
  if (width_px % 2 != 0 || height_px % 2 != 0)
    return Fail("a film needs an even --size, not " + std::to_string(width_px) + "x" + std::to_string(height_px));
  path_ = path;
  if (Error e = file_.Start(path)) return e;
  const std::string size = std::to_string(width_px) + "x" + std::to_string(height_px),
                    rate = std::to_string(frames_per_s);
  const char* argv[] = {
      "ffmpeg",  "-v",          "error",      "-y",         "-f",         "rawvideo",    "-pixel_format",
      "rgb24",   "-video_size", size.c_str(), "-framerate", rate.c_str(), "-i",          "-",
      "-c:v",    "libx264",     "-preset",    "veryfast",   "-crf",       "20",          "-pix_fmt",
      "yuv420p", "-movflags",   "+faststart", "-f",         "mp4",        kFilmInFfmpeg, nullptr};
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return Fail("no pipe to ffmpeg: " + std::string(std::strerror(errno)));
  complaints_ = ::memfd_create("complaints", MFD_CLOEXEC);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  if (complaints_ >= 0) posix_spawn_file_actions_adddup2(&actions, complaints_, STDERR_FILENO);
  posix_spawn_file_actions_adddup2(&actions, file_.descriptor(), kFilmDescriptor);
  ::signal(SIGPIPE, SIG_IGN);
  const int failed = ::posix_spawnp(&process_, "ffmpeg", &actions, nullptr, const_cast<char**>(argv), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[0]);
  if (failed != 0) {
    ::close(ends[1]);
    process_ = -1;
    return Fail("ffmpeg cannot be started: install the Debian package ffmpeg, or leave --film out");
  }
  pipe_ = ends[1];
  EndsWithUs(process_);
  return Ok();
}

Error FilmWriter::Add(const std::vector<uint8_t>& rgb) {
  size_t done = 0;
  while (done < rgb.size()) {
    const ssize_t count = ::write(pipe_, rgb.data() + done, rgb.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      ::waitpid(process_, nullptr, 0);  // until it has said why
      process_ = -1;
      return Failed();
    }
    done += static_cast<size_t>(count);
  }
  return Ok();
}

Error FilmWriter::Failed() const {
  const std::string why = LastLine(complaints_);
  return Fail(path_.string() + ": cannot be written: ffmpeg " + (why.empty() ? "failed" : "says '" + why + "'"));
}

Error FilmWriter::Finish() {
  ::close(pipe_);
  pipe_ = -1;
  int status = 0;
  ::waitpid(process_, &status, 0);
  process_ = -1;
  EndsWithUs(0);
  // A disk that is full at the film's very end is an error to ffmpeg, but not one to end with another status for.
  const bool whole = WIFEXITED(status) && WEXITSTATUS(status) == 0 && LastLine(complaints_).empty();
  return whole ? file_.Finish() : Failed();
}

}  // namespace flaneur
