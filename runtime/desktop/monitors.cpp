#include "runtime/desktop/monitors.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cstdint>
#include <span>

#include "runtime/base/text.h"

namespace flaneur {
namespace {

std::span<GLFWmonitor* const> Monitors() {
  int count = 0;
  GLFWmonitor** all = glfwGetMonitors(&count);
  return {all, static_cast<size_t>(std::max(0, count))};
}

std::string ListOfMonitors() {
  std::string list;
  for (size_t k = 0; k < Monitors().size(); ++k) {
    GLFWmonitor* monitor = Monitors()[k];
    const GLFWvidmode* mode = glfwGetVideoMode(monitor);
    list += (k == 0 ? "" : ", ") + std::to_string(k + 1) + " " + glfwGetMonitorName(monitor);
    if (mode != nullptr) list += " (" + std::to_string(mode->width) + "x" + std::to_string(mode->height) + ")";
  }
  return list;
}

}  // namespace

Error FindMonitor(const std::string& wish, GLFWmonitor** monitor) {
  const auto all = Monitors();
  *monitor = wish.empty() && !all.empty() ? glfwGetPrimaryMonitor() : nullptr;
  for (size_t k = 0; k < all.size(); ++k) {
    if (wish == std::to_string(k + 1) || wish == glfwGetMonitorName(all[k])) *monitor = all[k];
  }
  if (*monitor != nullptr) return Ok();
  return Fail("there is no monitor '" + OneLine(wish) + "'; there are: " + ListOfMonitors());
}

GLFWmonitor* MonitorOf(GLFWwindow* window) {
  if (GLFWmonitor* filled = glfwGetWindowMonitor(window)) return filled;
  int x = 0, y = 0, width = 0, height = 0;
  glfwGetWindowPos(window, &x, &y);
  glfwGetWindowSize(window, &width, &height);
  GLFWmonitor* best = glfwGetPrimaryMonitor();
  int64_t most = 0;
  for (GLFWmonitor* monitor : Monitors()) {
    const GLFWvidmode* mode = glfwGetVideoMode(monitor);
    if (mode == nullptr) continue;
    int left = 0, top = 0;
    glfwGetMonitorPos(monitor, &left, &top);
    const int64_t wide = std::min(x + width, left + mode->width) - std::max(x, left);
    const int64_t high = std::min(y + height, top + mode->height) - std::max(y, top);
    if (wide <= 0 || high <= 0 || wide * high <= most) continue;
    most = wide * high;
    best = monitor;
  }
  return best;
}

void FillMonitor(GLFWwindow* window, GLFWmonitor* monitor) {
  const GLFWvidmode* mode = glfwGetVideoMode(monitor);
  if (mode != nullptr) glfwSetWindowMonitor(window, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void CenterOn(GLFWwindow* window, GLFWmonitor* monitor) {
  int left = 0, top = 0, wide = 0, high = 0, width = 0, height = 0;
  glfwGetMonitorWorkarea(monitor, &left, &top, &wide, &high);
  glfwGetWindowSize(window, &width, &height);
  glfwSetWindowPos(window, left + std::max(0, (wide - width) / 2), top + std::max(0, (high - height) / 2));
}

}  // namespace flaneur
