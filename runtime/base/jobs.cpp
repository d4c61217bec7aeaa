#include "runtime/base/jobs.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace flaneur {
namespace {

enum class Stage { kWaits, kRuns, kDone };

}  // namespace

// Guards its jobs' states too.
struct Jobs::Impl {
  std::mutex mutex;
  std::condition_variable asked, put_down;  // there is work; some job runs no longer
  std::array<std::deque<std::shared_ptr<Job::State>>, 2>
      queues;  // by urgency; those whom somebody else took stay in, and are passed over
  bool ends = false;
  std::vector<std::thread> threads;

  void Work();
  std::shared_ptr<Job::State> Next();
};

struct Job::State {
  Slice slice;
  std::shared_ptr<Jobs::Impl> jobs;  // null: no threads
  std::atomic<Stage> stage = Stage::kWaits;
  std::atomic<bool> unwanted = false;
  std::exception_ptr failure;

  // One slice by whoever has the job; true: there is none left. What the work holds goes with it.
  bool DoSlice() {
    bool last = true;
    try {
      last = slice();
    } catch (...) {
      failure = std::current_exception();
    }
    if (last) slice = nullptr;
    return last;
  }

  // Has the job, and lets go of it when it is done or nobody wants it; `ends`: or then.
  void Run(const bool* ends) {
    std::unique_lock lock(jobs->mutex);
    for (bool last = false; !last && !unwanted && !(ends != nullptr && *ends);) {
      lock.unlock();
      last = DoSlice();
      lock.lock();
      if (last) stage = Stage::kDone;
    }
    if (stage != Stage::kDone) stage = Stage::kWaits;
    jobs->put_down.notify_all();
  }
};

std::shared_ptr<Job::State> Jobs::Impl::Next() {
  for (auto& queue : queues) {
    while (!queue.empty()) {
      std::shared_ptr<Job::State> job = std::move(queue.front());
      queue.pop_front();
      if (job->stage == Stage::kWaits && !job->unwanted) return job;
    }
  }
  return nullptr;
}

void Jobs::Impl::Work() {
  for (;;) {
    std::shared_ptr<Job::State> job;
    {
      std::unique_lock lock(mutex);
      asked.wait(lock, [&] { return ends || (job = Next()) != nullptr; });
      if (ends) return;
      job->stage = Stage::kRuns;
    }
    job->Run(&ends);
  }
}

Jobs::Jobs(size_t threads) : impl_(std::make_shared<Impl>()) {
  try {
    for (size_t t = 0; t < threads; ++t) impl_->threads.emplace_back([this] { impl_->Work(); });
  } catch (const std::system_error&) {  // the system starts no more: fewer do the same work
  }
}

Jobs::~Jobs() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->ends = true;
    for (auto& queue : impl_->queues) queue.clear();  // who waits for one of them takes it
  }
  impl_->asked.notify_all();
  for (std::thread& thread : impl_->threads) thread.join();
}

size_t Jobs::threads() const { return impl_->threads.size(); }

size_t ThreadsOfThisMachine() { return std::max(2u, std::thread::hardware_concurrency()); }

size_t OtherThreads(int threads) { return (threads > 0 ? static_cast<size_t>(threads) : ThreadsOfThisMachine()) - 1; }

Job StartJob(Jobs* jobs, Slice slice, Urgency urgency) {
  auto state = std::make_shared<Job::State>();
  state->slice = std::move(slice);
  if (jobs != nullptr && jobs->threads() > 0) {
    state->jobs = jobs->impl_;
    const std::lock_guard lock(jobs->impl_->mutex);
    jobs->impl_->queues[static_cast<size_t>(urgency)].push_back(state);
    jobs->impl_->asked.notify_one();
  }
  return Job(std::move(state));
}

Job::Job() = default;
Job::Job(std::shared_ptr<State> state) : state_(std::move(state)) {}
Job::Job(Job&&) noexcept = default;

Job& Job::operator=(Job&& other) noexcept {
  Job old(std::move(*this));
  state_ = std::move(other.state_);
  return *this;
}

Job::~Job() {
  if (state_ == nullptr || state_->jobs == nullptr) return;
  state_->unwanted = true;
  {
    std::unique_lock lock(state_->jobs->mutex);
    state_->jobs->put_down.wait(lock, [&] { return state_->stage != Stage::kRuns; });
  }
  state_->slice = nullptr;  // the queue may hold the state for longer; what the work holds goes now
}

bool Job::Done() const { return state_ == nullptr || state_->stage == Stage::kDone; }

void Job::Advance() {
  if (Done() || state_->jobs != nullptr) return;
  if (state_->DoSlice()) state_->stage = Stage::kDone;
}

void Job::Wait() {
  if (state_ == nullptr) return;
  if (state_->jobs == nullptr) {
    while (!Done()) Advance();
  } else {
    std::unique_lock lock(state_->jobs->mutex);
    state_->jobs->put_down.wait(lock, [&] { return state_->stage != Stage::kRuns; });
    if (state_->stage == Stage::kWaits) {
      state_->stage = Stage::kRuns;
      lock.unlock();
      state_->Run(nullptr);
    }
  }
  if (state_->failure) std::rethrow_exception(state_->failure);
}

void ParallelFor(Jobs* jobs, size_t count, const std::function<void(size_t)>& work) {
  std::atomic<size_t> next{0};
  std::exception_ptr failure;
  size_t failed = count;
  std::mutex failure_mutex;
  const auto run = [&] {
    for (size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(failure_mutex);
        if (i < failed) failure = std::current_exception(), failed = i;
        next = count;  // earlier ones have begun: the first failure of all is found
      }
    }
    return true;
  };
  {
    std::vector<Job> helpers;  // of whom those that have not begun when the caller is done are not needed
    const size_t threads = jobs != nullptr ? jobs->threads() : 0;
    for (size_t t = 1; t < std::min(threads + 1, count); ++t) helpers.push_back(StartJob(jobs, run));
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace flaneur
