// What is chosen for both eyes of a headset holds whatever either of them sees.
#include "runtime/render/eyes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "runtime/base/random.h"

namespace flaneur {
namespace {

// Off its middle, as headsets have it.
Mat4 OffCentre(float left, float right, float lower, float upper) {
  constexpr float kNear_m = 0.1f, kFar_m = 900;
  Mat4 m;
  m.m[0] = {2 / (right - left), 0, 0, 0};
  m.m[1] = {0, 2 / (upper - lower), 0, 0};
  m.m[2] = {(right + left) / (right - left), (upper + lower) / (upper - lower), (kFar_m + kNear_m) / (kNear_m - kFar_m),
            -1};
  m.m[3] = {0, 0, 2 * kFar_m * kNear_m / (kNear_m - kFar_m), 0};
  return m;
}

std::vector<EyePicture> SomeEyes(Random* random) {
  const float yaw = random->Uniform(-kPi, kPi), pitch = random->Uniform(-1.5f, 1.5f), roll = random->Uniform(-1, 1);
  const Vec3 ahead{std::sin(yaw) * std::cos(pitch), std::sin(pitch), -std::cos(yaw) * std::cos(pitch)};
  const Vec3 level = Normalized(Cross(ahead, {0, 1, 0})), above = Cross(level, ahead);
  const Vec3 up = above * std::cos(roll) - level * std::sin(roll), right = Cross(ahead, up);
  const float outer = random->Uniform(0.6f, 1.4f), inner = random->Uniform(0.5f, 1),
              lower = random->Uniform(0.6f, 1.2f);
  const Vec3 head{random->Uniform(-50, 50), 1.7f, random->Uniform(-50, 50)};
  std::vector<EyePicture> eyes;
  for (const float side : {-1.0f, 1.0f}) {
    const Vec3 eye = head + right * (0.033f * side);
    const Mat4 projection = side < 0 ? OffCentre(-outer, inner, -lower, 0.9f) : OffCentre(-inner, outer, -lower, 0.9f);
    eyes.push_back({projection * LookMatrix(eye, ahead, up), eye, 0, 0, 1000, 1100});
  }
  return eyes;
}

bool Shows(const Mat4& view_projection, Vec3 p, float slack) {
  const ClipPoint c = ToClip(view_projection, p);
  return c.w > 0.11f && std::abs(c.x) <= c.w * (1 + slack) && std::abs(c.y) <= c.w * (1 + slack);
}

TEST(Eyes, TogetherSeeWhateverEitherOfThemSees) {
  Random random{4};
  int shown = 0, beside = 0;
  for (int round = 0; round < 3000; ++round) {
    const std::vector<EyePicture> eyes = SomeEyes(&random);
    const EyesTogether all = Together(eyes, 0.1f, 900);
    for (int k = 0; k < 40; ++k) {
      const Vec3 off{random.Uniform(-4, 4), random.Uniform(-4, 4), random.Uniform(-4, 4)};
      const Vec3 p = eyes[0].eye + off * (k % 2 == 0 ? 1 : 20);
      const bool by_eye = Shows(eyes[0].view_projection, p, 0) || Shows(eyes[1].view_projection, p, 0);
      ASSERT_TRUE(!by_eye || Shows(all.view_projection, p, 1e-3f)) << "round " << round;
      shown += by_eye ? 1 : 0;
      beside += by_eye || Shows(all.view_projection, p, 0) ? 0 : 1;
    }
  }
  EXPECT_GT(shown, 5000);
  EXPECT_GT(beside, 30000) << "hardly anything is left out";
}

TEST(Eyes, LevelsGoByTheSizeInAnEyesPicture) {
  const std::vector<EyePicture> eyes{{OffCentre(-1, 1, -1, 1), {}, 0, 0, 1000, 1000}};
  EXPECT_NEAR(Together(eyes, 0.1f, 900).focal_px, 500, 1);
}

}  // namespace
}  // namespace flaneur
