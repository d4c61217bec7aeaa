// Work beside the caller's: the one place where threads come from. Whoever runs the program gives a Jobs, and says how
// many threads it has. None is as good: then the work is done in the caller's thread, slice by slice, where its owner
// has time for it. What comes out must not depend on that.
//
// Wherever a Jobs* is asked for, null means the same as one without threads.
#pragma once
#include <cstddef>
#include <functional>
#include <memory>

namespace flaneur {

// Does the next part of some work; true: that was the last.
using Slice = std::function<bool()>;

// Which of those that wait begins first; of the same urgency the eldest.
enum class Urgency { kAwaited, kMeanwhile };

// Some work, owned by who asked for it. What its slices use must live longer.
class Job {
 public:
  Job();  // none: it is done
  Job(Job&&) noexcept;
  Job& operator=(Job&&) noexcept;
  // What has not begun never will; a slice that is under way is waited for, and is the last.
  ~Job();

  bool Done() const;  // whether it has ended well or by an exception
  // Without threads: does the next slice. With threads: nothing, they do.
  void Advance();
  // Returns when it is done, and does what no thread has begun itself. Throws what a slice has thrown.
  void Wait();

 private:
  friend class Jobs;
  friend Job StartJob(class Jobs*, Slice, Urgency);
  struct State;
  explicit Job(std::shared_ptr<State> state);
  std::shared_ptr<State> state_;
};

class Jobs {
 public:
  // Or as many as the system starts. 0: all work is done where it is waited for
  explicit Jobs(size_t threads);
  // Ends the threads after their present slices. What is left can still be waited for: it is done there.
  ~Jobs();
  Jobs(const Jobs&) = delete;
  Jobs& operator=(const Jobs&) = delete;
  size_t threads() const;

 private:
  friend class Job;
  friend Job StartJob(Jobs*, Slice, Urgency);
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

// As many as there are cores, and two at least: who waits for a file or a device leaves the core to another.
size_t ThreadsOfThisMachine();

// As an option says: so many threads with the caller's, which these are beside; 0 or fewer: as above.
size_t OtherThreads(int threads);

// Has the slices done one after the other, until one is the last.
Job StartJob(Jobs* jobs, Slice slice, Urgency urgency = Urgency::kAwaited);

// Calls work(0) ... work(count - 1), each once, in the caller's thread and all others, in any order; returns when all
// are done. Of exceptions that calls throw, the one of the least index is thrown here again; calls that had not begun
// by then are left out.
void ParallelFor(Jobs* jobs, size_t count, const std::function<void(size_t)>& work);

// Into how many parts `count` elements are best cut for all threads; 1 without threads, or where there are fewer than
// `few`, which are quicker done than shared out.
inline size_t BlocksFor(const Jobs* jobs, size_t count, size_t few) {
  const size_t threads = jobs != nullptr ? jobs->threads() : 0;
  return threads == 0 || count < few ? 1 : 4 * (threads + 1);
}

// The elements 0 .. count - 1 in that many blocks: work(first, end) for each, as ParallelFor does. One block is done
// here, without any allocation.
template <typename Work>
void InBlocks(Jobs* jobs, size_t count, size_t few, const Work& work) {
  const size_t blocks = BlocksFor(jobs, count, few);
  if (blocks == 1) return work(size_t{0}, count);
  ParallelFor(jobs, blocks, [&](size_t b) { work(count * b / blocks, count * (b + 1) / blocks); });
}

}  // namespace flaneur
