#include "runtime/render/context.h"

#define EGL_EGLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

namespace flaneur {

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
  impl_->display = OpenDisplay();
  if (impl_->display == EGL_NO_DISPLAY) {
    return Fail("no OpenGL without a display on this machine: install the Debian package libgl1-mesa-dri, or add --no-draw");
  }
  const EGLint config_attributes[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  eglBindAPI(EGL_OPENGL_ES_API);
  eglChooseConfig(impl_->display, config_attributes, &config, 1, &count);
  const EGLint context_attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 0, EGL_NONE};
  impl_->context = eglCreateContext(impl_->display, count > 0 ? config : EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, context_attributes);
  if (impl_->context == EGL_NO_CONTEXT ||
      !eglMakeCurrent(impl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, impl_->context)) {
    return Fail("OpenGL ES 3.0 is not available on this machine; add --no-draw");
  }
  return Ok();
}

std::string HeadlessContext::Renderer() const {
  const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return name != nullptr ? name : "unknown";
}

struct Window::Impl {
  GLFWwindow* window = nullptr;
  double last_x = 0, last_y = 0;
  bool tab_down = false;
  std::array<bool, 13> function_presses{};  // not asked for yet

  static void OnKey(GLFWwindow* window, int key, int, int action, int) {
    auto* impl = static_cast<Impl*>(glfwGetWindowUserPointer(window));
    if (action == GLFW_PRESS && key >= GLFW_KEY_F1 && key <= GLFW_KEY_F12) impl->function_presses[static_cast<size_t>(key - GLFW_KEY_F1 + 1)] = true;
  }
};

Window::Window() : impl_(std::make_unique<Impl>()) {}

Window::~Window() {
  if (impl_->window != nullptr) glfwDestroyWindow(impl_->window);
  glfwTerminate();
}

Error Window::Create(int width_px, int height_px, const char* title) {
  if (!glfwInit()) return Fail("there is no display for a window; add --headless");
  glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_ES_API);
  glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 0);
  impl_->window = glfwCreateWindow(width_px, height_px, title, nullptr, nullptr);
  if (impl_->window == nullptr) return Fail("no window with OpenGL ES 3.0 could be opened; add --headless");
  glfwMakeContextCurrent(impl_->window);
  glfwSwapInterval(1);
  glfwSetWindowUserPointer(impl_->window, impl_.get());
  glfwSetKeyCallback(impl_->window, Impl::OnKey);
  glfwSetInputMode(impl_->window, GLFW_CURSOR, GLFW_CURSOR_DISABLED);
  glfwGetCursorPos(impl_->window, &impl_->last_x, &impl_->last_y);
  return Ok();
}

WindowInput Window::Poll() {
  constexpr double kRadiansPerPixel = 0.0025;
  glfwPollEvents();
  GLFWwindow* w = impl_->window;
  const auto down = [w](int key) { return glfwGetKey(w, key) == GLFW_PRESS; };
  WindowInput input;
  input.walk.y = static_cast<float>((down(GLFW_KEY_W) || down(GLFW_KEY_UP)) - (down(GLFW_KEY_S) || down(GLFW_KEY_DOWN)));
  input.walk.x = static_cast<float>((down(GLFW_KEY_D) || down(GLFW_KEY_RIGHT)) - (down(GLFW_KEY_A) || down(GLFW_KEY_LEFT)));
  double x = 0, y = 0;
  glfwGetCursorPos(w, &x, &y);
  input.turn_rad = static_cast<float>((impl_->last_x - x) * kRadiansPerPixel);
  input.pitch_rad = static_cast<float>((impl_->last_y - y) * kRadiansPerPixel);
  impl_->last_x = x;
  impl_->last_y = y;
  const bool tab = down(GLFW_KEY_TAB);
  input.toggle_tour = tab && !impl_->tab_down;
  impl_->tab_down = tab;
  input.close = glfwWindowShouldClose(w) || down(GLFW_KEY_ESCAPE);
  return input;
}

void Window::Size(int* width_px, int* height_px) const { glfwGetFramebufferSize(impl_->window, width_px, height_px); }
void Window::Show() { glfwSwapBuffers(impl_->window); }
bool Window::WasPressed(const std::string& function_key) {
  const auto number = static_cast<size_t>(std::clamp(std::atoi(function_key.c_str() + 1), 1, 12));
  const bool pressed = impl_->function_presses[number];
  impl_->function_presses[number] = false;
  return pressed;
}
void Window::SetTitle(const char* title) { glfwSetWindowTitle(impl_->window, title); }

}  // namespace flaneur
