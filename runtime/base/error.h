// The result of everything that can go wrong: empty when all is well, else one line for the user.
#pragma once
#include <string>
#include <utility>

namespace flaneur {

// One line that names the file, the element, what is wrong and what to do. Never contains a newline.
struct [[nodiscard]] Error {
  std::string message;

  // True when something went wrong, so that `if (Error e = F()) return e;` reads as it acts.
  explicit operator bool() const { return !message.empty(); }
};

inline Error Fail(std::string message) { return Error{std::move(message)}; }
inline Error Ok() { return Error{}; }

}  // namespace flaneur
