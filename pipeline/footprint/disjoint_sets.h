// Which of many things are connected, told pair by pair (union-find).
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace flaneur {

class DisjointSets {
 public:
  explicit DisjointSets(size_t count = 0) {
    for (size_t i = 0; i < count; ++i) Add();
  }
  size_t size() const { return parent_.size(); }
  size_t Add() {
    parent_.push_back(parent_.size());
    return parent_.size() - 1;
  }
  // The first of its set.
  size_t Root(size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void Join(size_t i, size_t j) {
    const size_t a = Root(i), b = Root(j);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<size_t> parent_;
};

}  // namespace flaneur
