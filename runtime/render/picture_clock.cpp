#include "runtime/render/picture_clock.h"

#include <GLES2/gl2ext.h>

#include <cstdint>
#include <string_view>

namespace flaneur {
namespace {

#ifdef __EMSCRIPTEN__
constexpr GLuint64 kLongestWait_ns = 0;  // a page may not wait: the browser does, between its pictures
#else
constexpr GLuint64 kLongestWait_ns = 1'000'000'000;
#endif

bool DriverMeasures() {
  GLint count = 0;
  glGetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLint i = 0; i < count; ++i) {
    const auto* name = reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i)));
    if (name != nullptr && std::string_view(name) == "GL_EXT_disjoint_timer_query") return true;
  }
  return false;
}

void AwaitPicture(PictureClock* clock) {
  if (clock->drawn == nullptr) return;
  glClientWaitSync(clock->drawn, GL_SYNC_FLUSH_COMMANDS_BIT, kLongestWait_ns);
  glDeleteSync(clock->drawn);
  clock->drawn = nullptr;
}

void ReadTime(PictureClock* clock) {
  if (!clock->measured) return;
  GLuint there = 0, took_ns = 0;
  glGetQueryObjectuiv(clock->query, GL_QUERY_RESULT_AVAILABLE, &there);
  if (!there) return;
  glGetQueryObjectuiv(clock->query, GL_QUERY_RESULT, &took_ns);
  clock->measured = false;
  GLint disjoint = 0;  // the card slept or changed its speed meanwhile: the time means nothing, like one beyond 32 bits
  glGetIntegerv(GL_GPU_DISJOINT_EXT, &disjoint);
  if (!disjoint && took_ns != UINT32_MAX) clock->took_ms = took_ns / 1e6;
}

}  // namespace

bool CreatePictureClock(PictureClock* clock) {
#ifdef __EMSCRIPTEN__
  return true;  // the fence alone
#endif
  if (!DriverMeasures()) return false;
  glGenQueries(1, &clock->query);
  return true;
}

void BeginPictureTime(PictureClock* clock) {
  AwaitPicture(clock);
  if (clock->query == 0) return;
  ReadTime(clock);
  if (!clock->measured) glBeginQuery(GL_TIME_ELAPSED_EXT, clock->query);
}

void EndPictureTime(PictureClock* clock) {
  clock->drawn = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  if (clock->query == 0 || clock->measured) return;
  glEndQuery(GL_TIME_ELAPSED_EXT);
  clock->measured = true;
}

bool IsOnItsWay(const PictureClock& clock) {
  return clock.drawn != nullptr && glClientWaitSync(clock.drawn, GL_SYNC_FLUSH_COMMANDS_BIT, 0) == GL_TIMEOUT_EXPIRED;
}

}  // namespace flaneur
