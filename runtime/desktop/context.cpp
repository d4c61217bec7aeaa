#include "runtime/desktop/context.h"

#define EGL_EGLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <dlfcn.h>
#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "runtime/base/clock.h"
#include "runtime/desktop/icon.h"
#include "runtime/desktop/monitors.h"
#include "runtime/render/gl_objects.h"

namespace flaneur {

// What InputName names (runtime/visit/window_input.cpp).
static_assert(GLFW_KEY_SPACE == 32 && GLFW_KEY_A == 'A' && GLFW_KEY_0 == '0' && GLFW_KEY_ESCAPE == 256 &&
              GLFW_KEY_F1 == 290 && GLFW_KEY_KP_0 == 320 && GLFW_KEY_MENU == 348 && GLFW_KEY_LAST < kFirstPadCode &&
              GLFW_GAMEPAD_BUTTON_DPAD_LEFT == 14);

std::string PrintedKey(int code) {
  const char* printed = glfwGetKeyName(code, 0);
  return printed != nullptr ? printed : "";
}

struct HeadlessContext::Impl {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
};

HeadlessContext::HeadlessContext() : impl_(std::make_unique<Impl>()) {}

HeadlessContext::~HeadlessContext() {
  if (impl_->display == EGL_NO_DISPLAY) return;
  eglMakeCurrent(impl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  if (impl_->context != EGL_NO_CONTEXT) eglDestroyContext(impl_->display, impl_->context);
  eglTerminate(impl_->display);
}

namespace {

// What is wrong is said in one line of ours.
void KeepEglQuiet() { ::setenv("EGL_LOG_LEVEL", "fatal", 0); }

EGLDisplay OpenDisplay() {
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const auto has = [&](const char* name) { return extensions != nullptr && std::strstr(extensions, name) != nullptr; };
  const auto usable = [](EGLDisplay d) { return d != EGL_NO_DISPLAY && eglInitialize(d, nullptr, nullptr); };
  // A GPU first, then Mesa in software.
  if (has("EGL_EXT_platform_device") && has("EGL_EXT_device_enumeration")) {
    const auto query = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
    EGLDeviceEXT devices[8];
    EGLint count = 0;
    if (query != nullptr && query(8, devices, &count)) {
      for (EGLint i = 0; i < count; ++i) {
        const EGLDisplay d = eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr);
        if (usable(d)) return d;
      }
    }
  }
  if (has("EGL_MESA_platform_surfaceless")) {
    const EGLDisplay d = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (usable(d)) return d;
  }
  const EGLDisplay d = eglGetDisplay(EGL_DEFAULT_DISPLAY);
  return usable(d) ? d : EGL_NO_DISPLAY;
}

}  // namespace

Error HeadlessContext::Create() {
  KeepEglQuiet();
  impl_->display = OpenDisplay();
  if (impl_->display == EGL_NO_DISPLAY) {
    return Fail(
        "no OpenGL without a display on this machine: install the Debian package libgl1-mesa-dri, or add --no-draw");
  }
  const EGLint config_attributes[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, EGL_DONT_CARE,
                                      EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  eglBindAPI(EGL_OPENGL_ES_API);
  eglChooseConfig(impl_->display, config_attributes, &config, 1, &count);
  const EGLint context_attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 0, EGL_NONE};
  impl_->context =
      eglCreateContext(impl_->display, count > 0 ? config : EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, context_attributes);
  if (impl_->context == EGL_NO_CONTEXT ||
      !eglMakeCurrent(impl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, impl_->context)) {
    return Fail(
        "this machine's graphics driver has no OpenGL ES 3.0: update it, or draw in software with "
        "LIBGL_ALWAYS_SOFTWARE=1");
  }
  return Ok();
}

std::string HeadlessContext::Renderer() const {
  const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return name != nullptr ? name : "unknown";
}

namespace {

constexpr double kStillAClick_px = 8;  // of the mouse, or a finger, between press and release
constexpr double kPointerRests_s = 3;  // until it is hidden

Vec2 Cursor(GLFWwindow* w) {
  double x = 0, y = 0;
  glfwGetCursorPos(w, &x, &y);
  return {static_cast<float>(x), static_cast<float>(y)};
}

void ReadGamepad(WindowInput* input) {
  GLFWgamepadstate pad;
  int joystick = GLFW_JOYSTICK_1;
  while (joystick < GLFW_JOYSTICK_LAST && !glfwJoystickIsGamepad(joystick)) ++joystick;
  if (!glfwGetGamepadState(joystick, &pad)) return;
  input->left_stick = {pad.axes[GLFW_GAMEPAD_AXIS_LEFT_X], -pad.axes[GLFW_GAMEPAD_AXIS_LEFT_Y]};
  input->right_stick = {pad.axes[GLFW_GAMEPAD_AXIS_RIGHT_X], -pad.axes[GLFW_GAMEPAD_AXIS_RIGHT_Y]};
  for (int button = 0; button <= GLFW_GAMEPAD_BUTTON_LAST; ++button) {
    if (pad.buttons[button] == GLFW_PRESS) input->down.set(static_cast<size_t>(kFirstPadCode + button));
  }
}

void (*on_loss)(const char* why) = nullptr;

// Xlib ends the program by itself when its server or one of our windows is gone, and says so in its own words. It is
// there only where GLFW brings it along.
void NoticeLostDisplay() {
  using SetHandler = void (*)(int (*)(void*));
  if (void* set = ::dlsym(RTLD_DEFAULT, "XSetIOErrorHandler")) {
    reinterpret_cast<SetHandler>(set)([](void*) { return on_loss("the connection to the display was lost"), 0; });
  }
}

// GLFW expects some errors while it makes a window: only later they mean this.
void NoticeLostWindow() {
  using SetHandler = void (*)(int (*)(void*, void*));
  if (void* set = ::dlsym(RTLD_DEFAULT, "XSetErrorHandler")) {
    reinterpret_cast<SetHandler>(set)([](void*, void*) { return on_loss("the window was taken away"), 0; });
  }
}

thread_local bool opens_window = false;

void TellOfDriver(int) {
  if (opens_window)
    on_loss(
        "the display was lost, or its graphics driver crashed, while the window was opened; try "
        "LIBGL_ALWAYS_SOFTWARE=1");
  ::signal(SIGSEGV, SIG_DFL);  // another thread's, and no driver's: it crashes as it would have
}

// Mesa 22.3 crashes where the display is lost while a context is made; so may drivers that are broken.
class CrashOfDriver {
 public:
  CrashOfDriver() {
    struct sigaction tell {};
    tell.sa_handler = TellOfDriver;
    ::sigaction(SIGSEGV, &tell, &before_);
    opens_window = true;
  }
  ~CrashOfDriver() {
    opens_window = false;
    ::sigaction(SIGSEGV, &before_, nullptr);
  }
  CrashOfDriver(const CrashOfDriver&) = delete;
  CrashOfDriver& operator=(const CrashOfDriver&) = delete;

