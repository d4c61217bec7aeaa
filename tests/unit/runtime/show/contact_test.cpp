// Do shadows begin where feet stand? The baked demo tour's own people on level ground, 10 m from the eye.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "runtime/desktop/context.h"
#include "runtime/render/renderer.h"
#include "tests/soak/drivers_stay_loaded.h"
#include "tests/unit/runtime/show/posed_person.h"

namespace flaneur {
namespace {

constexpr int kWidth = 240, kHeight = 280;
constexpr float kDistance_m = 10, kEye_m = 1.6f,
                kSeen_m = 1.2f;  // width of the picture there: half a centimetre a pixel
constexpr float kPixel_m = kSeen_m / kWidth;
constexpr float kSole_m = 0.008f;   // what is no higher than this above a person's lowest point stands on the ground
constexpr float kMaxGap_m = 0.02f;  // between that and the shadow

// A grey plain instead of the town.
void LeaveOnlyGround(TourPack* pack) {
  PackPrimitive p;
  p.material = static_cast<int>(pack->materials.size());
  p.positions = {{-80, 0, -80}, {-80, 0, 80}, {80, 0, 80}, {80, 0, -80}};
  p.normals.assign(4, {0, 1, 0});
  p.indices = {0, 1, 2, 0, 2, 3};
  pack->materials.push_back({"grey", {0.4f, 0.4f, 0.4f, 1}, -1, false, false, 0.5f});
  pack->town = {{"ground", static_cast<int>(pack->meshes.size()), {}}};
  pack->meshes.push_back({{p}});
}

class ContactOfTheDemo : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const std::filesystem::path path =
        std::filesystem::path(FLANEUR_SOURCE_DIR) / "build_assets/wolfenbuettel/wolfenbuettel.glb";
    if (!std::filesystem::exists(path)) return;
    pack_ = std::make_unique<TourPack>();
    ASSERT_EQ(LoadTourPack(path, {}, pack_.get()).message, "");
    LeaveOnlyGround(pack_.get());
  }
  static void TearDownTestSuite() { pack_.reset(); }
  void SetUp() override {
    if (pack_ == nullptr) GTEST_SKIP() << "the demo tour is not baked";
    if (const Error error = context_.Create()) GTEST_SKIP() << error.message;
  }

  std::vector<uint8_t> Draw(const FrameInput& frame, Renderer* renderer) {
    std::vector<uint8_t> rgb;
    FrameStatistics statistics;
    renderer->Draw(frame, kWidth, kHeight, &statistics);
    renderer->Read(&rgb);
    return rgb;
  }

  static std::unique_ptr<TourPack> pack_;
  HeadlessContext context_;
};
std::unique_ptr<TourPack> ContactOfTheDemo::pack_;

// Looking east at somebody's feet, the sun in the south, on the right.
FrameInput LookAtFeet(float sun_elevation_rad) {
  FrameInput frame;
  frame.contact_shade = 0;  // shadows alone
  frame.eye = {0, 0, kEye_m};
  frame.pitch_rad = -std::atan2(kEye_m - 0.4f, kDistance_m);
  frame.fov_rad = 2 * std::atan(kSeen_m / 2 / kDistance_m);
  frame.to_sun = {0, -std::cos(sun_elevation_rad), std::sin(sun_elevation_rad)};
  return frame;
}

constexpr int kRows = 4;  // above and below: as many pixels as may be between

struct Pictures {
  std::vector<uint8_t> empty, alone, whole;  // nobody; somebody without a shadow; with it
};

int Brightness(const std::vector<uint8_t>& rgb, int x, int y) {
  return rgb[static_cast<size_t>(y * kWidth + x) * 3 + 1];
}
bool Differ(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b, int x, int y) {
  const size_t i = static_cast<size_t>(y * kWidth + x) * 3;
  for (size_t k = i; k < i + 3; ++k) {
    if (std::abs(a[k] - b[k]) > 24) return true;
  }
  return false;
}

