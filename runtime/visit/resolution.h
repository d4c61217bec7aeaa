// How coarsely the window's picture is drawn, so that pictures come as often as wished. A rule about times alone: it
// has no clock of its own and draws nothing.
#pragma once
#include <array>

namespace flaneur {

struct ControlSettings;

struct ResolutionSettings {
  float frame_ms = 40;       // that a picture may take
  float least_scale = 0.5f;  // of the window's width and height
};

// Scales are 1, 0.9, 0.8 ... down to the least, and behind it shares of people's detail: 1, 0.9 ... 0.5.
struct Resolution {
  float scale = 1;   // that serves for long
  float detail = 1;  // likewise, below 1 only at the least scale
  float moment = 1;  // of both, for the next picture, where the view moves and has become expensive
  static constexpr int kTimes = 30;
  std::array<float, kTimes> took_ms{};    // of the last pictures, as if `moment` had been 1, at this scale, in a ring
  int times = 0, next = 0;                // how many there are; where the next one goes
  float steady_s = 0;                     // at this scale
  float patience_s = 1;                   // before a finer one is tried
  bool rose = false;                      // that was the last change
  float before_scale = 1, before_ms = 0;  // and what pictures took usually until then
  float pixels_ms = -1;  // what all pixels would take at scale 1, by what the last change did; negative: not known
};

// As a visit begins: at the finest scale on a graphics card, at the least where the processor draws. The rule would
// come to that only after ten pictures, each of them long enough to be seen coming.
Resolution FirstResolution(const ResolutionSettings& settings, bool software);

// What the next picture is to be drawn at; never coarser than the least scale.
float ScaleNow(const ResolutionSettings& settings, const Resolution& resolution);
// FrameInput::detail: what the pixels may not give, people's meshes and shadows do.
float DetailNow(const ResolutionSettings& settings, const Resolution& resolution);

// After every picture. took_ms: from its beginning until it was ready to be shown. moves: the view, so that nobody
// looks closely: as soon as a picture took too long the next ones are drawn at down to kMinMotionScale of the scale
// or, from the least scale on, of the detail. A coarser scale is chosen when half of the last pictures took too long,
// and less detail when the least one does not do; a finer one only when nine in ten leave room for the pixels it adds,
// with what these cost rather over- than underestimated: so under the same load it never goes to and fro. Where the
// load itself does, finer scales are waited for longer. The first finer scale is the finest that fits, and soon.
inline constexpr float kMinMotionScale = 0.65f;
void FollowPictureTime(float took_ms, bool moves, const ResolutionSettings& settings, Resolution* resolution);

// What the visitor's settings ask for. A tour whose budget of triangles follows the frame time aims at a time of its
// own: near to that a picture may take a fifth more here, so that the budget settles first and the scale stays.
ResolutionSettings ResolutionFor(float frames_per_s, float least_scale, const ControlSettings& control);

}  // namespace flaneur
