// All shader programs and all ways to draw. C++ builds them by name; CMake reads this list too, embeds their files and
// has every variant judged by Khronos' compiler. GLSL ES 3.00: the same text runs as WebGL 2.
#pragma once
#include <cstdint>

namespace flaneur {

// CMake reads a program and a mode a line.
// clang-format off
// PROGRAM(name, vertex shader, fragment shader, what is defined in both)
#define FLANEUR_SHADER_PROGRAMS(PROGRAM) \
  PROGRAM(kTown, "town.vert", "surface.frag", "") \
  PROGRAM(kTownMasked, "town.vert", "surface.frag", "MASKED") \
  PROGRAM(kTownShadow, "town.vert", "shadow.frag", "") \
  PROGRAM(kTownShadowMasked, "town.vert", "shadow.frag", "MASKED") \
  PROGRAM(kPerson, "person.vert", "surface.frag", "PERSON TINTS") \
  PROGRAM(kPersonFades, "person.vert", "surface.frag", "PERSON TINTS FADES") \
  PROGRAM(kPersonMasked, "person.vert", "surface.frag", "PERSON TINTS MASKED") \
  PROGRAM(kPersonMaskedFades, "person.vert", "surface.frag", "PERSON TINTS MASKED FADES") \
  PROGRAM(kPersonShadow, "person.vert", "shadow.frag", "SHADOW") \
  PROGRAM(kPersonImpostor, "impostor.vert", "impostor.frag", "PERSON") \
  PROGRAM(kSky, "sky.vert", "sky.frag", "") \
  PROGRAM(kLight, "light.vert", "light.frag", "") \
  PROGRAM(kSmooth, "whole.vert", "smooth.frag", "") \
  PROGRAM(kSharpen, "whole.vert", "smooth.frag", "SHARPEN") \
  PROGRAM(kEnlarge, "enlarge.vert", "enlarge.frag", "") \
  PROGRAM(kCaption, "whole.vert", "caption.frag", "") \
  PROGRAM(kContactShade, "contact_shade.vert", "contact_shade.frag", "") \
  PROGRAM(kWallShade, "wall_shade.vert", "wall_shade.frag", "") \
  PROGRAM(kSmoke, "smoke.vert", "smoke.frag", "") \
  PROGRAM(kGroundMark, "ground_mark.vert", "ground_mark.frag", "") \
  PROGRAM(kOverlay, "overlay.vert", "overlay.frag", "")

// MODE(name, what is defined in all programs). Samples: several of each pixel. FAST: for many pictures a second in
// software, which lights a picture's pixels after all surfaces (DEFERRED). AVERAGE: one of several pictures that become
// one. NORMALS: people's normals instead of light.
#define FLANEUR_SHADER_MODES(MODE) \
  MODE(kGpu, "") \
  MODE(kGpuSamples, "SMOOTH_EDGES") \
  MODE(kGpuNormals, "NORMALS") \
  MODE(kSoftware, "ONE_SHADOW_TAP FAST DEFERRED") \
  MODE(kSoftwareSamples, "ONE_SHADOW_TAP SMOOTH_EDGES") \
  MODE(kSoftwareAverage, "ONE_SHADOW_TAP DEFERRED AVERAGE") \
  MODE(kSoftwareNormals, "ONE_SHADOW_TAP FAST NORMALS") \
  MODE(kSoftwareSamplesNormals, "ONE_SHADOW_TAP NORMALS")

// clang-format on

enum class ShaderProgram : uint8_t {
#define PROGRAM(name, vertex, fragment, defines) name,
  FLANEUR_SHADER_PROGRAMS(PROGRAM)
#undef PROGRAM
};

enum class ShaderMode : uint8_t {
#define MODE(name, defines) name,
  FLANEUR_SHADER_MODES(MODE)
#undef MODE
};

}  // namespace flaneur
