// An atlas before it is compressed: what every texel shows, with mip levels. Internal to pipeline/impostor.
#pragma once
#include <array>
#include <filesystem>
#include <vector>

#include "pipeline/core/impostor.h"
#include "runtime/base/error.h"
#include "runtime/base/math.h"

namespace flaneur {

// Means over the covered part of a texel.
struct AtlasTexel {
  float coverage = 0;
  std::array<float, 3>
      albedo{};       // sRGB: averaged as pictures on the screen are, whose samples are mixed as they are shown
  Vec3 normal;        // not normalized; axes as motion_m
  float depth_m = 0;  // towards the camera
  Vec3 motion_m;  // from half a phase before to half a phase after; in the cell's axes: right, up, towards the camera
  std::array<float, 3> tints{};  // how much of it each tint may dye
  Vec3 bend_m;                   // of that way: its ends' middle lies so far beside the surface
};

struct AtlasLevel {
  int width = 0, height = 0;
  std::vector<AtlasTexel> texels;  // rows from the top
};

// One picture's layers as Blender wrote them, into the level from row `first_row` on. Normals, motions and bends are
// still in the avatar's axes. Errors: unreadable file, another width than the level, a missing layer.
Error ReadLayers(const std::filesystem::path& exr, int first_row, AtlasLevel* level);

// Turns normals, motions and bends into each cell's own axes.
void TurnIntoCells(const ImpostorAtlas& atlas, AtlasLevel* level);

// All mip levels down to a texel: means weighted with coverage, so that what is covered keeps its colour however small
// it gets.
std::vector<AtlasLevel> MakeLevels(AtlasLevel finest);

// Texels without coverage take what the next coarser level shows there, so that neither linear filtering nor
// compression mixes in anything that is not the person's. Coverage stays.
void FillGutters(std::vector<AtlasLevel>* levels);

// Stretches the coarser levels' coverage so that in each as large a share of the texels is covered by half as in the
// finest: plain means would let limbs thin out with distance, and shapes that merge grow.
void KeepCoverage(std::vector<AtlasLevel>* levels, int count);

// Share of the texels that are covered at least so far.
double CoveredShare(const AtlasLevel& level, float least);

}  // namespace flaneur
