// An OpenGL ES 3.0 context: without a display through EGL, or with a window.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/base/math.h"
#include "runtime/visit/window_input.h"

namespace flaneur {

// A context without any window, current in this thread for as long as it lives.
class HeadlessContext {
 public:
  HeadlessContext();
  ~HeadlessContext();
  // Errors: no EGL display or no OpenGL ES 3 on this machine.
  Error Create();
  std::string Renderer() const;  // what draws, in OpenGL's words

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// What stands on a key by the keyboard's own layout, once a window is open; empty where nothing does.
std::string PrintedKey(int code);

struct WindowOptions {
  int width_px = 1280, height_px = 720;  // where it is no whole screen
  std::string title;
  std::string monitor;      // its number, from 1, or its name; empty: wherever the desktop puts the window
  bool fullscreen = false;  // all of the monitor, without a frame
};

// A window with its context, current in this thread for as long as it lives. A free pointer that has not moved for a
// while is not seen.
class Window {
 public:
  Window();
  ~Window();
  // lost: called, and must not return, when the display or the window is taken away, now or later on, or the driver
  // crashes over it, with a line that says so; what draws cannot go on then. Errors: no display, no such monitor, no
  // OpenGL ES 3.
  Error Create(const WindowOptions& options, void (*lost)(const char* why));
  WindowInput Poll(double wait_s = 0);  // for so long at most, until something happens
  void FreePointer(bool free);          // to point at things with; else the mouse is caught, and turns the view
  void Size(int* width_px, int* height_px) const;
  void Show();             // what was drawn; waits for the display
  bool ShowWaits() const;  // rather than to work: a graphics card's does
  void Appear();           // it is hidden before, so that it never shows nothing
  void SetTitle(const char* title);
  void SetFullscreen(bool fullscreen);  // on the monitor that it is on; else as it was before

 private:
  Vec2 PlaceOf(Vec2 cursor) const;

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flaneur
