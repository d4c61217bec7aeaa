// A site, to browsers of this machine.
#pragma once
#include <filesystem>

#include "runtime/base/error.h"

namespace flaneur {

// Says where it is, and answers until the program is interrupted. port 0: any that is free. Errors: the port is taken.
Error ServeSite(const std::filesystem::path& folder, int port);

}  // namespace flaneur
