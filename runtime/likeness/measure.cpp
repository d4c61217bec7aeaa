#include "runtime/likeness/measure.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/render/people_batches.h"

namespace flaneur {
namespace {

// Over the visitor's left shoulder, from the right and high, and low from behind the person.
struct Sun {
  float azimuth_deg, elevation_deg;
};
constexpr std::array<Sun, 3> kSuns = {{{145, 40}, {-80, 60}, {25, 20}}};

Vec3 ToSun(const Sun& sun) {
  const float a = sun.azimuth_deg * kPi / 180, e = sun.elevation_deg * kPi / 180;
  return {std::cos(a) * std::cos(e), std::sin(a) * std::cos(e), std::sin(e)};
}

PortraitMoment MomentOf(const MeasureOptions& o, int avatar, int heading, int phase) {
  PortraitMoment m;
  m.avatar = avatar;
  m.heading_rad = 2 * kPi * (static_cast<float>(heading) + o.between) / static_cast<float>(o.headings);
  const float at = (static_cast<float>(phase) + o.between) / static_cast<float>(o.phases);
  m.moment = {o.clip, at - std::floor(at)};
  return m;
}

void Add(const Likeness& one, LevelLikeness* level) {
  level->mean.delta_e += one.delta_e;
  level->mean.delta_e_whole += one.delta_e_whole;
  level->mean.overlap += one.overlap;
  level->mean.normal_deg += one.normal_deg;
  level->worst.delta_e = std::max(level->worst.delta_e, one.delta_e);
  level->worst.delta_e_whole = std::max(level->worst.delta_e_whole, one.delta_e_whole);
  level->worst.overlap = std::min(level->worst.overlap, one.overlap);
  level->worst.normal_deg = std::max(level->worst.normal_deg, one.normal_deg);
}

void Divide(double count, Likeness* sum) {
  sum->delta_e /= count;
  sum->delta_e_whole /= count;
  sum->overlap /= count;
  sum->normal_deg /= count;
}

LevelLikeness MeasureLevel(const MeasureOptions& o, int avatar, Level level, float person_px, PortraitStudio* studio,
                           std::vector<SheetPair>* row) {
  LevelLikeness out{level, person_px, {}, {}};
  out.worst.overlap = 1;
  const int columns = std::min(o.sheet_columns, o.headings);
  SheetPair pair;
  for (int heading = 0; heading < o.headings; ++heading) {
    const int column = heading * columns / o.headings;
    const bool on_sheet = column == static_cast<int>(row->size());  // one heading a column
    for (int phase = 0; phase < o.phases; ++phase) {
      PortraitMoment moment = MomentOf(o, avatar, heading, phase);
      for (int sun = 0; sun < o.suns; ++sun) {
        moment.to_sun = ToSun(kSuns[static_cast<size_t>(sun)]);
        const auto draw = sun == 0 ? &PortraitStudio::Draw : &PortraitStudio::Relight;
        (studio->*draw)(moment, MeshLevel(0), person_px, &pair.full);
        (studio->*draw)(moment, level, person_px, &pair.other);
        Add(Compare(pair.full, pair.other), &out);
        if (on_sheet && phase == column % o.phases && sun == column % o.suns) row->push_back(pair);
      }
    }
  }
  Divide(static_cast<double>(o.headings * o.phases * o.suns), &out.mean);
  return out;
}

// Who is never seen to walk has one picture of it, and is seen as they stand.
ClipKind ClipSeen(ClipKind wished, const PackAvatar& avatar) {
  const std::vector<int> clips = ImpostorClipsOf(avatar);
  const auto phases = [&](ClipKind kind) {
    const int clip = clips[static_cast<size_t>(kind)];
    return clip < 0 ? 0 : avatar.impostor.clips[static_cast<size_t>(clip)].phases;
  };
  const int walk = phases(ClipKind::kWalk);
  return wished == ClipKind::kWalk && walk <= 1 && phases(ClipKind::kIdle) > walk ? ClipKind::kIdle : wished;
}

}  // namespace

AvatarLikeness Measure(const MeasureOptions& wished, int avatar, PortraitStudio* studio) {
  const PackAvatar& a = studio->pack().avatars[static_cast<size_t>(avatar)];
  MeasureOptions options = wished;
  options.clip = ClipSeen(options.clip, a);
  AvatarLikeness out;
  out.name = a.name;
  for (int level = 1; level <= static_cast<int>(a.levels.size()); ++level) {
    const bool impostor = level == static_cast<int>(a.levels.size());
    const float switch_px =
        impostor ? studio->ImpostorSwitch_px(avatar) : a.levels[static_cast<size_t>(level) - 1].switch_px;
    if (options.impostors_only && !impostor) continue;
    if (!(switch_px >= 1)) continue;  // the level before serves at any distance
    const float person_px = options.person_px > 0 ? options.person_px : switch_px;
    out.sheet.emplace_back();
    out.levels.push_back(
        MeasureLevel(options, avatar, impostor ? kImpostor : MeshLevel(level), person_px, studio, &out.sheet.back()));
  }
  return out;
}

}  // namespace flaneur
