// Which of the people are drawn in one call.
#include <gtest/gtest.h>

#include "runtime/render/people_batches.h"
#include "tests/unit/runtime/render/made_up_tour.h"

namespace flaneur {
namespace {

PeopleSight EverywhereSeen() {
  PeopleSight sight;
  sight.eye = {0, 1.6f, 0};
  sight.to_sun = {0, 1, 0};
  for (Vec4& plane : sight.frustum) plane = {0, 0, 0, 1};
  sight.shadow_reach_m = 40;
  return sight;
}

TEST(PeopleBatches, WhatHasNotComeYetIsDrawnByTheNearestLevelThatHas) {
  const AvatarLayout avatar = LayoutOf(BoxPerson());
  const std::vector<DrawnPerson> people{PersonAt(5, 0, 0), PersonAt(9, 0, -1)};
  const auto levels_with = [&](bool fine, bool coarse, bool impostor) {
    PeopleBatches batches;
    batches.pose_width = 3;
    SortPeople(people, {avatar}, {{{fine, coarse}, impostor, false}}, EverywhereSeen(), &batches);
    std::vector<int> levels;
    for (const PeopleBatch& b : batches.seen) levels.insert(levels.end(), b.count, b.level);
    return levels;
  };
  EXPECT_EQ(levels_with(true, true, true), (std::vector<int>{0, -1}));
  EXPECT_EQ(levels_with(false, true, true), (std::vector<int>{1, -1}));
  EXPECT_EQ(levels_with(false, true, false), (std::vector<int>{1, 1}));
  EXPECT_EQ(levels_with(false, false, true), (std::vector<int>{-1, -1}));
  EXPECT_TRUE(levels_with(false, false, false).empty());
}

TEST(PeopleBatches, InACoarsePictureTheMeshThatServesAtItsSizeIsEnough) {
  AvatarLayout avatar = LayoutOf(BoxPerson());
  avatar.height_m = 1.8f;
  avatar.switch_px = {100, 0};
  const std::vector<DrawnPerson> people{PersonAt(5, 0, 0), PersonAt(9, 0, 1), PersonAt(12, 0, -1)};
  const auto levels_at = [&](float focal_px) {
    PeopleSight sight = EverywhereSeen();
    sight.focal_px = focal_px;
    PeopleBatches batches;
    batches.pose_width = 3;
    SortPeople(people, {avatar}, {{{true, true}, true, false}}, sight, &batches);
    std::vector<int> levels;
    for (const PeopleBatch& b : batches.seen) levels.insert(levels.end(), b.count, b.level);
    return levels;
  };
  EXPECT_EQ(levels_at(0), (std::vector<int>{0, 1, -1}));
  EXPECT_EQ(levels_at(400), (std::vector<int>{0, 1, -1})) << "144 px high";
  EXPECT_EQ(levels_at(200), (std::vector<int>{1, 1, -1})) << "72 px high";
}

TEST(PeopleBatches, ShadowsAreThoseOfWhoCanBeSeenOrTheirShadowAndCoarserBeyondTheFineOnes) {
  OcclusionMap map;
  const Mat4 view = Perspective(1.2f, 16.0f / 9, 0.1f, 500) * LookMatrix({0, 1.6f, 0}, {1, 0, 0}, {0, 1, 0});
  ClearOcclusion(view, &map);
  AddWalls(std::vector<Vec3>{{10, 0, -4}, {10, 0, 4}, {10, 5, 4}, {10, 5, -4}}, std::vector<uint32_t>{0, 1, 2, 0, 2, 3},
           &map);
  FinishOcclusion(&map);
  PeopleSight sight{{0, 1.6f, 0}, {0, 1, 0}, FrustumOf(view), &map, 50, 0, 6};
  PeopleBatches batches;
  batches.pose_width = 3;
  const std::vector<DrawnPerson> people{PersonAt(4, 0, 0), PersonAt(8, 0, 0), PersonAt(14, 0, 0)};
  const auto shadows = [&] {
    SortPeople(people, {LayoutOf(BoxPerson())}, {{{true, true}, true, true}}, sight, &batches);
    std::vector<int> levels;
    for (const PeopleBatch& b : batches.shadows[0]) levels.insert(levels.end(), b.count, b.level);
    return levels;
  };
  EXPECT_EQ(shadows(), (std::vector<int>{0, 1})) << "the third is behind the wall";
  sight.to_sun = Normalized(Vec3{1, 0.3f, 0});
  EXPECT_EQ(shadows(), (std::vector<int>{0, 1, 1})) << "but now throws a shadow before it";
  sight.fine_shadow_m = 12;
  EXPECT_EQ(shadows(), (std::vector<int>{0, 0, 1}));
}

TEST(PeopleBatches, ImpostorsShowTheClipThatThePersonIsIn) {
  PackAvatar avatar = BoxPerson();
  avatar.impostor.directions = 4;
  avatar.impostor.elevations_deg = {0};
  avatar.impostor.clips = {{"walk", 0, 8}, {"idle", 8, 2}};
  const auto frame_of = [&](const ClipMoment& moment, const ClipMoment& other, float other_share) {
    DrawnPerson person = PersonAt(9, 0, -1);
    person.moment = moment;
    person.other = other;
    person.other_share = other_share;
    PeopleBatches batches;
    batches.pose_width = 3;
    SortPeople({person}, {LayoutOf(avatar)}, {{{true, true}, true, true}}, EverywhereSeen(), &batches);
    return static_cast<int>(batches.instances.at(0).look.x) / avatar.impostor.directions;
  };
  const ClipMoment walking{ClipKind::kWalk, 0.25f}, standing{ClipKind::kIdle, 0.5f}, talking{ClipKind::kTalk, 0.5f};
  EXPECT_EQ(frame_of(walking, standing, 0.4f), 2) << "walks on until it stands more than walks";
  EXPECT_EQ(frame_of(walking, standing, 0.6f), 9);
  EXPECT_EQ(frame_of(standing, walking, 0), 9);
  EXPECT_EQ(frame_of(talking, walking, 0), 9) << "talks as it stands";
  avatar.impostor.clips.pop_back();
  EXPECT_EQ(frame_of(standing, walking, 0), 0) << "does not walk on the spot";
}

TEST(PeopleBatches, OnlyTheAvatarsWithMostNearImpostorsHaveDrawsOfTheirOwnForThem) {
  constexpr int kAvatars = 11;
  std::vector<AvatarLayout> avatars(kAvatars, LayoutOf(BoxPerson()));
  const std::vector<AvatarReady> ready(kAvatars, {{true, true}, true, false});
  std::vector<DrawnPerson> people;
  for (int a = 0; a < kAvatars; ++a) {
    for (int k = 0; k <= a + 1; ++k) {
      people.push_back(PersonAt(k < a + 1 ? 9 : 30, static_cast<float>(k) * 0.1f, -1));  // one far, a + 1 near
      people.back().avatar = a;
    }
  }
  PeopleBatches batches;
  batches.pose_width = 3;
  SortPeople(people, avatars, ready, EverywhereSeen(), &batches);
  ASSERT_EQ(batches.seen.size(), static_cast<size_t>(5 + kAvatars));
  size_t drawn = 0;
  for (size_t k = 0; k < batches.seen.size(); ++k) {
    drawn += batches.seen[k].count;
    EXPECT_EQ(batches.seen[k].avatar, static_cast<int>(k < 5 ? k + 6 : k - 5)) << "those of 6 to 10, then all";
  }
  EXPECT_EQ(drawn, people.size());
}

TEST(PeopleBatches, MixedPosesStandBetweenTheirClips) {
  PackAvatar avatar = BoxPerson();
  avatar.idle.matrices[0].m[3] = {0, 1, 0, 1};
  DrawnPerson person = PersonAt(5, 0, 0);
  person.other.clip = ClipKind::kIdle;
  person.other_share = 0.25f;
  PeopleBatches batches;
  batches.pose_width = 3;
  SortPeople({person}, {LayoutOf(avatar)}, {{{true, true}, true, true}}, EverywhereSeen(), &batches);
  ASSERT_EQ(batches.pose_rows, 1u);
  EXPECT_NEAR(batches.poses[1].w, 0.25f, 1e-4f);  // how far up
  EXPECT_NEAR(batches.poses[1].y, 1, 1e-4f);
}

}  // namespace
}  // namespace flaneur
