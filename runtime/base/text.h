// Text for messages.
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace flaneur {

// The candidate most like `name` (smallest edit distance, at most a third of its length and at least 1),
// else empty. For "did you mean".
std::string NearestName(std::string_view name, std::span<const std::string> candidates);

// `"; did you mean 'X'?"`, or empty where nothing is near.
std::string DidYouMean(std::string_view name, std::span<const std::string> candidates);

// Line breaks and control characters become spaces, so that any text fits in a one-line message; what is longer than
// kMostMessage_bytes (runtime/base/limits.h) is cut off.
std::string OneLine(std::string_view text);

// As many whole characters of UTF-8 as fit in so many bytes, from the first.
std::string_view Beginning(std::string_view text, size_t most_bytes);

// At most six digits: "0.25", "1e+06".
std::string Compact(double number);

// Lists and objects of JSON within each other, 200 deep or more: what reads, copies and frees them calls itself for
// each.
bool NestsTooDeep(std::string_view json);
inline constexpr const char* kNestsTooDeep = "holds lists or objects more than 200 deep in each other";

// The line of TOML, from 1, in which a key of more than 200 parts stands (a.b.c has three), each a table in the one
// before; 0: in none.
int LineOfTooLongKey(std::string_view toml);

// What a JSON library complains of, without its error's number and the parser's inner life:
// "parse error at line 1, column 1".
std::string PlainJsonError(std::string_view what);

}  // namespace flaneur
