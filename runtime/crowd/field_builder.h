// Flow fields, each of which takes as long as several steps, are built beside the steps, so that none of them stands
// still for it.
#pragma once
#include <cstdint>
#include <deque>
#include <memory>

#include "runtime/base/jobs.h"
#include "runtime/crowd/crowd.h"

namespace flaneur {

// A field is taken over in a step that depends on the ground's size and on when it was asked for, never on how fast the
// machine is nor on how many threads it has: the same everywhere. Who is not done by then is waited for. Until then
// people search for their ways themselves. Without threads each step in between does an equal part of it.
class FieldBuilder {
 public:
  // Before every StepCrowd of a crowd with `fields_come_later`; `w` and `jobs` stay where they are as long as this
  // lives.
  void Step(const Walkable& w, Jobs* jobs, Crowd* crowd);

 private:
  struct Order {
    int field = -1;
    int64_t due_step = 0, cells_a_step = 0;
    std::unique_ptr<FieldBuild> build;  // where the job finds it
    Job job;
  };
  static void Start(const Walkable& w, const Crowd& crowd, Jobs* jobs, Order* order);
  std::deque<Order> orders_;  // by due_step
  int64_t last_due_step_ = 0;
};

}  // namespace flaneur
