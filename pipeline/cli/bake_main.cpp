// The verbs of `flaneur` that work on pictures, and those of a bake; `flaneur` starts this program for them.
#include <cstdio>
#include <map>

#include "pipeline/cli/verbs.h"

int main(int argc, char** argv) {
  const std::map<std::string, int (*)(const flaneur::Arguments&)> verbs{{"bake", flaneur::RunBake},
                                                                        {"impostor", flaneur::RunImpostor},
                                                                        {"plan", flaneur::RunPlan},
                                                                        {"step", flaneur::RunStep}};
  const auto verb = argc < 2 ? verbs.end() : verbs.find(argv[1]);
  if (verb == verbs.end()) {
    std::fprintf(stderr, "flaneur-bake: error: this is a part of flaneur; see flaneur --help\n");
    return 2;
  }
  return verb->second({argv + 2, argv + argc});
}
