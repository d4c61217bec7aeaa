// What is heard in the town besides words, and where: steps, murmur, birds, bells, water. Knows no loudspeaker.
#pragma once
#include <cstdint>
#include <vector>

#include "runtime/pack/tour_pack.h"
#include "runtime/render/frame.h"
#include "runtime/simulation/simulation.h"
#include "runtime/visit/heard.h"
#include "runtime/visit/hotspots.h"
#include "runtime/visit/synthesis.h"

namespace flaneur {

struct Soundscape {
  std::vector<SoundPlace> places;        // of the tour, and where birds are by themselves
  std::vector<Recording> recordings;     // by number
  std::vector<int> first_of;             // by place: its recording, or the first of its variants
  std::vector<std::vector<Wall>> walls;  // by place: of large things around it
  std::vector<float> openness;           // by place: 1 in sight, less behind walls; follows slowly
  std::vector<float> next_s;             // by place of birds: until it sings again
  struct Walker {
    int id = -1, steps = 0;
  };
  std::vector<Walker> walkers;  // near
  float walked_m = 0;           // by the visitor
  int own_steps = 0;
  float murmur_gain[3] = {};  // by the direction it comes from
  Vec3 murmur_place[3];
  float hour = -1;        // at the last picture
  float silent_s = 1e6f;  // since a bell struck an hour
  int strokes = 0;        // that a bell has still to strike
  float stroke_s = 0;     // until the next
  float loud = 1;         // of the whole: less while somebody speaks
  uint64_t chance = 1;
  Heard heard;  // of the last picture
};

void PrepareSoundscape(const TourPack& pack, const Walkable& walkable, Soundscape* soundscape);

// Once a picture. frame: the picture's. speaks: words are heard. holds: everything stands still.
void FollowSoundscape(const TourPack& pack, const Simulation& simulation, const FrameInput& frame, float passed_s,
                      bool speaks, bool holds, Soundscape* soundscape);

}  // namespace flaneur
