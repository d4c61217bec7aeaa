#include "runtime/visit/fade.h"

#include <imgui.h>

#include <algorithm>

namespace flaneur {
namespace {

constexpr float kBlack_s = 0.25f, kFade_s = 0.6f;
constexpr float kSlowest_s = 0.1f;  // a machine that draws slowly does not skip it

}  // namespace

void BeginFade(Fade* fade) { fade->left_s = kBlack_s + kFade_s; }

void ShowFade(int width_px, int height_px, float passed_s, Fade* fade) {
  if (fade->left_s <= 0) return;
  const float black = std::min(1.0f, fade->left_s / kFade_s);
  fade->left_s -= std::min(passed_s, kSlowest_s);
  ImGui::GetForegroundDrawList()->AddRectFilled({0, 0}, {static_cast<float>(width_px), static_cast<float>(height_px)},
                                                IM_COL32(0, 0, 0, static_cast<int>(255 * black)));
}

}  // namespace flaneur
