#include "pipeline/cli/arguments.h"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "runtime/base/text.h"

namespace flaneur {

int ParseArguments(CLI::App* app, const Arguments& args) {
  try {
    app->parse(Arguments(args.rbegin(), args.rend()));  // CLI11 takes them last first
    return -1;
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app->exit(e);
    std::fprintf(stderr, "flaneur: error: %s; see %s --help\n", OneLine(e.what()).c_str(), app->get_name().c_str());
    return 2;
  }
}

int Report(const Error& error) {
  if (!error) return 0;
  std::fprintf(stderr, "flaneur: error: %s\n", OneLine(error.message).c_str());
  return 2;
}

}  // namespace flaneur
