#include "pipeline/cli/up_option.h"

#include <CLI/CLI.hpp>
#include <map>
#include <string>

namespace flaneur {

namespace {

const std::map<std::string, UpAxis> kAxes{{"x", UpAxis::kX},       {"y", UpAxis::kY},       {"z", UpAxis::kZ},
                                          {"-x", UpAxis::kMinusX}, {"-y", UpAxis::kMinusY}, {"-z", UpAxis::kMinusZ}};

}  // namespace

void AddUp(CLI::App* app, UpAxis* up) {
  app->add_option(
         "--up", *up,
         "Axis of the file that points up: y, z, -y, ...; else as the format says, and judged where it does not "
         "(OBJ, PLY, STL)")
      ->transform(CLI::CheckedTransformer(kAxes))
      ->type_name("AXIS");
}

UpAxis UpAxisNamed(const std::string& name) { return name.empty() ? UpAxis::kJudged : kAxes.at(name); }

}  // namespace flaneur
