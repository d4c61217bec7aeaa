#include "runtime/likeness/portraits.h"

#include <cmath>

#include "runtime/render/renderer.h"

namespace flaneur {
namespace {

constexpr float kScreenWidth_px = 1280;
constexpr float kEyeHeight_m = 1.7f;
constexpr float kMargin = 1.5f;  // the picture's height in persons
constexpr int kSamples = 4;

FrameInput FrameOf(const TourPack& pack, const PortraitMoment& m, Level level, float person_px, int size_px) {
  const PackAvatar& avatar = pack.avatars[static_cast<size_t>(m.avatar)];
  const float focal_px = kScreenWidth_px / (2 * std::tan(pack.control.fov_rad / 2));
  const float distance_m = avatar.height_m * focal_px / person_px;
  FrameInput frame;
  frame.contact_shade = 0;  // there is no ground
  frame.eye = {0, 0, kEyeHeight_m};
  frame.pitch_rad = std::atan2(avatar.height_m / 2 - kEyeHeight_m, distance_m);
  frame.fov_rad = 2 * std::atan(static_cast<float>(size_px) / 2 / focal_px);
  frame.to_sun = m.to_sun;
  DrawnPerson person;
  person.avatar = m.avatar;
  person.level = level;
  person.moment = m.moment;
  person.position = {distance_m, 0, 0};
  person.heading_rad = m.heading_rad;
  frame.people = {person};
  return frame;
}

// Means of squares of factor x factor pixels.
std::vector<uint8_t> Reduced(const std::vector<uint8_t>& fine, size_t size_px, size_t factor) {
  std::vector<uint8_t> out(size_px * size_px * 4);
  const size_t area = factor * factor, row = size_px * factor * 4;
  for (size_t i = 0; i < out.size(); ++i) {
    const size_t x = i / 4 % size_px, y = i / 4 / size_px;
    size_t sum = area / 2;
    for (size_t k = 0; k < area; ++k)
      sum += fine[(y * factor + k / factor) * row + (x * factor + k % factor) * 4 + i % 4];
    out[i] = static_cast<uint8_t>(sum / area);
  }
  return out;
}

int PictureSize_px(float person_px) { return 16 * static_cast<int>(std::ceil(person_px * kMargin / 16)); }

}  // namespace

struct PortraitStudio::Impl {
  TourPack pack;
  int supersampling = 1;
  Renderer lit, normals;
  std::vector<uint8_t> fine;

  void Shoot(const FrameInput& frame, int size_px, Renderer* renderer, std::vector<uint8_t>* rgba) {
    FrameStatistics unused;
    renderer->Draw(frame, size_px * supersampling, size_px * supersampling, &unused);
    renderer->ReadWithAlpha(supersampling > 1 ? &fine : rgba);
    if (supersampling > 1) *rgba = Reduced(fine, static_cast<size_t>(size_px), static_cast<size_t>(supersampling));
  }
};

PortraitStudio::PortraitStudio() : impl_(std::make_unique<Impl>()) {}
PortraitStudio::~PortraitStudio() = default;

Error PortraitStudio::Create(TourPack pack, int supersampling, Jobs* jobs) {
  impl_->supersampling = supersampling;
  impl_->pack = std::move(pack);
  impl_->pack.town.clear();
  RenderOptions options;
  options.samples = kSamples;
  options.jobs = jobs;
  if (Error e = impl_->lit.Create(impl_->pack, options)) return e;
  options.normals = true;
  return impl_->normals.Create(impl_->pack, options);
}

void PortraitStudio::Draw(const PortraitMoment& moment, Level level, float person_px, Portrait* portrait) {
  portrait->size_px = PictureSize_px(person_px);
  impl_->Shoot(FrameOf(impl_->pack, moment, level, person_px, portrait->size_px), portrait->size_px, &impl_->normals,
               &portrait->normals);
  Relight(moment, level, person_px, portrait);
}

void PortraitStudio::Relight(const PortraitMoment& moment, Level level, float person_px, Portrait* portrait) {
  impl_->Shoot(FrameOf(impl_->pack, moment, level, person_px, portrait->size_px), portrait->size_px, &impl_->lit,
               &portrait->rgba);
}

const TourPack& PortraitStudio::pack() const { return impl_->pack; }

float PortraitStudio::ImpostorSwitch_px(int avatar) const {
  const PackAvatar& a = impl_->pack.avatars[static_cast<size_t>(avatar)];
  return a.height_m / a.impostor.texel_m;
}

}  // namespace flaneur
