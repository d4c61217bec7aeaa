// The files of runtime/visit/words, built into the program. Internal to runtime/visit.
#pragma once
#include <vector>

namespace flaneur {

struct WordFile {
  const char *language, *text;
};
std::vector<WordFile> WordFiles();

}  // namespace flaneur
