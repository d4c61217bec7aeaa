#include "runtime/web/page_sound.h"

#include <cmath>

#include "runtime/visit/synthesis.h"

namespace flaneur {
namespace {

nlohmann::json Told(const HeardSound& sound, const Heard& heard) {
  const Vec3 off = sound.place - heard.ear;
  const float cosine = std::cos(heard.yaw_rad), sine = std::sin(heard.yaw_rad);
  return {{"source", sound.source},
          {"recording", sound.recording},
          {"place", {off.x * sine - off.y * cosine, off.z, -(off.x * cosine + off.y * sine)}},
          {"gain", sound.gain},
          {"pitch", sound.pitch}};
}

}  // namespace

void PageSound::Play(std::vector<uint8_t> sound, std::string) {
  spoken_ = std::move(sound);
  ++number_;
  speaks_ = true;
}

void PageSound::Hear(const Heard& heard) {
  constexpr size_t kMostAtOnce = 16;  // nobody asks while the tab is hidden
  heard_ = heard;
  for (const HeardSound& sound : heard.once) {
    if (once_.size() < kMostAtOnce) once_.push_back(sound);
  }
}

nlohmann::json PageSound::Take() {
  nlohmann::json round = nlohmann::json::array(), once = nlohmann::json::array();
  for (const HeardSound& sound : heard_.round) round.push_back(Told(sound, heard_));
  for (const HeardSound& sound : once_) once.push_back(Told(sound, heard_));
  once_.clear();
  return {
      {"spoken", speaks_ ? number_ : 0}, {"paused", paused_}, {"volume", volume_}, {"round", round}, {"once", once}};
}

bool PageSound::IsComputed(size_t recording) const {
  return recording < recordings_.size() && recordings_[recording].file == nullptr;
}

std::span<const uint8_t> PageSound::BytesOf(size_t recording) {
  if (recording >= recordings_.size()) return {};
  const Recording& r = recordings_[recording];
  if (r.file != nullptr) return *r.file;
  Synthesis& synthesis = begun_.try_emplace(recording, r.kind, r.variant).first->second;
  if (!synthesis.GoOn(&computed_)) return {};
  begun_.erase(recording);
  return {reinterpret_cast<const uint8_t*>(computed_.data()), computed_.size() * sizeof computed_[0]};
}

}  // namespace flaneur
