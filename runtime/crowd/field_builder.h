// Flow fields, each of which takes as long as several steps, are built beside the steps, so that none of them stands still for it.
#pragma once
#include <cstdint>
#include <deque>
#include <future>

#include "runtime/crowd/crowd.h"

namespace flaneur {

// A field is taken over in a step that depends on the ground's size and on when it was asked for, never on how fast the machine is: the
// same on every machine. A machine that is not done by then waits. Until then people search for their ways themselves.
class FieldBuilder {
 public:
  // Before every StepCrowd of a crowd with `fields_come_later`; `w` stays where it is as long as this lives.
  void Step(const Walkable& w, Crowd* crowd);

 private:
  struct Order { int field = -1; int64_t due_step = 0; std::future<FlowField> built; };
  std::deque<Order> orders_;  // by due_step
  int64_t last_due_step_ = 0;
};

}  // namespace flaneur
