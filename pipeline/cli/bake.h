// From tour.toml to a tour pack, as a whole or step by step.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/cli/trust.h"
#include "runtime/base/error.h"

namespace flaneur {

struct BakeOptions {
  std::filesystem::path output;  // empty: build_assets/NAME under the current folder; of several tours: DIR/NAME
  // What steps have made. Empty: what FLANEUR_CACHE names, else the output folder's cache; of several tours one beside
  // their outputs.
  std::filesystem::path cache;
  size_t jobs = 0;             // steps at a time; 0: as many as there are cores
  double memory_mb = 0;        // that steps may take together; 0: four fifths of what is free
  double time_limit_s = 3600;  // of each program that a step starts; 0: none
  bool draft = false;          // all of it, coarsely
  Trust trust;
};

struct BakedTour {
  std::filesystem::path tour, pack, report;
  std::string name;
  Error error;
  bool unchanged = false;
  double work_s = 0;  // of processors, in this bake
  size_t warnings = 0, errors_found = 0;
};

// Writes NAME.glb, report.json, report.html, footprints.geojson, plan.png and manifest.json into each tour's output.
// What is there already is only replaced when all steps succeeded, and then all in one moment. A tour that fails does
// not keep the others from being baked. Of several tours: what they share is made once. Errors: those of all tours
// (each in `baked` too).
Error Bake(const std::vector<std::filesystem::path>& tours, const BakeOptions& options, std::vector<BakedTour>* baked);

// One step of a plan.
struct PlannedStep {
  std::string name;
  std::vector<std::string> needs;            // names of steps
  std::vector<std::string> inputs, outputs;  // files
  std::string key;
  bool in_store = false;              // its result is there
  bool provisional = false;           // the key becomes another once a script has run
  double seconds = 0, memory_mb = 0;  // expected
};

// What a bake would do. Nothing is made.
Error PlanBake(const std::filesystem::path& tour, const BakeOptions& options, std::vector<PlannedStep>* plan);

// Does one step, and first those that it needs and that are not in the store. Errors: no step of that name.
Error BakeStep(const std::filesystem::path& tour, const BakeOptions& options, const std::string& name);

// All files of a tour, as far as they are known without baking it: what to watch.
Error FilesOfTour(const std::filesystem::path& tour, std::vector<std::filesystem::path>* files);

}  // namespace flaneur
