// Warnings on stderr, one line each. Internal to runtime/desktop.
#pragma once
#include <string>

#include "runtime/visit/shell.h"

namespace flaneur {

void Warn(const std::string& what);

class WarningsOnStderr : public Warnings {
 public:
  void Warn(const std::string& what) override { flaneur::Warn(what); }
};

}  // namespace flaneur
