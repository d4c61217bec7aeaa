// One tour being baked: its settings, its steps, and what they have made. Internal to pipeline/cli.
#pragma once
#include <deque>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "pipeline/cli/bake_steps.h"
#include "pipeline/cli/tour_settings.h"
#include "pipeline/core/store.h"
#include "pipeline/pack/write_tour_pack.h"
#include "runtime/base/jobs.h"

namespace flaneur {

// What of a town must be known to plan the rest.
struct TownFacts {
  std::vector<Place> places;
  std::vector<Street> streets;
  double triangles = 0;
  float brightness = 0;  // town_brightness.h
  Point2 origin_m;
  Point2 moved_m;        // subtracted from its file's coordinates (far_town.h)
  double lowered_m = 0;  // from its heights
  std::string reference_system;
};

struct Baking {
  std::filesystem::path tour, output;
  Store store;
  TourSettings settings;
  Jobs* jobs = nullptr;
  std::deque<Step> steps;  // each after those that it needs
  // By source: the town's (may be none), then one an avatar: its step, -1 where it is no script.
  std::vector<int> source_steps;
  int town_step = -1, painting_step = -1, models_step = -1, pack_step = -1;

  TourParts parts;
  TourModels models;
  TownFacts town;
  BakeReport report;
  std::once_flag town_read_once, media_read_once, blender_once;
  Error town_read, media_read;
  Point2 town_moved_m;  // once it is read: see TownFacts
  double town_lowered_m = 0;
  Warnings town_warnings;
  std::string blender_sha256;
  std::mutex contents_mutex;
  std::map<std::filesystem::path, std::string> contents;  // of files read so far
};

// ---- Sources (bake_sources.cpp): files, or what scripts make.
const SourceSettings& SourceOf(const Baking& baking, size_t source);
void AddSourceSteps(Baking* baking);
// Of what the source is made from or of itself; a script's that has not run yet is known by what it is made from.
std::string ContentOf(Baking* baking, size_t source);
std::string ContentOfFile(Baking* baking, const std::filesystem::path& file);
std::string BlenderSha256(Baking* baking);
// Where the source's file is, whole. Errors: its script's.
Error SourceFile(Baking* baking, size_t source, std::filesystem::path* file);
// The file could not be read: where a script made it, it is to be made again next time. The error, with its place in
// tour.toml.
Error BadSource(Baking* baking, size_t source, const Error& error);

// The town of all its models, where it is drawn and its obstacles are (read_town.cpp).
Error ReadTown(Baking* baking, Scene* town, Warnings* warnings);

// ---- The town (bake_town.cpp): what it is, obstacles, painting, check.
void AddTownSteps(Baking* baking);
void AddCheckStep(Baking* baking);
Error ReadTownOnce(Baking* baking);  // into parts.town

// ---- People (bake_people.cpp): levels, impostors, tints.
void AddPeopleSteps(Baking* baking);

// ---- The pack's models, all that takes long to write (bake_models.cpp).
void AddModelsStep(Baking* baking);

// ---- Sounds, pictures, the pack and the report (bake_pack.cpp).
void AddPackSteps(Baking* baking);
// The report's stages and warnings, of all steps in their order.
void FillReport(Baking* baking);
// Whether the results of an earlier bake are what this one would make; then its report says so.
bool ResultsAreUpToDate(Baking* baking);

// By step whether `wanted` needs it to be done in this run. Those that it does not need are left out.
std::vector<bool> LeaveOutUnneeded(Baking* baking, size_t wanted);

// The keys of the steps that it needs, but of scripts: who reads what they make has its content in the key.
std::vector<std::string> KeysOfNeeds(const Baking& baking, const Step& step);

// Adds a step. References to steps stay good.
Step* AddStep(Baking* baking, const std::string& stage, const std::string& item);
size_t IndexOf(const Baking& baking, const Step* step);

}  // namespace flaneur
