#include "runtime/desktop/warn.h"

#include <cstdio>

#include "runtime/base/text.h"

namespace flaneur {

void Warn(const std::string& what) { std::fprintf(stderr, "flaneur-player: warning: %s\n", OneLine(what).c_str()); }

}  // namespace flaneur
