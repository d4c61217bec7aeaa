// What the verbs share: reading their arguments and saying how they ended.
#pragma once
#include "pipeline/cli/verbs.h"
#include "runtime/base/error.h"

namespace CLI {
class App;
}

namespace flaneur {

// Negative: go on. Else the exit status: 0 after --help, 2 after bad usage, which was said in one line.
int ParseArguments(CLI::App* app, const Arguments& args);

// Says the error, if any, in one line. The exit status: 0 or 2.
int Report(const Error& error);

}  // namespace flaneur
