#include "runtime/desktop/stills.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/text.h"

namespace flaneur {

std::vector<Still> StillsOf(const PlayerOptions& options, float step_s) {
  if (options.screenshot.empty()) return {};
  if (options.at_s.empty()) return {{-1, options.screenshot}};
  std::vector<Still> stills;
  for (float at_s : options.at_s) {
    std::filesystem::path path = options.screenshot;
    path.replace_filename(path.stem().string() + "_" + Compact(static_cast<double>(at_s)) + "s" +
                          path.extension().string());
    stills.push_back({std::llround(static_cast<double>(at_s) / static_cast<double>(step_s)), path});
  }
  std::sort(stills.begin(), stills.end(), [](const Still& a, const Still& b) { return a.frame < b.frame; });
  return stills;
}

}  // namespace flaneur