// The point of a standing sole that lies farthest from the sun, which is in the south.
Vec3 EdgeOfSole(const std::vector<Vec3>& points) {
  const Vec3 lowest = *std::min_element(points.begin(), points.end(), [](Vec3 a, Vec3 b) { return a.z < b.z; });
  Vec3 edge = lowest;
  for (Vec3 p : points) {
    if (p.z < lowest.z + kSole_m && p.y > edge.y) edge = p;
  }
  return edge;
}

// From the edge of a standing sole away from the sun, to the first pixel in shadow, in the row in which that is
// nearest; what the person covers does not count.
float Gap_m(Vec3 sole, const FrameInput& frame, const Pictures& p) {
  const auto is_person = [&](int x, int y) { return Differ(p.empty, p.alone, x, y); };
  int darkest = 255;
  for (int y = kHeight / 2; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (!is_person(x, y)) darkest = std::min(darkest, Brightness(p.whole, x, y));
    }
  }
  const float right = -sole.y / sole.x, up = std::tan(std::atan2(sole.z - kEye_m, sole.x) - frame.pitch_rad);
  const float focal_px = kDistance_m / kPixel_m;
  const int first = kWidth / 2 + static_cast<int>(std::lround(right * focal_px));
  const int row = kHeight / 2 - static_cast<int>(std::lround(up * focal_px));
  int least = kWidth;
  for (int y = row - kRows; y <= row + kRows; ++y) {
    int gap = 0;
    for (int x = first; x > 0; --x) {
      if (is_person(x, y)) continue;
      if (2 * Brightness(p.whole, x, y) < Brightness(p.empty, x, y) + darkest) break;
      ++gap;
    }
    least = std::min(least, gap);
  }
  return static_cast<float>(least) * kPixel_m;
}

TEST_F(ContactOfTheDemo, ShadowsMeetTheFeet) {
  const struct {
    int samples;  // 1: the light in a pass of its own; 4: with the surfaces
    float sun_elevation_deg;
  } cases[] = {{1, 15}, {4, 40}};
  for (const auto& c : cases) {
    Renderer renderer;
    ASSERT_EQ(renderer.Create(*pack_, {.samples = c.samples}).message, "");
    FrameInput frame = LookAtFeet(c.sun_elevation_deg * kPi / 180);
    Pictures pictures;
    pictures.empty = Draw(frame, &renderer);
    for (const bool mesh : {true, false}) {
      float most_m = 0;
      for (size_t a = 0; a < pack_->avatars.size(); ++a) {
        for (const float phase : {-1.0f, 0.3f, 0.7f}) {                            // -1: stands
          const bool walks = pack_->avatars[a].impostor.clips.front().phases > 1;  // else one picture stands for all
          if (!mesh && !walks && phase >= 0) continue;
          DrawnPerson person;
          person.avatar = static_cast<int>(a);
          person.level = mesh ? MeshLevel(0) : kImpostor;
          person.position = {kDistance_m, 0, 0};
          person.heading_rad = phase < 0 ? kPi / 3 : static_cast<float>(a);
          person.moment = {phase < 0 ? ClipKind::kIdle : ClipKind::kWalk, std::max(phase, 0.0f)};
          const Vec3 sole = EdgeOfSole(PosedPerson(*pack_, person));  // comes into the middle of the picture
          person.position = {2 * kDistance_m - sole.x, -sole.y, 0};
          frame.people = {person};
          pictures.whole = Draw(frame, &renderer);
          frame.people[0].casts_shadow = false;
          pictures.alone = Draw(frame, &renderer);
          const float gap_m = Gap_m(EdgeOfSole(PosedPerson(*pack_, person)), frame, pictures);
          EXPECT_LE(gap_m, kMaxGap_m) << pack_->avatars[a].name << (mesh ? ", mesh" : ", impostor") << ", phase "
                                      << phase << ", samples " << c.samples;
          most_m = std::max(most_m, gap_m);
          frame.people.clear();
        }
      }
      std::printf("samples %d, sun %2.0f degrees high, %s: shadow off the foot by %.3f m at most\n", c.samples,
                  c.sun_elevation_deg, mesh ? "meshes" : "impostors", most_m);
    }
  }
}

}  // namespace
}  // namespace flaneur