 private:
  struct sigaction before_ {};
};

}  // namespace

struct Window::Impl {
  GLFWwindow* window = nullptr;
  Vec2 last, pressed_at;  // of the cursor
  bool focused = false, held = false, dragged = false, free_pointer = false;
  bool entered = false;   // the cursor came into the window or left it since the last look
  bool software = false;  // no graphics card draws
  double moved_s = 0;     // when the pointer last did
  bool pointer_hidden = false;
  int x = 0, y = 0, width = 0, height = 0;  // of the window where it does not fill its monitor
  GLFWmonitor* to_fill = nullptr;           // as soon as it appears

  void ShowPointer() const {
    glfwSetInputMode(window, GLFW_CURSOR,
                     !free_pointer    ? GLFW_CURSOR_DISABLED
                     : pointer_hidden ? GLFW_CURSOR_HIDDEN
                                      : GLFW_CURSOR_NORMAL);
  }
  void HideRestingPointer(bool moved) {
    if (moved) moved_s = Now_s();
    const bool rests = Now_s() - moved_s > kPointerRests_s;
    if (rests == pointer_hidden) return;
    pointer_hidden = rests;
    if (free_pointer) ShowPointer();
  }
  void Fill(GLFWmonitor* monitor) {
    glfwGetWindowPos(window, &x, &y);
    glfwGetWindowSize(window, &width, &height);
    FillMonitor(window, monitor);
  }
  // As large as the monitor, and not yet there.
  void PrepareToFill(GLFWmonitor* monitor) {
    to_fill = monitor;
    glfwGetWindowPos(window, &x, &y);
    glfwGetWindowSize(window, &width, &height);
    const GLFWvidmode* mode = glfwGetVideoMode(monitor);
    if (mode != nullptr) glfwSetWindowSize(window, mode->width, mode->height);
  }
  void ShowIcon() const {
    constexpr int kSides_px[] = {128, 48, 16};
    std::vector<uint8_t> pictures[std::size(kSides_px)];
    GLFWimage icons[std::size(kSides_px)];
    for (size_t k = 0; k < std::size(kSides_px); ++k) {
      pictures[k] = IconPicture(kSides_px[k]);
      icons[k] = {kSides_px[k], kSides_px[k], pictures[k].data()};
    }
    glfwSetWindowIcon(window, std::size(kSides_px), icons);
  }
};

Window::Window() : impl_(std::make_unique<Impl>()) {}

Window::~Window() {
  if (impl_->window != nullptr) glfwDestroyWindow(impl_->window);
  glfwTerminate();
}

Error Window::Create(const WindowOptions& options, void (*lost)(const char* why)) {
  KeepEglQuiet();
  on_loss = lost;
  NoticeLostDisplay();
  if (!glfwInit()) return Fail("there is no display for a window; add --headless");
  GLFWmonitor* monitor = nullptr;
  if (options.fullscreen || !options.monitor.empty()) {
    if (Error e = FindMonitor(options.monitor, &monitor)) return e;
  }
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);  // who clicks on another screen leaves this one as it is
  glfwWindowHintString(GLFW_X11_CLASS_NAME, "flaneur-player");
  glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_ES_API);
  glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 0);
  {
    const CrashOfDriver crash;
    impl_->window = glfwCreateWindow(options.width_px, options.height_px, options.title.c_str(), nullptr, nullptr);
  }
  if (impl_->window == nullptr) {
    glfwPollEvents();  // a display that is gone is noticed here
    return Fail(
        "no window with OpenGL ES 3.0 can be opened: update the graphics driver or install the Debian package "
        "libgl1-mesa-dri, "
        "or draw in software with LIBGL_ALWAYS_SOFTWARE=1");
  }
  NoticeLostWindow();
  impl_->ShowIcon();
  if (monitor != nullptr) CenterOn(impl_->window, monitor);
  if (options.fullscreen) impl_->PrepareToFill(monitor);
  glfwMakeContextCurrent(impl_->window);
  glfwSwapInterval(1);
  impl_->software = DrawsInSoftware();
  glfwSetInputMode(impl_->window, GLFW_CURSOR, GLFW_CURSOR_DISABLED);
  glfwSetWindowUserPointer(impl_->window, impl_.get());
  glfwSetCursorEnterCallback(
      impl_->window, [](GLFWwindow* w, int) { static_cast<Impl*>(glfwGetWindowUserPointer(w))->entered = true; });
  // Whoever taps shorter than a picture lasts is heard as well.
  glfwSetInputMode(impl_->window, GLFW_STICKY_KEYS, GLFW_TRUE);
  glfwSetInputMode(impl_->window, GLFW_STICKY_MOUSE_BUTTONS, GLFW_TRUE);
  impl_->last = Cursor(impl_->window);
  return Ok();
}

