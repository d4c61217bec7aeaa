#include "pipeline/cli/obj_up.h"

#include <CLI/CLI.hpp>
#include <map>
#include <string>

namespace flaneur {

namespace {

const std::map<std::string, UpAxis> kAxes{{"y", UpAxis::kY}, {"z", UpAxis::kZ}};

}  // namespace

void AddObjUp(CLI::App* app, UpAxis* up) {
  app->add_option("--obj-up", *up, "Axis of an OBJ that points up, which the format does not say: y or z; else judged")
      ->transform(CLI::CheckedTransformer(kAxes))
      ->type_name("AXIS");
}

UpAxis UpAxisNamed(const std::string& name) { return name.empty() ? UpAxis::kJudged : kAxes.at(name); }

}  // namespace flaneur
