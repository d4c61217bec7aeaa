// Work beside the caller's: done once and whole with any number of threads and without, and never longer than its owner
// wants it.
#include "runtime/base/jobs.h"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <stdexcept>
#include <vector>

namespace flaneur {
namespace {

constexpr size_t kThreads[] = {0, 1, 2, 4};

// Counts its slices.
Slice Counting(int slices, std::atomic<int>* done) {
  return [=] { return ++*done >= slices; };
}

TEST(Jobs, WhatIsWaitedForIsDoneOnceAndWhole) {
  for (size_t threads : kThreads) {
    Jobs jobs(threads);
    std::vector<std::atomic<int>> done(200);
    std::vector<Job> all;
    for (auto& d : done) all.push_back(StartJob(&jobs, Counting(5, &d)));
    for (Job& job : all) job.Wait();
    for (size_t k = 0; k < done.size(); ++k) EXPECT_EQ(done[k], 5) << k << " with " << threads << " threads";
    for (const Job& job : all) EXPECT_TRUE(job.Done());
  }
}

TEST(Jobs, WithoutThreadsASliceIsDoneWhereTheOwnerHasTimeForIt) {
  Jobs none(0);
  for (Jobs* jobs : {&none, static_cast<Jobs*>(nullptr)}) {
    std::atomic<int> done{0};
    Job job = StartJob(jobs, Counting(3, &done));
    for (int k = 1; k <= 3; ++k) {
      EXPECT_FALSE(job.Done());
      job.Advance();
      EXPECT_EQ(done, k);
    }
    EXPECT_TRUE(job.Done());
    job.Advance();
    EXPECT_EQ(done, 3);
  }
}

TEST(Jobs, WithThreadsTheOwnerNeedDoNothing) {
  Jobs jobs(1);
  std::latch last(1);
  Job job = StartJob(&jobs, [&, k = 0]() mutable {
    if (++k < 3) return false;
    last.count_down();
    return true;
  });
  last.wait();
  job.Wait();
  EXPECT_TRUE(job.Done());
}

TEST(Jobs, NoneIsDone) {
  Job none;
  EXPECT_TRUE(none.Done());
  none.Advance();
  none.Wait();
}

TEST(Jobs, WhatWorkThrowsIsThrownAtTheOneWhoWaitsForIt) {
  for (size_t threads : kThreads) {
    Jobs jobs(threads);
    std::atomic<int> slices{0};
    Job job = StartJob(&jobs, [&]() -> bool {
      if (++slices == 2) throw std::runtime_error("no ground");
      return false;
    });
    EXPECT_THROW(job.Wait(), std::runtime_error) << threads;
    EXPECT_TRUE(job.Done());
    EXPECT_EQ(slices, 2);
    Job next = StartJob(&jobs, [] { return true; });  // the thread lives on
    next.Wait();
  }
}

// A thread that is kept busy, so that what is started later waits.
struct Busy {
  std::latch begun{1}, may_end{1};
  Job job;
  explicit Busy(Jobs* jobs) {
    job = StartJob(jobs, [this] {
      begun.count_down();
      may_end.wait();
      return true;
    });
    begun.wait();
  }
};

TEST(Jobs, WhatHasNotBegunWhenItsOwnerGoesNeverDoes) {
  Jobs jobs(1);
  Busy busy(&jobs);
  std::atomic<int> done{0};
  const auto held = std::make_shared<int>(0);
  {
    Job job = StartJob(&jobs, [&done, held] { return ++done > 0; });
    EXPECT_EQ(held.use_count(), 2);
  }
  EXPECT_EQ(held.use_count(), 1) << "what the work holds goes with its owner";
  busy.may_end.count_down();
  busy.job.Wait();
  Job after = StartJob(&jobs, [] { return true; });
  after.Wait();
  EXPECT_EQ(done, 0);
}

TEST(Jobs, ASliceThatIsUnderWayWhenItsOwnerGoesIsTheLast) {
  Jobs jobs(2);
  for (int round = 0; round < 200; ++round) {
    std::atomic<int> slices{0};
    std::atomic<bool> alive{true}, seen_dead{false};
    std::latch begun(1);
    {
      Job job = StartJob(&jobs, [&] {
        if (++slices == 1) begun.count_down();
        seen_dead = seen_dead || !alive;
        return false;  // for ever
      });
      begun.wait();
    }
    const int then = slices;
    alive = false;
    EXPECT_EQ(slices, then);
    EXPECT_FALSE(seen_dead);
  }
}

TEST(Jobs, MayGoBeforeTheirWorkWhichIsDoneByWhoWaits) {
  std::atomic<int> endless{0}, waiting{0};
  Job first, second;
  std::latch begun(1);
  {
    Jobs jobs(1);
    first = StartJob(&jobs, [&] {
      if (++endless == 1) begun.count_down();
      return endless > 1000000000;  // not in the life of these jobs
    });
    begun.wait();
    second = StartJob(&jobs, Counting(3, &waiting));
  }
  EXPECT_FALSE(first.Done());
  EXPECT_EQ(waiting, 0);
  second.Wait();
  EXPECT_EQ(waiting, 3);
}

TEST(Jobs, WhatIsAwaitedGoesBeforeWhatIsNot) {
  Jobs jobs(1);
  Busy busy(&jobs);
  std::vector<int> order;
  std::latch both(2);
  const auto note = [&](int which) {
    return [&order, &both, which] {
      order.push_back(which);
      both.count_down();
      return true;
    };
  };
  Job later = StartJob(&jobs, note(1), Urgency::kMeanwhile), sooner = StartJob(&jobs, note(0), Urgency::kAwaited);
  busy.may_end.count_down();
  both.wait();
  EXPECT_EQ(order, (std::vector<int>{0, 1}));
}

TEST(Jobs, WhoWaitsForWorkWithinWorkIsNeverStuck) {
  for (size_t threads : kThreads) {
    Jobs jobs(threads);
    std::atomic<int> done{0};
    ParallelFor(&jobs, 8, [&](size_t) {
      ParallelFor(&jobs, 8, [&](size_t) {
        Job inner = StartJob(&jobs, Counting(1, &done));
        inner.Wait();
      });
    });
    EXPECT_EQ(done, 64) << threads;
  }
}

TEST(ParallelFor, CallsEachOnceWithAnyNumberOfThreads) {
  for (size_t threads : kThreads) {
    Jobs jobs(threads);
    for (size_t count : {0u, 1u, 3u, 1000u}) {
      std::vector<std::atomic<int>> calls(count);
      ParallelFor(&jobs, count, [&](size_t i) { ++calls[i]; });
      for (const auto& c : calls) EXPECT_EQ(c, 1);
    }
  }
}

TEST(ParallelFor, ThrowsTheFirstFailureOfAll) {
  for (size_t threads : kThreads) {
    Jobs jobs(threads);
    std::string first;
    try {
      ParallelFor(&jobs, 100, [](size_t i) {
        if (i % 10 == 3) throw std::runtime_error(std::to_string(i));
      });
    } catch (const std::runtime_error& e) {
      first = e.what();
    }
    EXPECT_EQ(first, "3") << threads;
  }
}

TEST(Blocks, AreEveryElementOnce) {
  for (size_t threads : {0u, 1u, 5u}) {
    Jobs jobs(threads);
    for (size_t count : {size_t{0}, size_t{1}, size_t{7}, size_t{1000}}) {
      std::vector<int> visits(count, 0);
      InBlocks(&jobs, count, 1, [&](size_t first, size_t end) {
        for (size_t k = first; k < end; ++k) ++visits[k];
      });
      EXPECT_EQ(visits, std::vector<int>(count, 1));
    }
  }
}

TEST(Blocks, OfFewAreOneInTheCallersThread) {
  Jobs jobs(3);
  int calls = 0;
  InBlocks(&jobs, 99, 100, [&](size_t first, size_t end) {
    ++calls;
    EXPECT_EQ(end - first, 99u);
  });
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace flaneur
