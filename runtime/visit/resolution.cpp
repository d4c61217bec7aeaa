#include "runtime/visit/resolution.h"

#include <algorithm>
#include <cmath>

#include "runtime/tour_data/settings.h"

namespace flaneur {
namespace {

constexpr float kStep = 0.1f;
constexpr float kMomentStep = 0.1f;
constexpr float kLeastDetail = 0.5f, kDetailStep = 0.1f;
constexpr float kDetailCost = 0.5f;  // of a picture's time, that goes with people's detail: rather too much
constexpr int kSoon = 10;            // pictures that tell that it takes too long
constexpr float kTooLong = 1.05f, kFits = 0.95f, kSpare = 0.9f;  // of the time that a picture may take
constexpr float kPixelCostMargin = 1.25f;                        // what pixels seem to cost, times this
constexpr float kMinPixels = 0.2f;                               // of a picture's time at the least
constexpr float kMinPatience_s = 1, kMaxPatience_s = 30;
constexpr float kTooEarly_s = 10;  // a finer scale that did not last so long was tried too early
constexpr float kFrameTimeSeparation =
    1.2f;  // between this rule's time and that of a budget which follows the frame time

// The time that `share` of the last `count` pictures did not exceed.
float Quantile(const Resolution& r, int count, float share) {
  std::array<float, Resolution::kTimes> sorted{};
  for (int k = 0; k < count; ++k) {
    sorted[static_cast<size_t>(k)] =
        r.took_ms[static_cast<size_t>((r.next + Resolution::kTimes - 1 - k) % Resolution::kTimes)];
  }
  const auto nth = sorted.begin() + static_cast<int>(share * static_cast<float>(count - 1));
  std::nth_element(sorted.begin(), nth, sorted.begin() + count);
  return *nth;
}

float Coarser(float scale, float least) { return std::max(least, std::round((scale - kStep) / kStep) * kStep); }
// From a least scale between two steps to the next step.
float Finer(float scale) { return std::min(1.0f, (std::floor(scale / kStep + 1e-3f) + 1) * kStep); }

// As if the whole picture's time went with its pixels: too little for a coarser scale, too much for a finer one.
float InProportion_ms(float took_ms, float scale, float other) { return took_ms * (other * other) / (scale * scale); }

// What took so long at a scale, at a finer one.
float Finer_ms(float took_ms, const Resolution& r, float scale, float finer) {
  const float most_ms = InProportion_ms(took_ms, scale, finer);
  return r.pixels_ms < 0 ? most_ms : std::min(most_ms, took_ms + r.pixels_ms * (finer * finer - scale * scale));
}

// Coarser at once, finer again step by step.
void FollowMoment(bool moves, float frame_ms, Resolution* r) {
  const float took_ms = r->took_ms[static_cast<size_t>((r->next + Resolution::kTimes - 1) % Resolution::kTimes)];
  const float fits = moves && took_ms > frame_ms ? std::sqrt(frame_ms / took_ms) : 1;
  const float wished = std::max(kMinMotionScale, std::round(fits / kMomentStep) * kMomentStep);
  r->moment = std::min(wished, r->moment + kMomentStep);
}

// By the first pictures at another scale.
void LearnFromChange(float usual_ms, Resolution* r) {
  const float pixels = r->before_scale * r->before_scale - r->scale * r->scale;
  if (r->before_ms <= 0 || pixels == 0) return;
  const float most_ms = usual_ms / (r->scale * r->scale);
  r->pixels_ms = std::clamp(kPixelCostMargin * (r->before_ms - usual_ms) / pixels, kMinPixels * most_ms, most_ms);
}

void Change(float scale, float usual_ms, Resolution* r) {
  const bool rises = scale > r->scale;
  if (!rises && r->rose && r->steady_s < kTooEarly_s) r->patience_s = std::min(2 * r->patience_s, kMaxPatience_s);
  else if (r->steady_s > kMaxPatience_s) r->patience_s = kMinPatience_s;
  r->rose = rises;
  r->before_scale = r->scale;
  r->before_ms = usual_ms;
  r->scale = scale;
  r->steady_s = 0;
  r->times = 0;
}

// The finest scale that fits for sure.
float FinestFor(float took_ms, float frame_ms, const Resolution& r) {
  float scale = r.scale;
  while (scale < 1 && Finer_ms(took_ms, r, r.scale, Finer(scale)) <= kSpare * frame_ms) scale = Finer(scale);
  return scale;
}

// Says nothing about what pixels cost.
void ChangeDetail(float by, float usual_ms, Resolution* r) {
  const float pixels_ms = r->pixels_ms;
  Change(r->scale, usual_ms, r);
  r->pixels_ms = pixels_ms;
  r->detail = std::clamp(r->detail + by, kLeastDetail, 1.0f);
}

}  // namespace

Resolution FirstResolution(const ResolutionSettings& s, bool software) {
  Resolution first;
  if (software) first.scale = s.least_scale;
  return first;
}

float ScaleNow(const ResolutionSettings& s, const Resolution& r) {
  return std::max(std::min(s.least_scale, r.scale), r.scale * r.moment);
}

float DetailNow(const ResolutionSettings& s, const Resolution& r) {
  return r.detail * r.moment * r.scale / ScaleNow(s, r);
}

void FollowPictureTime(float took_ms, bool moves, const ResolutionSettings& s, Resolution* r) {
  took_ms = Finer_ms(took_ms, *r, ScaleNow(s, *r), r->scale);
  r->scale = std::clamp(r->scale, s.least_scale, 1.0f);
  r->took_ms[static_cast<size_t>(r->next)] = took_ms;
  r->next = (r->next + 1) % Resolution::kTimes;
  r->times = std::min(r->times + 1, Resolution::kTimes);
  r->steady_s += took_ms / 1000;
  FollowMoment(moves, s.frame_ms, r);
  if (r->times < kSoon) return;
  const float usual_ms = Quantile(*r, kSoon, 0.5f);
  if (r->times == kSoon) LearnFromChange(usual_ms, r);
  if (usual_ms > kTooLong * s.frame_ms && r->scale > s.least_scale) {
    float scale = Coarser(r->scale, s.least_scale);
    while (scale > s.least_scale && InProportion_ms(usual_ms, r->scale, scale) > kFits * s.frame_ms)
      scale = Coarser(scale, s.least_scale);
    return Change(scale, usual_ms, r);
  }
  if (usual_ms > kTooLong * s.frame_ms && r->detail > kLeastDetail) return ChangeDetail(-kDetailStep, usual_ms, r);
  const bool is_first = r->before_ms <= 0;
  if (is_first && r->times == kSoon) {
    const float finest = FinestFor(Quantile(*r, kSoon, 0.9f), s.frame_ms, *r);
    if (finest > r->scale) return Change(finest, usual_ms, r);
  }
  if (r->detail < 1 && r->times == Resolution::kTimes && r->steady_s >= r->patience_s) {
    const float more = r->detail + kDetailStep, cost = kDetailCost * (more * more / (r->detail * r->detail) - 1);
    if (Quantile(*r, Resolution::kTimes, 0.9f) * (1 + cost) <= kSpare * s.frame_ms)
      ChangeDetail(kDetailStep, usual_ms, r);
    return;
  }
  if (r->scale >= 1 || r->detail < 1 || r->times < Resolution::kTimes || r->steady_s < r->patience_s) return;
  const float finer = Finer(r->scale);
  if (Finer_ms(Quantile(*r, Resolution::kTimes, 0.9f), *r, r->scale, finer) <= kSpare * s.frame_ms)
    Change(finer, usual_ms, r);
}

ResolutionSettings ResolutionFor(float frames_per_s, float least_scale, const ControlSettings& control) {
  float frame_ms = 1000 / frames_per_s;
  const float apart = frame_ms / control.target_ms;
  if (control.method == LimitMethod::kFrameTime && apart > 1 / kFrameTimeSeparation && apart < kFrameTimeSeparation)
    frame_ms = kFrameTimeSeparation * control.target_ms;
  return {frame_ms, least_scale};
}

}  // namespace flaneur
