// Walks made to fit other skeletons: retarget_bench FILE... takes the walk of each file that has one and makes every
// other file's figure walk by it, and by the clips that come with Flaneur. Prints for each pair the slide of the soles
// (share of the walking speed), the hips' height against the source's (mm), the deepest hand in the body beyond the
// source's own (mm) and the worst bend of a knee the wrong way (degrees); then median and worst of all.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/io/blender_import.h"
#include "pipeline/io/choose_clips.h"
#include "pipeline/io/gltf.h"
#include "pipeline/io/motion_reader.h"
#include "pipeline/rig/clip_loop.h"
#include "pipeline/rig/motion_quality.h"
#include "pipeline/rig/retarget.h"

namespace flaneur {
namespace {

struct Person {
  std::string name;
  std::filesystem::path file;  // glTF, whatever it was
  std::unique_ptr<TemporaryFolder> folder = std::make_unique<TemporaryFolder>();
};

struct Figures {
  std::vector<float> slide, hips_mm, depth_mm, bend_deg;
};

float At_(std::vector<float> values, float share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<size_t>(share * static_cast<float>(values.size() - 1))];
}

Error OpenAll(int argc, char** argv, std::vector<Person>* people) {
  for (int i = 1; i < argc; ++i) {
    Person person;
    person.file = argv[i];
    person.name = person.file.stem().string();
    if (NeedsBlender(person.file)) {
      if (Error e = ConvertToGltf(argv[i], person.folder.get(), &person.file)) return e;
    }
    people->push_back(std::move(person));
  }
  return Ok();
}

// How deep the source's own hands are in it, as a share of its height; 0 where it has no body.
float OwnDepth(const std::filesystem::path& file) {
  Avatar avatar;
  std::vector<std::string> warnings;
  Rig rig;
  std::string why;
  if (ReadAvatar(file, {}, &avatar, &warnings) || !MakeRig(avatar, {}, &rig, &why)) return 0;
  const Clip* walk = FindClip(avatar, "walk");
  return std::max(HandDepth(avatar, rig, *walk, kLeft, 12), HandDepth(avatar, rig, *walk, kRight, 12)) /
         avatar.height_m;
}

bool SourceHips(const std::filesystem::path& file, float* hips) {
  MotionFile motion;
  Rig rig;
  std::string why;
  if (OpenMotion(file, &motion) || !MakeRig(motion.skeleton, motion.told, &rig, &why)) return false;
  for (size_t i = 0; i < motion.clip_names.size(); ++i) {
    std::string name = motion.clip_names[i];
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    if (name.find("walk") == std::string::npos && motion.clip_names.size() > 1) continue;
    Clip clip;
    if (ClipOf(motion, i, &clip)) continue;
    CutToCycle(motion.skeleton.joints, &clip);
    *hips = HipsHeight(rig, clip);
    return true;
  }
  return false;
}

void Measure(const Person& source, float own_depth, float source_hips, const Person& target, Figures* all) {
  ReadAvatarOptions options;
  options.clip_files = {source.file};
  Avatar avatar;
  std::vector<std::string> warnings;
  if (const Error e = ReadAvatar(target.file, options, &avatar, &warnings)) {
    std::printf("%-28s -> %-24s %s\n", source.name.c_str(), target.name.c_str(), e.message.c_str());
    return;
  }
  Rig rig;
  std::string why;
  if (!MakeRig(avatar, {}, &rig, &why)) return;
  const Clip& walk = *FindClip(avatar, "walk");
  const float slide = FootSlide(avatar, walk, avatar.walk_speed_mps);
  const float hips_mm = 1000 * rig.leg_m * (HipsHeight(rig, walk) - source_hips);
  const float depth = std::max(HandDepth(avatar, rig, walk, kLeft, 12), HandDepth(avatar, rig, walk, kRight, 12));
  const float depth_mm = 1000 * std::max(0.0f, depth - own_depth * avatar.height_m);
  const float bend_deg = WrongBend(rig, walk) * 180 / kPi;
  std::printf("%-28s -> %-24s slide %5.1f %%  hips %+6.1f mm  hands %5.1f mm  knees %4.1f deg  %.2f m/s\n",
              source.name.c_str(), target.name.c_str(), 100 * static_cast<double>(slide), static_cast<double>(hips_mm),
              static_cast<double>(depth_mm), static_cast<double>(bend_deg), static_cast<double>(avatar.walk_speed_mps));
  all->slide.push_back(slide);
  all->hips_mm.push_back(std::abs(hips_mm));
  all->depth_mm.push_back(depth_mm);
  all->bend_deg.push_back(bend_deg);
}

int Run(int argc, char** argv) {
  std::vector<Person> people;
  if (const Error e = OpenAll(argc, argv, &people)) return std::fprintf(stderr, "%s\n", e.message.c_str()), 1;
  Person shipped;
  shipped.name = "shipped";
  shipped.file = ShippedClips();
  people.push_back(std::move(shipped));
  Figures all;
  for (const Person& source : people) {
    float hips = 0;
    if (!SourceHips(source.file, &hips)) continue;
    const float own_depth = OwnDepth(source.file);
    for (const Person& target : people) {
      if (&source != &target && target.name != "shipped") Measure(source, own_depth, hips, target, &all);
    }
  }
  const auto print = [](const char* what, const std::vector<float>& values, float scale, const char* unit) {
    std::printf("%s: median %.1f %s, worst %.1f %s of %zu pairs\n", what,
                static_cast<double>(scale * At_(values, 0.5f)), unit, static_cast<double>(scale * At_(values, 1)), unit,
                values.size());
  };
  print("foot slide, share of the walking speed", all.slide, 100, "%");
  print("hips' height off the leg length's", all.hips_mm, 1, "mm");
  print("hands in the body beyond the source's", all.depth_mm, 1, "mm");
  print("knees bent the wrong way", all.bend_deg, 1, "degrees");
  return 0;
}

}  // namespace
}  // namespace flaneur

int main(int argc, char** argv) { return flaneur::Run(argc, argv); }