void Window::FreePointer(bool free) {
  if (free == impl_->free_pointer) return;
  impl_->free_pointer = free;
  impl_->ShowPointer();
  impl_->last = Cursor(impl_->window);
}

WindowInput Window::Poll(double wait_s) {
  if (wait_s > 0) glfwWaitEventsTimeout(wait_s);
  else glfwPollEvents();
  GLFWwindow* w = impl_->window;
  WindowInput input;
  for (int key = GLFW_KEY_SPACE; key <= GLFW_KEY_LAST; ++key) {
    if (glfwGetKey(w, key) == GLFW_PRESS) input.down.set(static_cast<size_t>(key));
  }
  ReadGamepad(&input);
  const Vec2 cursor = Cursor(w);
  // A window that comes to the front has its cursor put elsewhere, as has one that catches a cursor from beside it:
  // nobody moved the mouse.
  const bool focused = glfwGetWindowAttrib(w, GLFW_FOCUSED);
  if (focused != impl_->focused || !focused || impl_->entered) impl_->last = cursor;
  impl_->focused = focused;
  impl_->entered = false;
  for (const int button : {GLFW_MOUSE_BUTTON_RIGHT, GLFW_MOUSE_BUTTON_MIDDLE}) {
    if (glfwGetMouseButton(w, button) == GLFW_PRESS) input.down.set(static_cast<size_t>(kFirstMouseCode + button));
  }
  const bool held = glfwGetMouseButton(w, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS;
  if (held && !impl_->held) impl_->pressed_at = impl_->last = cursor, impl_->dragged = false;
  impl_->HideRestingPointer(Length(cursor - impl_->last) > 0 || held);
  if (Length(cursor - impl_->pressed_at) > static_cast<float>(kStillAClick_px)) impl_->dragged = true;
  if (!impl_->free_pointer || (held && impl_->dragged)) input.turned_px = cursor - impl_->last;
  if (impl_->held && !held && (!impl_->free_pointer || !impl_->dragged)) input.clicks.push_back(PlaceOf(cursor));
  if (impl_->free_pointer) input.pointer = PlaceOf(cursor);
  input.pressed = held;
  impl_->held = held;
  impl_->last = cursor;
  input.close = glfwWindowShouldClose(w);
  glfwSetWindowShouldClose(w, GLFW_FALSE);
  return input;
}

// In the picture, 0 to 1.
Vec2 Window::PlaceOf(Vec2 cursor) const {
  if (!impl_->free_pointer) return {0.5f, 0.5f};
  int width = 0, height = 0;
  glfwGetWindowSize(impl_->window, &width, &height);
  return {cursor.x / static_cast<float>(std::max(1, width)), cursor.y / static_cast<float>(std::max(1, height))};
}

void Window::Size(int* width_px, int* height_px) const { glfwGetFramebufferSize(impl_->window, width_px, height_px); }

void Window::Show() {
  int width = 0, height = 0;
  Size(&width, &height);  // asks the display: where it is gone we end here, Mesa would crash
  glfwSwapBuffers(impl_->window);
}

bool Window::ShowWaits() const { return !impl_->software; }

void Window::Appear() {
  if (impl_->to_fill != nullptr) FillMonitor(impl_->window, impl_->to_fill);
  glfwShowWindow(impl_->window);
}

void Window::SetTitle(const char* title) { glfwSetWindowTitle(impl_->window, title); }

void Window::SetFullscreen(bool fullscreen) {
  GLFWwindow* w = impl_->window;
  if (fullscreen == (glfwGetWindowMonitor(w) != nullptr)) return;
  if (fullscreen) impl_->Fill(MonitorOf(w));
  else glfwSetWindowMonitor(w, nullptr, impl_->x, impl_->y, impl_->width, impl_->height, GLFW_DONT_CARE);
}

}  // namespace flaneur
