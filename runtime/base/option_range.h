// Ranges of options on the command line.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "runtime/base/text.h"

namespace flaneur {

// A number from least to most, as CLI::Range, which lets NaN pass.
inline CLI::Validator NumberFrom(double least, double most) {
  const std::string range = "[" + Compact(least) + " - " + Compact(most) + "]";
  return {[least, most, range](std::string& text) {
            double number = 0;
            const bool is_within = CLI::detail::lexical_cast(text, number) && number >= least && number <= most;
            return is_within ? std::string() : "Value " + text + " not in range " + range;
          },
          "FLOAT in " + range};
}

}  // namespace flaneur
