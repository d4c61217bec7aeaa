#include "pipeline/rig/humanoid_shape.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/core/rotation.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr float kAlike = 0.12f;      // how far lengths of a pair may differ, as a share
constexpr float kShortLink = 0.35f;  // of the limb's longest bone: a link to it, no part of it

using Chain = std::vector<int>;

struct Tree {
  const std::vector<Joint>& joints;
  const std::vector<Vec3>& positions;
  std::vector<std::vector<int>> children;
  std::vector<float> reach;  // of a joint: length of the longest chain below it

  float Bone(int child) const { return Length(At(positions, child) - At(positions, At(joints, child).parent)); }

  // The longest chain from a joint outwards.
  Chain Longest(int joint) const {
    Chain chain{joint};
    while (!At(children, chain.back()).empty()) {
      const std::vector<int>& next = At(children, chain.back());
      chain.push_back(*std::max_element(next.begin(), next.end(),
                                        [&](int a, int b) { return Bone(a) + At(reach, a) < Bone(b) + At(reach, b); }));
    }
    return chain;
  }
};

Tree MakeTree(const std::vector<Joint>& joints, const std::vector<Vec3>& positions) {
  Tree tree{joints, positions, std::vector<std::vector<int>>(joints.size()), std::vector<float>(joints.size(), 0.0f)};
  for (int j = Count(joints) - 1; j >= 0; --j) {
    const int parent = At(joints, j).parent;
    if (parent < 0) continue;
    At(tree.children, parent).push_back(j);
    At(tree.reach, parent) = std::max(At(tree.reach, parent), tree.Bone(j) + At(tree.reach, j));
  }
  return tree;
}

struct Pair {
  int at = -1;  // the joint that both hang on
  Chain a, b;
  float length = 0;
};

bool Alike(float a, float b) { return std::abs(a - b) <= kAlike * std::max(a, b) + 1e-6f; }

bool AreAlike(const Tree& tree, const Chain& a, const Chain& b) {
  if (a.size() != b.size() || a.size() < 2) return false;
  for (size_t i = 0; i < a.size(); ++i) {
    if (!Alike(tree.Bone(a[i]), tree.Bone(b[i]))) return false;
  }
  return Length(At(tree.positions, a.back()) - At(tree.positions, b.back())) > 0.05f * tree.reach[0];
}

// The longest pair at each joint.
std::vector<Pair> FindPairs(const Tree& tree) {
  std::vector<Pair> pairs;
  for (int j = 0; j < Count(tree.joints); ++j) {
    const std::vector<int>& children = At(tree.children, j);
    Pair best;
    for (size_t i = 0; i < children.size(); ++i) {
      for (size_t k = i + 1; k < children.size(); ++k) {
        Chain a = tree.Longest(children[i]), b = tree.Longest(children[k]);
        if (!AreAlike(tree, a, b)) continue;
        const float length = tree.reach[static_cast<size_t>(children[i])];
        if (best.at < 0 || length > best.length) best = {j, std::move(a), std::move(b), length};
      }
    }
    if (best.at >= 0) pairs.push_back(std::move(best));
  }
  return pairs;
}

// Where in the chain the limb's upper bone begins: the two longest neighbours are the limb.
size_t UpperOf(const Tree& tree, const Chain& chain) {
  size_t best = 0;
  float longest = 0;
  for (size_t i = 0; i + 2 < chain.size(); ++i) {
    const float both = tree.Bone(chain[i + 1]) + tree.Bone(chain[i + 2]);
    const bool even = std::min(tree.Bone(chain[i + 1]), tree.Bone(chain[i + 2])) > kShortLink * both / 2;
    if (even && both > longest * 1.05f) best = i, longest = both;
  }
  return best;
}

int JointAt(const Chain& chain, size_t i) { return i < chain.size() ? chain[i] : -1; }

