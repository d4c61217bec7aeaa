#include "pipeline/cli/obj_up.h"

#include <CLI/CLI.hpp>
#include <map>
#include <string>

namespace flaneur {

void AddObjUp(CLI::App* app, UpAxis* up) {
  const std::map<std::string, UpAxis> axes{{"y", UpAxis::kY}, {"z", UpAxis::kZ}};
  app->add_option("--obj-up", *up, "Axis of an OBJ that points up, which the format does not say: y or z; else judged")
      ->transform(CLI::CheckedTransformer(axes))
      ->type_name("AXIS");
}

}  // namespace flaneur
