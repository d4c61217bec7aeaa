// OpenGL ES 3.0 contexts: without a display through EGL, with one through GLFW. One thread, one context at a time.
#pragma once
#include <memory>
#include <string>

#include "runtime/base/error.h"

namespace flaneur {

// Current from Create() until destroyed. Tries the graphics devices in the driver's order, then Mesa without a surface, then
// the default display.
class HeadlessContext {
 public:
  HeadlessContext();
  ~HeadlessContext();
  HeadlessContext(const HeadlessContext&) = delete;
  HeadlessContext& operator=(const HeadlessContext&) = delete;

  // Errors: no EGL driver offers OpenGL ES 3.0 (says which package brings one).
  Error Create();
  std::string Description() const;  // the driver's name for itself

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// What the visitor does, polled once a frame.
struct WindowInput {
  bool close = false;
  float forward = 0, left = 0;       // asked way, -1..1, from WASD or arrow keys
  bool fast = false;                 // shift
  float yaw_rad = 0, pitch_rad = 0;  // mouse moved since the last poll, as turns: left and up positive
  bool toggle_tour = false;          // Tab or space was pressed
};

class WindowContext {
 public:
  WindowContext();
  ~WindowContext();
  WindowContext(const WindowContext&) = delete;
  WindowContext& operator=(const WindowContext&) = delete;

  // Opens a window with a current context; swaps wait for the screen.
  // Errors: no display, no OpenGL ES 3.0.
  Error Create(int width_px, int height_px, const std::string& title);
  WindowInput Poll();
  void Swap();
  void SetTitle(const std::string& title);
  // Of the drawable, which the user may resize; 0 while minimized.
  int width_px() const;
  int height_px() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// True where a window can be tried: an X11 or Wayland display is set.
bool HasDisplay();

}  // namespace flaneur
