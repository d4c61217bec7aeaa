// Walks made to fit other skeletons: retarget_bench [--csv FILE] FILE... takes the walk of each file that has one, and
// the walks that come with Flaneur, and makes every file's figure walk by it. Prints for each pair the slide of the
// soles (share of the walking speed), the hips' height against the source's (mm), hands in the body and feet in the
// other leg beyond the source's own (mm), and by how much joints are past what a human's bend to (degrees); then
// median and worst of all. Files that hold no figure are sources alone, those without a walk targets alone.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/io/blender_import.h"
#include "pipeline/io/gltf.h"
#include "pipeline/io/motion_reader.h"
#include "pipeline/rig/clip_loop.h"
#include "pipeline/rig/clip_rig.h"
#include "pipeline/rig/motion_quality.h"
#include "pipeline/rig/retarget.h"

namespace flaneur {
namespace {

constexpr int kKeys = 12;  // of a clip, at which depths are looked for

struct File {
  std::string name;
  std::filesystem::path path;  // glTF or BVH, whatever it was
  std::unique_ptr<TemporaryFolder> folder = std::make_unique<TemporaryFolder>();
};

// One walk, and how its own figure goes by it; depths are shares of the height.
struct Walk {
  std::string name, clip;
  std::filesystem::path path;
  float hips = 0, hands = 0, legs = 0;
};

struct Figure {
  const char* what;
  const char* unit;
  std::vector<float> values;
};

double Share(std::vector<float> values, float share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return static_cast<double>(values[static_cast<size_t>(share * static_cast<float>(values.size() - 1))]);
}

std::vector<File> OpenAll(int argc, char** argv) {
  std::vector<File> files;
  for (int i = 1; i < argc; ++i) {
    File file;
    file.path = argv[i];
    file.name = file.path.stem().string();
    if (NeedsBlender(file.path)) {
      if (const Error e = ConvertToGltf(argv[i], file.folder.get(), &file.path)) {
        std::printf("%s: %s\n", argv[i], e.message.c_str());
        continue;
      }
    }
    files.push_back(std::move(file));
  }
  return files;
}

ReadAvatarOptions WalkingBy(const Walk& walk) {
  ReadAvatarOptions options;
  options.other_clips = {{"walk", walk.clip, walk.path}};
  return options;
}

float Hands(const Avatar& person, const Rig& rig, const Clip& walk) {
  return std::max(HandDepth(person, rig, walk, kLeft, kKeys), HandDepth(person, rig, walk, kRight, kKeys));
}

// What the file's own figure does by its own walk, where it has one.
void MeasureOwn(Walk* walk) {
  Avatar avatar;
  std::vector<std::string> warnings;
  Rig rig;
  std::string why;
  ReadAvatarOptions options;
  options.walk = walk->clip;
  if (ReadAvatar(walk->path, options, &avatar, &warnings) || !MakeRig(avatar, {}, &rig, &why)) return;
  const Clip& own = *FindClip(avatar, "walk");
  walk->hands = Hands(avatar, rig, own) / avatar.height_m;
  walk->legs = LegDepth(avatar, rig, own, kKeys) / avatar.height_m;
  std::printf("%-24s as it is: slide %5.1f %%  hands %5.1f mm  legs %5.1f mm  limits %4.1f deg  %.2f m/s  %d keys\n",
              walk->name.c_str(), 100 * static_cast<double>(FootSlide(avatar, own, avatar.walk_speed_mps)),
              1000 * static_cast<double>(walk->hands * avatar.height_m),
              1000 * static_cast<double>(walk->legs * avatar.height_m),
              static_cast<double>(PastLimits(rig, own)) * 180 / static_cast<double>(kPi),
              static_cast<double>(avatar.walk_speed_mps), own.keys);
}

// False where the file holds no walk of a human.
bool OpenWalk(const File& file, const std::string& clip, Walk* walk) {
  MotionFile motion;
  Rig rig;
  std::string why;
  if (OpenMotion(file.path, &motion)) return false;
  size_t found = motion.clip_names.size();
  for (size_t i = 0; i < motion.clip_names.size(); ++i) {
    std::string name = motion.clip_names[i];
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    const bool walks = name.find("walk") != std::string::npos || motion.clip_names.size() == 1;
    const bool fits = clip.empty() ? walks : name == clip;
    if (fits && (found == motion.clip_names.size() || name.size() < motion.clip_names[found].size())) found = i;
  }
  Clip made;
  if (found == motion.clip_names.size() || ClipOf(motion, found, &made)) return false;
  CutToCycle(motion.skeleton.joints, &made);
  if (!MakeClipRig(motion.skeleton, motion.told, made, &rig, &why)) return false;
  *walk = {clip.empty() ? file.name : clip, motion.clip_names[found], file.path};
  walk->hips = std::min(HipsHeight(rig, made), 1.0f);  // toys hop
  return true;
}

void MeasurePair(const Walk& source, const File& target, FILE* csv, std::vector<Figure>* all) {
  Avatar avatar;
  std::vector<std::string> warnings;
  if (const Error e = ReadAvatar(target.path, WalkingBy(source), &avatar, &warnings)) {
    std::printf("%-24s -> %-24s %s\n", source.name.c_str(), target.name.c_str(), e.message.c_str());
    return;
  }
  for (const std::string& warning : warnings) {
    if (warning.find("speed cannot be told") != std::string::npos) return;  // no walk
  }
  Rig rig;
  std::string why;
  if (!MakeRig(avatar, {}, &rig, &why)) return;
  const Clip& walk = *FindClip(avatar, "walk");
  const auto beyond_mm = [&](float depth, float own) { return 1000 * std::max(0.0f, depth - own * avatar.height_m); };
  const float values[] = {
      100 * FootSlide(avatar, walk, avatar.walk_speed_mps), 1000 * rig.leg_m * (HipsHeight(rig, walk) - source.hips),
      beyond_mm(Hands(avatar, rig, walk), source.hands), beyond_mm(LegDepth(avatar, rig, walk, kKeys), source.legs),
      PastLimits(rig, walk) * 180 / kPi};
  std::printf("%-24s -> %-24s", source.name.c_str(), target.name.c_str());
  if (csv) std::fprintf(csv, "%s,%s", source.name.c_str(), target.name.c_str());
  for (size_t i = 0; i < all->size(); ++i) {
    Figure& figure = (*all)[i];
    std::printf("  %s %+6.1f %s", figure.what, static_cast<double>(values[i]), figure.unit);
    if (csv) std::fprintf(csv, ",%.2f", static_cast<double>(values[i]));
    figure.values.push_back(std::abs(values[i]));
  }
  std::printf("  %.2f m/s\n", static_cast<double>(avatar.walk_speed_mps));
  if (csv) std::fprintf(csv, ",%.3f\n", static_cast<double>(avatar.walk_speed_mps));
  std::fflush(stdout);
}

int Run(int argc, char** argv) {
  FILE* csv = nullptr;
  if (argc > 2 && std::string(argv[1]) == "--csv") {
    csv = std::fopen(argv[2], "w");
    argc -= 2, argv += 2;
  }
  const std::vector<File> files = OpenAll(argc, argv);
  File shipped;
  shipped.path = ShippedClips();
  std::vector<Walk> walks;
  Walk walk;
  for (const char* clip : {"walk", "walk_stroll", "walk_brisk", "walk_old", "walk_child"}) {
    if (OpenWalk(shipped, clip, &walk)) walks.push_back(walk);
  }
  for (const File& file : files) {
    if (OpenWalk(file, "", &walk)) walks.push_back(walk);
  }
  for (Walk& each : walks) MeasureOwn(&each);
  std::vector<Figure> all{
      {"slide", "%", {}}, {"hips", "mm", {}}, {"hands", "mm", {}}, {"legs", "mm", {}}, {"limits", "deg", {}}};
  for (const Walk& source : walks) {
    for (const File& target : files) {
      if (source.path != target.path) MeasurePair(source, target, csv, &all);
    }
  }
  if (csv) std::fclose(csv);
  for (const Figure& figure : all) {
    std::printf("%s: median %.1f %s, worst %.1f %s of %zu pairs\n", figure.what, Share(figure.values, 0.5f),
                figure.unit, Share(figure.values, 1), figure.unit, figure.values.size());
  }
  return 0;
}

}  // namespace
}  // namespace flaneur

int main(int argc, char** argv) { return flaneur::Run(argc, argv); }
