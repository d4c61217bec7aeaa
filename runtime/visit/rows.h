// The rows of a page, one after the other, for whatever shows them: the window draws them, a web page makes elements of
// them.
#pragma once
#include <string>
#include <vector>

namespace flaneur {

class Rows {
 public:
  virtual ~Rows() = default;
  virtual bool Button(const std::string& text, const std::string& id) = 0;  // pressed
  virtual void Words(const std::string& text) = 0;                          // only to be read
  // Less and more; by how many steps it shall change.
  virtual int Amount(const std::string& text, const std::string& value) = 0;
  // Buttons beside what they are for; which one was pressed, -1: none.
  virtual int Choice(const std::string& text, const std::vector<std::string>& buttons, const std::string& id) = 0;
};

}  // namespace flaneur
