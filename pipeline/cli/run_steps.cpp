#include "pipeline/cli/run_steps.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <set>

#include "pipeline/cli/progress.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

enum class State { kWaits, kRuns, kDone };

struct Task {
  size_t tour = 0;
  Step* step = nullptr;
  std::vector<size_t> needs;  // tasks
  StepCost cost;
  double urgency_s = 0;  // until the last of all that waits for it could be done
  State state = State::kWaits;
  std::string key = {};  // once it can begin
};

struct Queue {
  std::vector<Task> tasks;
  std::mutex mutex;
  std::condition_variable changed;
  RunLimits limits;
  double memory_mb = 0;  // of those that run
  size_t running = 0;
  std::set<std::string> keys;  // of those that run
};

std::vector<Task> TasksOf(const std::vector<Baking*>& bakings) {
  std::vector<Task> tasks;
  for (size_t tour = 0; tour < bakings.size(); ++tour) {
    const size_t first = tasks.size();
    for (Step& step : bakings[tour]->steps) {
      Task task{tour, &step,
                {},   ExpectedCost(bakings[tour]->store, step),
                0,    step.done || step.left_out ? State::kDone : State::kWaits};
      for (const size_t need : step.needs) task.needs.push_back(first + need);
      tasks.push_back(std::move(task));
    }
  }
  for (size_t i = tasks.size(); i-- > 0;) {  // needs stand before those that need them
    tasks[i].urgency_s += tasks[i].cost.seconds;
    for (const size_t need : tasks[i].needs)
      tasks[need].urgency_s = std::max(tasks[need].urgency_s, tasks[i].urgency_s);
  }
  return tasks;
}

bool IsReady(const Queue& queue, Task* asked) {
  Task& task = *asked;
  if (task.state != State::kWaits) return false;
  const auto done = [&](size_t need) { return queue.tasks[need].state == State::kDone; };
  if (!std::all_of(task.needs.begin(), task.needs.end(), done)) return false;
  if (queue.running > 0 && queue.memory_mb + task.cost.memory_mb > queue.limits.memory_mb) return false;
  if (task.key.empty()) task.key = task.step->key();
  return !queue.keys.contains(task.key);
}

// The most urgent of the first tour that has any; null: none can begin now.
Task* Next(Queue* queue) {
  Task* best = nullptr;
  for (Task& task : queue->tasks) {
    if (best != nullptr && best->tour < task.tour) break;
    if (best != nullptr && best->urgency_s >= task.urgency_s) continue;
    if (IsReady(*queue, &task)) best = &task;
  }
  return best;
}

// For one that begins now: those that no other step wants.
int IdleCores(Queue* queue) {
  const auto ready =
      std::count_if(queue->tasks.begin(), queue->tasks.end(), [&](Task& t) { return IsReady(*queue, &t); });
  const int wanted = static_cast<int>(queue->running) + static_cast<int>(ready);
  return std::max(1, 1 + static_cast<int>(queue->limits.at_a_time) - wanted);
}

void LeaveOut(Queue* queue, size_t tour) {
  for (Task& task : queue->tasks) {
    if (task.tour == tour && task.state == State::kWaits) task.state = State::kDone;
  }
}

bool AllDone(const Queue& queue) {
  return std::all_of(queue.tasks.begin(), queue.tasks.end(), [](const Task& t) { return t.state == State::kDone; });
}

// What a step threw would leave the others waiting for its end.
Error DoStepSafely(const Store& store, Step* step) {
  try {
    return DoStep(store, step);
  } catch (const std::exception& exception) {
    return Fail(step->name() + ": " + exception.what());
  }
}

// What one of several workers does.
void Work(Queue* queue, const std::vector<Baking*>& bakings, Progress* progress, std::vector<Error>* errors) {
  std::unique_lock lock(queue->mutex);
  while (!AllDone(*queue)) {
    Task* task = Next(queue);
    if (task == nullptr) {
      queue->changed.wait(lock);
      continue;
    }
    task->state = State::kRuns;
    queue->keys.insert(task->key);
    queue->memory_mb += task->cost.memory_mb;
    ++queue->running;
    task->step->cores = IdleCores(queue);
    lock.unlock();
    progress->Begin(*task->step);
    Error error = DoStepSafely(bakings[task->tour]->store, task->step);
    progress->End(*task->step, task->cost.seconds, static_cast<bool>(error));
    lock.lock();
    task->state = State::kDone;
    queue->keys.erase(task->key);
    queue->memory_mb -= task->cost.memory_mb;
    --queue->running;
    if (error && !(*errors)[task->tour]) {
      (*errors)[task->tour] = std::move(error);
      LeaveOut(queue, task->tour);
    }
    queue->changed.notify_all();
  }
}

}  // namespace

void RunSteps(const std::vector<Baking*>& bakings, const RunLimits& limits, std::vector<Error>* errors) {
  Queue queue;
  queue.tasks = TasksOf(bakings);
  queue.limits = limits;
  errors->resize(bakings.size());
  double all_s = 0;
  size_t count = 0;
  for (const Task& task : queue.tasks) {
    if (task.state == State::kDone) continue;
    all_s += task.cost.seconds;
    ++count;
  }
  Progress progress(count, all_s, limits.at_a_time, bakings.size() > 1);
  Jobs workers(limits.at_a_time - 1);
  ParallelFor(&workers, limits.at_a_time, [&](size_t) { Work(&queue, bakings, &progress, errors); });
}

}  // namespace flaneur