void SetLimbs(const Tree& tree, const Pair& legs, const Pair& arms, Humanoid* h) {
  const size_t leg = UpperOf(tree, legs.a), arm = UpperOf(tree, arms.a);
  for (const size_t side : {kLeft, kRight}) {
    const Chain& l = side == kLeft ? legs.a : legs.b;
    const Chain& a = side == kLeft ? arms.a : arms.b;
    h->legs[side] = {JointAt(l, leg), JointAt(l, leg + 1), JointAt(l, leg + 2), JointAt(l, leg + 3)};
    h->arms[side].clavicle = arm > 0 ? a[arm - 1] : -1;
    h->arms[side].upper = JointAt(a, arm);
    h->arms[side].lower = JointAt(a, arm + 1);
    h->arms[side].hand = JointAt(a, arm + 2);
  }
}

// The chain from the chest that goes on upwards.
int FindHead(const Tree& tree, const Pair& arms, Vec3 up) {
  int head = -1;
  float highest = 0;
  for (const int child : At(tree.children, arms.at)) {
    if (child == arms.a.front() || child == arms.b.front()) continue;
    const Chain chain = tree.Longest(child);
    const float rise = Dot(At(tree.positions, chain.back()) - At(tree.positions, arms.at), up);
    if (rise > highest) {
      highest = rise;
      head = chain.size() > 1 ? chain[1] : chain[0];  // a neck, then the head
    }
  }
  return head;
}

}  // namespace

bool FindHumanoidByShape(const std::vector<Joint>& joints, const std::vector<Vec3>& positions, Humanoid* h) {
  if (joints.size() < 6) return false;
  const Tree tree = MakeTree(joints, positions);
  const std::vector<Pair> pairs = FindPairs(tree);
  const Pair *legs = nullptr, *arms = nullptr;
  for (const Pair& lower : pairs) {
    for (const Pair& upper : pairs) {
      if (lower.at == upper.at || !IsBelow(tree.joints, upper.at, lower.at)) continue;
      const bool inside =
          IsBelow(tree.joints, upper.at, lower.a.front()) || IsBelow(tree.joints, upper.at, lower.b.front());
      if (inside) continue;
      if (legs == nullptr || lower.length + upper.length > legs->length + arms->length) legs = &lower, arms = &upper;
    }
  }
  if (legs == nullptr) {  // four legs on a trunk whose root is in its middle
    h->quadruped = true;
    for (const Pair& hind : pairs) {
      for (const Pair& fore : pairs) {
        if (IsBelow(tree.joints, fore.at, hind.at) || IsBelow(tree.joints, hind.at, fore.at)) continue;
        if (legs == nullptr || hind.length + fore.length > legs->length + arms->length) legs = &hind, arms = &fore;
      }
    }
  }
  if (legs == nullptr) return false;
  SetLimbs(tree, *legs, *arms, h);
  const Vec3 hips = At(positions, legs->at),
             feet = (At(positions, legs->a.back()) + At(positions, legs->b.back())) * 0.5f;
  const Vec3 up = Normalized(hips - feet);
  h->head = FindHead(tree, *arms, up);
  // Left is what lies left of +Z until feet or a walk say otherwise.
  h->sides_known = false;
  Vec3 forward{0, 0, 1};
  Vec3 toes;
  for (const HumanoidLeg& leg : h->legs) {
    if (leg.foot >= 0 && leg.toes >= 0) toes = toes + At(positions, leg.toes) - At(positions, leg.foot);
  }
  toes = toes - up * Dot(toes, up);
  if (Length(toes) > 0.05f * legs->length) forward = Normalized(toes), h->sides_known = true;
  const Vec3 left = Cross(up, forward);
  const auto is_right = [&](int a, int b) { return Dot(At(positions, a) - At(positions, b), left) < 0; };
  if (is_right(h->legs[kLeft].upper, h->legs[kRight].upper)) std::swap(h->legs[kLeft], h->legs[kRight]);
  if (is_right(h->arms[kLeft].upper, h->arms[kRight].upper)) std::swap(h->arms[kLeft], h->arms[kRight]);
  return true;
}

}  // namespace flaneur
