// Names in one line of a message.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

namespace flaneur {

// "a, b and 3 more": the first `most`, each between two of `quote`.
inline std::string Listed(const std::vector<std::string>& names, size_t most, const std::string& quote = "") {
  std::string list;
  for (size_t i = 0; i < std::min(names.size(), most); ++i) list += (i > 0 ? ", " : "") + quote + names[i] + quote;
  return names.size() > most ? list + " and " + std::to_string(names.size() - most) + " more" : list;
}

}  // namespace flaneur
