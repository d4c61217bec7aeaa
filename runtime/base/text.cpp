#include "runtime/base/text.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <vector>

#include "runtime/base/limits.h"

namespace flaneur {
namespace {

size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t substitute = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
    }
  }
  return row.back();
}

}  // namespace

std::string NearestName(std::string_view name, std::span<const std::string> candidates) {
  std::string best;
  size_t best_distance = std::max<size_t>(1, name.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const size_t distance = EditDistance(name, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string DidYouMean(std::string_view name, std::span<const std::string> candidates) {
  const std::string nearest = NearestName(name, candidates);
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

std::string_view Beginning(std::string_view text, size_t most_bytes) {
  if (text.size() <= most_bytes) return text;
  const auto continues = [&](size_t at) { return (static_cast<uint8_t>(text[at]) & 0xC0) == 0x80; };
  while (most_bytes > 0 && continues(most_bytes)) --most_bytes;
  return text.substr(0, most_bytes);
}

std::string Compact(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", number);
  return text;
}

std::string PlainJsonError(std::string_view what) {
  if (what.rfind("[json.exception", 0) == 0) what.remove_prefix(std::min(what.size(), what.find("] ") + 2));
  return OneLine(what.substr(0, what.find(": syntax error")));
}

std::string OneLine(std::string_view text) {
  constexpr std::string_view kMore = " ...";
  std::string out(text.substr(0, kMostMessage_bytes));
  if (text.size() > out.size()) {
    while (!out.empty() && (static_cast<unsigned char>(text[out.size()]) & 0xC0) == 0x80)
      out.pop_back();  // whole letters
    out += kMore;
  }
  for (char& c : out) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  while (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

bool NestsTooDeep(std::string_view json) {
  int depth = 0;
  bool in_string = false;
  for (size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_string && c == '\\') ++i;
    else if (c == '"') in_string = !in_string;
    else if (!in_string && (c == '[' || c == '{') && ++depth > kMostNesting) return true;
    else if (!in_string && (c == ']' || c == '}')) --depth;
  }
  return false;
}

int LineOfTooLongKey(std::string_view toml) {
  int line = 1, parts = 1;
  char quote = 0;  // of the string or comment that we are in; three quotes open and close like one
  for (size_t i = 0; i < toml.size(); ++i) {
    const char c = toml[i];
    line += c == '\n' ? 1 : 0;
    if (quote == '#') {
      quote = c == '\n' ? '\0' : quote;
    } else if (quote != 0) {
      if (quote == '"' && c == '\\') ++i;
      else if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'' || c == '#') {
      quote = c;
    } else if (c == '.' && ++parts > kMostKeyParts) {
      return line;
    }
    if (quote == 0 && std::string_view("=,[]{}\n").find(c) != std::string_view::npos) parts = 1;
  }
  return 0;
}

}  // namespace flaneur
