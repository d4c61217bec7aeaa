#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "pipeline/cli/verbs.h"
#include "runtime/base/text.h"

namespace {

struct Verb {
  int (*run)(const flaneur::Arguments&);
  const char* usage;
  const char* purpose;
};

const std::map<std::string, Verb> kVerbs{
    {"bake", {flaneur::RunBake, "TOUR.toml... [-o DIR]", "all stages, from tour.toml to a tour pack"}},
    {"plan", {flaneur::RunPlan, "TOUR.toml [--json]", "the steps of a bake, for this machine or many"}},
    {"step", {flaneur::RunStep, "TOUR.toml NAME", "one of these steps"}},
    {"cache", {flaneur::RunCache, "[DIR] [--verify]", "what steps have made and keep"}},
    {"avatar", {flaneur::RunAvatar, "IN.glb -o OUT.glb", "levels of detail of a rigged character"}},
    {"impostor", {flaneur::RunImpostor, "IN.glb -o DIR", "impostor atlas of a rigged character"}},
    {"footprints", {flaneur::RunFootprints, "TOWN.glb -o OUT.geojson", "obstacles from a town model"}},
    {"check", {flaneur::RunCheck, "OUT.geojson [--town TOWN.glb]", "whether obstacles are fit for a crowd"}},
    {"web", {flaneur::RunWeb, "PACK.glb -o DIR", "a tour as a static web site"}},
    {"inspect", {flaneur::RunInspect, "PACK.glb [--json]", "what is in a tour pack"}},
};

void PrintHelp() {
  std::printf("flaneur makes tour packs: a historic town, its obstacles and its townspeople in one file.\n\n");
  for (const auto& [name, verb] : kVerbs) {
    std::printf("  flaneur %-10s %-30s %s\n", name.c_str(), verb.usage, verb.purpose);
  }
  std::printf(
      "\nflaneur VERB --help says all about one. Exit status: 0 done, 1 findings (check), 2 bad usage or input.\n");
}

int Refuse(const std::string& why) {
  std::fprintf(stderr, "flaneur: error: %s; see flaneur --help\n", why.c_str());
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> args(argv + 1, argv + argc);
  if (args.empty()) return Refuse("a verb is missing");
  if (args[0] == "--help" || args[0] == "-h") {
    PrintHelp();
    return 0;
  }
  if (args[0] == "--version") {
    std::printf("flaneur %s\n", FLANEUR_VERSION);
    return 0;
  }
  const auto verb = kVerbs.find(args[0]);
  if (verb == kVerbs.end()) {
    std::vector<std::string> names;
    for (const auto& [name, unused] : kVerbs) names.push_back(name);
    return Refuse("there is no verb '" + args[0] + "'" + flaneur::DidYouMean(args[0], names));
  }
  try {
    return verb->second.run({args.begin() + 1, args.end()});
  } catch (const std::bad_alloc&) {
    return Refuse("there is not enough memory for " + args[0] + " of this");
  } catch (const std::exception& e) {
    return Refuse(args[0] + ": " + flaneur::OneLine(e.what()));
  }
}
