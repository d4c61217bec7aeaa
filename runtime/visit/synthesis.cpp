#include "runtime/visit/synthesis.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "runtime/base/math.h"

namespace flaneur {
namespace {

using Signal = std::vector<float>;
constexpr float kRate = kSynthesisRate_hz, kStep_s = 1 / kRate;

size_t Samples(float seconds) { return static_cast<size_t>(seconds * kRate); }
float Time_s(size_t sample) { return static_cast<float>(sample) * kStep_s; }

struct Chance {
  uint64_t state;
  float Between(float low, float high) {  // SplitMix64
    uint64_t z = (state += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return low + (high - low) * static_cast<float>((z ^ (z >> 31)) >> 40) / 16777216.0f;
  }
  float Noise() { return Between(-1, 1); }
};

// A resonance of two poles.
struct Resonator {
  float a = 0, b = 0, gain = 1, before = 0, long_before = 0;
  void Tune(float center_hz, float width_hz) {
    const float r = std::exp(-kPi * width_hz * kStep_s);
    a = 2 * r * std::cos(2 * kPi * center_hz * kStep_s);
    b = -r * r;
    gain = (1 - r) * 1.5f;
  }
  float operator()(float in) {
    const float out = gain * in + a * before + b * long_before;
    long_before = before;
    before = out;
    return out;
  }
};

struct LowPass {
  float share = 1, value = 0;
  explicit LowPass(float cutoff_hz) : share(1 - std::exp(-2 * kPi * cutoff_hz * kStep_s)) {}
  float operator()(float in) { return value += share * (in - value); }
};

// What is longer than `length` is faded into the beginning, so that the end leads there.
Signal Rounded(Signal s, size_t length) {
  const size_t more = s.size() - length;
  for (size_t i = 0; i < more; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(more);
    s[i] = s[i] * std::sqrt(share) + s[length + i] * std::sqrt(1 - share);
  }
  s.resize(length);
  return s;
}

// Somebody who speaks now and then, too far off to be understood.
void AddVoice(uint64_t seed, Signal* out) {
  Chance chance{seed};
  const float pitch_hz = chance.Between(95, 215), loud = chance.Between(0.5f, 1);
  Resonator low, high;
  float phase = 0;
  for (size_t at = Samples(chance.Between(0, 1.5f)); at < out->size();) {
    const int syllables = static_cast<int>(chance.Between(3, 9));
    for (int k = 0; k < syllables; ++k) {
      const size_t length = Samples(chance.Between(0.12f, 0.26f));
      const float bend = chance.Between(0.9f, 1.12f);
      low.Tune(chance.Between(280, 750), 90);
      high.Tune(chance.Between(900, 2100), 160);
      for (size_t i = 0; i < length && at + i < out->size(); ++i) {
        const float share = static_cast<float>(i) / static_cast<float>(length);
        phase += pitch_hz * (1 + (bend - 1) * share) * kStep_s;
        phase -= std::floor(phase);
        const float source = (1 - 2 * phase) + 0.15f * chance.Noise();
        const float swell = std::sin(kPi * share);
        (*out)[at + i] += loud * swell * swell * (low(source) + 0.5f * high(source));
      }
      at += length;
    }
    at += Samples(chance.Between(0.4f, 2.2f));
  }
}

using Part = std::function<void(Signal*)>;  // of the work on a sound
using Parts = std::vector<Part>;

Parts Murmur() {
  Parts parts{[](Signal* s) { s->assign(Samples(9), 0); }};
  for (uint64_t k = 0; k < 14; ++k) parts.push_back([k](Signal* s) { AddVoice(40 + k, s); });
  parts.push_back([](Signal* s) {
    LowPass walls(1600);
    for (float& value : *s) value = walls(value);
    *s = Rounded(std::move(*s), Samples(8));
  });
  return parts;
}

// Bubbles ring the higher the smaller they get.
void AddBubble(Chance* chance, Signal* s) {
  const size_t at = Samples(chance->Between(0, 5.8f));
  const float hz = chance->Between(500, 2400), loud = chance->Between(0.03f, 0.16f), lives_s = 14 / hz;
  float phase = 0;
  for (size_t i = 0; i < Samples(5 * lives_s) && at + i < s->size(); ++i) {
    phase += hz * (1 + 6 * Time_s(i)) * kStep_s;
    (*s)[at + i] += loud * std::exp(-Time_s(i) / lives_s) * std::sin(2 * kPi * phase);
  }
}

Parts Water() {
  const auto chance = std::make_shared<Chance>(Chance{7});
  Parts parts{[chance](Signal* s) {
    s->assign(Samples(6), 0);
    LowPass hiss(5200), rumble(700);
    for (float& value : *s) {
      const float noise = hiss(chance->Noise());
      value = 0.35f * (noise - rumble(noise));
    }
  }};
  for (int k = 0; k < 13; ++k)
    parts.push_back([chance](Signal* s) {
      for (int bubble = 0; bubble < 20; ++bubble) AddBubble(chance.get(), s);
    });
  parts.push_back([](Signal* s) { *s = Rounded(std::move(*s), Samples(5)); });
  return parts;
}

// Heel and sole on stone.
Signal Footfall(int variant) {
  Signal s(Samples(0.2f), 0);
  Chance chance{static_cast<uint64_t>(100 + variant)};
  const float thump_hz = chance.Between(75, 105), sole_s = chance.Between(0.055f, 0.085f);
  LowPass dull(chance.Between(1300, 2300));
  for (size_t i = 0; i < s.size(); ++i) {
    const float t = Time_s(i);
    const float heel = std::exp(-t / 0.012f), sole = t > sole_s ? 0.5f * std::exp(-(t - sole_s) / 0.02f) : 0;
    const float begins = std::min(1.0f, t / 0.002f);
    s[i] = begins *
           (dull(chance.Noise()) * (heel + sole) + 0.5f * std::exp(-t / 0.03f) * std::sin(2 * kPi * thump_hz * t));
  }
  return s;
}

// A phrase of whistles that glide.
Signal Song(int variant) {
  Chance chance{static_cast<uint64_t>(200 + variant)};
  Signal s(Samples(2.4f), 0);
  const float home_hz = chance.Between(2600, 4200);
  for (float at_s = 0.02f; at_s < 1.9f;) {
    const float lasts_s = chance.Between(0.06f, 0.2f), from = home_hz * chance.Between(0.85f, 1.3f);
    const float to = from * chance.Between(0.75f, 1.35f), trill_hz = chance.Between(0, 45);
    float phase = 0;
    const size_t first = Samples(at_s), length = Samples(lasts_s);
    for (size_t i = 0; i < length && first + i < s.size(); ++i) {
      const float share = static_cast<float>(i) / static_cast<float>(length), swell = std::sin(kPi * share);
      phase += (from + (to - from) * share + 120 * std::sin(2 * kPi * trill_hz * Time_s(i))) * kStep_s;
      s[first + i] += swell * swell * (std::sin(2 * kPi * phase) + 0.12f * std::sin(4 * kPi * phase));
    }
    at_s += lasts_s + chance.Between(0.03f, 0.28f);
  }
  return s;
}

// One stroke: the partials of a bell with its minor third.
Parts Stroke() {
  constexpr float kStrike_hz = 233;
  struct Partial {
    float ratio, loud, lives_s;
  };
  constexpr Partial kPartials[] = {{0.5f, 0.5f, 2.6f}, {1, 0.9f, 1.7f},     {1.2f, 0.8f, 1.4f}, {1.5f, 0.35f, 1.0f},
                                   {2, 0.8f, 0.9f},    {2.67f, 0.3f, 0.5f}, {3, 0.25f, 0.4f},   {4.1f, 0.18f, 0.25f}};
  Parts parts{[](Signal* s) { s->assign(Samples(6), 0); }};
  for (const Partial& p : kPartials) {
    parts.push_back([p](Signal* s) {
      for (size_t i = 0; i < s->size(); ++i)
        (*s)[i] += p.loud * std::exp(-Time_s(i) / p.lives_s) * std::sin(2 * kPi * kStrike_hz * p.ratio * Time_s(i));
    });
  }
  parts.push_back([](Signal* s) {
    for (size_t i = 0; i < s->size(); ++i)
      (*s)[i] *= std::min(1.0f, Time_s(i) / 0.003f) * std::min(1.0f, (Time_s(s->size()) - Time_s(i)) / 0.5f);
  });
  return parts;
}

Parts PartsOf(SoundKind kind, int variant) {
  switch (kind) {
    case SoundKind::kSteps:
      return {[variant](Signal* s) { *s = Footfall(variant); }};
    case SoundKind::kMurmur:
      return Murmur();
    case SoundKind::kWater:
      return Water();
    case SoundKind::kBirds:
      return {[variant](Signal* s) { *s = Song(variant); }};
    case SoundKind::kBell:
      return Stroke();
    case SoundKind::kLoop:
      break;
  }
  return {};
}

std::vector<int16_t> AsSamples(const Signal& signal) {
  constexpr float kPeak = 0.8f;
  float peak = 1e-6f;
  for (float value : signal) peak = std::max(peak, std::abs(value));
  std::vector<int16_t> samples;
  samples.reserve(signal.size());
  for (float value : signal) samples.push_back(static_cast<int16_t>(std::lround(value / peak * kPeak * 32767)));
  return samples;
}

}  // namespace

struct Synthesis::Impl {
  Parts parts;
  size_t done = 0;
  Signal signal;
};

Synthesis::Synthesis(SoundKind kind, int variant) : impl_(new Impl{PartsOf(kind, variant), 0, {}}) {}
Synthesis::Synthesis(Synthesis&&) noexcept = default;
Synthesis& Synthesis::operator=(Synthesis&&) noexcept = default;
Synthesis::~Synthesis() = default;

bool Synthesis::GoOn(std::vector<int16_t>* sound) {
  if (impl_->done < impl_->parts.size()) {
    impl_->parts[impl_->done++](&impl_->signal);
    return false;
  }
  *sound = AsSamples(impl_->signal);
  return true;
}

std::vector<int16_t> Synthesize(SoundKind kind, int variant) {
  Synthesis synthesis(kind, variant);
  std::vector<int16_t> sound;
  while (!synthesis.GoOn(&sound)) {}
  return sound;
}

}  // namespace flaneur
