#include "runtime/desktop/title_screen.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/clock.h"
#include "runtime/desktop/icon.h"

namespace flaneur {
namespace {

constexpr int kOwnLogo_px = 512;
constexpr double kPictures_ps = 30;              // more often nobody sees, and loading goes before
constexpr float kFollows_ps = 6;                 // the bar, to the share that is done
constexpr float kBeyond = 0.04f, kBeyond_s = 3;  // of the bar: so far beyond, and how soon

}  // namespace

TitleScreen::TitleScreen(const PackTitle& title, Window* window)
    : window_(window), pictures_(DecodeTitlePage(title.page)) {
  if (pictures_.picture.rgba.empty() && pictures_.logo.rgba.empty())
    pictures_.logo = {kOwnLogo_px, kOwnLogo_px, IconPicture(kOwnLogo_px)};
}

void TitleScreen::Show(float share) {
  const double now_s = Now_s();
  if (shown_s_ > 0 && now_s - shown_s_ < 1 / kPictures_ps) return;
  const auto passed_s = static_cast<float>(shown_s_ > 0 ? std::min(0.2, now_s - shown_s_) : 0);
  shown_s_ = now_s;
  if (share > shown_share_) shown_share_ += (share - shown_share_) * (1 - std::exp(-kFollows_ps * passed_s));
  else shown_share_ += std::max(0.0f, share + kBeyond - shown_share_) * (1 - std::exp(-passed_s / kBeyond_s));
  int width_px = 0, height_px = 0;
  window_->Size(&width_px, &height_px);
  if (width_px <= 0 || height_px <= 0) return;
  if (width_px != width_px_ || height_px != height_px_) {
    width_px_ = width_px;
    height_px_ = height_px;
    view_.SetPicture(LayOutTitlePage(pictures_, width_px, height_px));
  }
  const TitleBar bar;
  view_.Draw({bar.left, bar.right, bar.top, bar.bottom, shown_share_}, width_px, height_px);
  window_->Show();
}

}  // namespace flaneur
