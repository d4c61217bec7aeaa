// The visitor's pages as JSON, for a web page to make elements of. Internal to runtime/web.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runtime/visit/rows.h"

namespace flaneur {

// Tells the rows; one of them may be pressed.
class ToldRows : public Rows {
 public:
  // row: which of them is pressed; -1: none. which: of a choice, the button; of an amount, by how many steps.
  explicit ToldRows(int row = -1, int which = 0) : row_(row), which_(which) {}
  bool Button(const std::string& text, const std::string& id) override;
  void Words(const std::string& text) override;
  int Amount(const std::string& text, const std::string& value) override;
  int Choice(const std::string& text, const std::vector<std::string>& buttons, const std::string& id) override;
  nlohmann::json Take() { return std::move(rows_); }

 private:
  bool Add(nlohmann::json row);  // it is the one that is pressed
  int row_, which_;
  nlohmann::json rows_ = nlohmann::json::array();
};

}  // namespace flaneur
