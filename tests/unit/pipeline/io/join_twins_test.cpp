#include <gtest/gtest.h>

#include "pipeline/io/join_documents.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

// Three bones over one another from `place_m` on, and a skin on them, behind all that the document has.
void AddSkeleton(const std::string& behind_names, float place_m, GltfDocument* document) {
  DocumentSkin skin;
  Mat4 world;
  for (const char* name : {"hips", "chest", "head"}) {
    DocumentNode node;
    node.name = name + behind_names;
    node.parent = skin.joints.empty() ? -1 : skin.joints.back();
    node.translation = {skin.joints.empty() ? place_m : 0, 0.5f, 0};
    node.in_scene = true;
    world = world * LocalMatrix(node);
    skin.joints.push_back(Count(document->nodes));
    skin.inverse_binds.push_back(Inverse(world));
    document->order.push_back(Count(document->nodes));
    document->nodes.push_back(node);
  }
  document->skins.push_back(skin);
}

void AddBone(const std::string& name, int parent, GltfDocument* document) {
  DocumentSkin& skin = document->skins.back();
  DocumentNode node;
  node.name = name;
  node.parent = parent;
  node.in_scene = true;
  skin.joints.push_back(Count(document->nodes));
  skin.inverse_binds.push_back(Inverse(FromTranslationRotationScale({9, 9, 9}, {}, {1, 1, 1})));
  document->order.push_back(Count(document->nodes));
  document->nodes.push_back(node);
}

void ExpectParentsFirst(const GltfDocument& document) {
  std::vector<bool> seen(document.nodes.size(), false);
  for (const int n : document.order) {
    const int parent = At(document.nodes, n).parent;
    EXPECT_TRUE(parent < 0 || At(seen, parent)) << n;
    At(seen, n) = true;
  }
  EXPECT_EQ(document.order.size(), document.nodes.size());
}

using Joints = std::vector<int>;

TEST(JoinTwins, WhatStandsInAnotherGoesWithIt) {
  GltfDocument document;
  AddSkeleton("", 0, &document);
  AddBone("left foot", 0, &document);
  AddBone("right foot", 0, &document);
  AddSkeleton(".001", 0, &document);
  AddBone("skirt", 5, &document);
  JoinTwins(&document);
  EXPECT_EQ(document.skins[0].joints, (Joints{0, 1, 2, 3, 4}));
  EXPECT_EQ(document.skins[1].joints, (Joints{0, 1, 2, 8}));
  EXPECT_EQ(document.nodes[8].parent, 0) << "the skirt hangs on the other's hips";
  EXPECT_TRUE(document.nodes[2].in_scene && document.nodes[8].in_scene && !document.nodes[7].in_scene);
  ExpectParentsFirst(document);
}

TEST(JoinTwins, TheOneThatClipsMoveIsFollowed) {
  GltfDocument document;
  AddSkeleton("", 0, &document);
  AddBone("plume", 2, &document);
  AddSkeleton("", 0, &document);
  DocumentClip clip;
  clip.channels.resize(1);
  clip.channels[0].node = 4;
  document.clips = {clip};
  JoinTwins(&document);
  EXPECT_EQ(document.skins[0].joints, (Joints{4, 5, 6, 3}));
  EXPECT_EQ(document.skins[1].joints, (Joints{4, 5, 6}));
  EXPECT_EQ(document.nodes[3].parent, 6);
  ExpectParentsFirst(document);
}

TEST(JoinTwins, ABoneThatShowsSomethingItselfGoesOnShowingIt) {
  GltfDocument document;
  AddSkeleton("", 0, &document);
  AddBone("plume", 2, &document);
  AddSkeleton("", 0, &document);
  document.nodes[6].mesh = 0;
  JoinTwins(&document);
  EXPECT_TRUE(document.nodes[6].in_scene);
  EXPECT_EQ(document.nodes[6].parent, 2);
  EXPECT_EQ(Length(TransformPoint(LocalMatrix(document.nodes[6]), {})), 0);
  ExpectParentsFirst(document);
}

TEST(JoinTwins, WhoStandsBesideAnotherStaysTwo) {
  GltfDocument document;
  AddSkeleton("", 0, &document);
  AddSkeleton("", 1, &document);
  AddSkeleton("of a horse", 0, &document);
  const GltfDocument before = document;
  JoinTwins(&document);
  for (size_t s = 0; s < document.skins.size(); ++s) EXPECT_EQ(document.skins[s].joints, before.skins[s].joints);
}

TEST(JoinTwins, NoBoneEndsUpBelowItself) {
  GltfDocument document;
  AddSkeleton("", 0, &document);
  AddSkeleton("", 0, &document);
  AddBone("rail", 3, &document);
  document.nodes[0].parent = 6;  // the first stands on a bone of the second
  document.order = {3, 4, 5, 6, 0, 1, 2};
  JoinTwins(&document);
  ExpectParentsFirst(document);
}

TEST(JoinTwins, SkinsWithoutJointsAreNobody) {
  GltfDocument document;
  AddSkeleton("", 0, &document);
  document.skins.resize(3);
  JoinTwins(&document);
  EXPECT_EQ(document.skins[0].joints.size(), 3u);
}

}  // namespace
}  // namespace flaneur
