#include "runtime/crowd/field_builder.h"

#include <algorithm>

#include "runtime/crowd/constants.h"

namespace flaneur {
namespace {

constexpr size_t kAtOnce = 2;

}  // namespace

void FieldBuilder::Start(const Walkable& w, const Crowd& c, Jobs* jobs, Order* order) {
  if (order->build != nullptr) return;
  order->build =
      std::make_unique<FieldBuild>(FieldBuild{{c.fields[static_cast<size_t>(order->field)].goal, {}}, {}, {}});
  order->job = StartJob(
      jobs, [&w, cells = order->cells_a_step, build = order->build.get()] { return BuildFurther(w, cells, build); });
}

void FieldBuilder::Step(const Walkable& w, Jobs* jobs, Crowd* c) {
  const int64_t takes_steps = 1 + static_cast<int64_t>(w.cost.size()) / kCellsAStep;
  for (int field : c->asked_fields) {
    last_due_step_ = std::max(last_due_step_, c->step) + takes_steps;
    orders_.push_back({field, last_due_step_, 1 + CellsToGoOver(w) / takes_steps, nullptr, {}});
  }
  c->asked_fields.clear();
  for (size_t k = 0; k < std::min(kAtOnce, orders_.size()); ++k) Start(w, *c, jobs, &orders_[k]);
  if (!orders_.empty()) orders_.front().job.Advance();
  while (!orders_.empty() && orders_.front().due_step <= c->step) {
    Order& order = orders_.front();
    Start(w, *c, jobs, &order);
    order.job.Wait();
    c->fields[static_cast<size_t>(order.field)] = std::move(order.build->field);
    orders_.pop_front();
  }
}

}  // namespace flaneur
