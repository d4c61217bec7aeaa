#include "runtime/web/told_rows.h"

namespace flaneur {

bool ToldRows::Add(nlohmann::json row) {
  rows_.push_back(std::move(row));
  return static_cast<int>(rows_.size()) - 1 == row_;
}

bool ToldRows::Button(const std::string& text, const std::string& id) {
  return Add({{"kind", "button"}, {"text", text}, {"id", id}});
}

void ToldRows::Words(const std::string& text) { Add({{"kind", "words"}, {"text", text}}); }

int ToldRows::Amount(const std::string& text, const std::string& value) {
  return Add({{"kind", "amount"}, {"text", text}, {"value", value}}) ? which_ : 0;
}

int ToldRows::Choice(const std::string& text, const std::vector<std::string>& buttons, const std::string& id) {
  return Add({{"kind", "choice"}, {"text", text}, {"buttons", buttons}, {"id", id}}) ? which_ : -1;
}

}  // namespace flaneur
