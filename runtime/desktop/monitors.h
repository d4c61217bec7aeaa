// Which screen a window is on. Internal to runtime/desktop.
#pragma once
#include <string>

#include "runtime/base/error.h"

struct GLFWmonitor;
struct GLFWwindow;

namespace flaneur {

// wish: a monitor's number, from 1, or its name, such as "HDMI-1"; empty: the primary one. Errors: there is none like
// that; names those that there are.
Error FindMonitor(const std::string& wish, GLFWmonitor** monitor);

// The monitor that shows most of the window.
GLFWmonitor* MonitorOf(GLFWwindow* window);

// All of the monitor, in the mode that it is in.
void FillMonitor(GLFWwindow* window, GLFWmonitor* monitor);

// In the middle of the monitor.
void CenterOn(GLFWwindow* window, GLFWmonitor* monitor);

}  // namespace flaneur
