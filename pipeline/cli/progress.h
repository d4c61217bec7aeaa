// How far a bake is, on stderr: a line for each step that is done, and on a terminal one that is drawn anew, with what
// is being done. Internal to pipeline/cli.
#pragma once
#include <mutex>
#include <string>
#include <vector>

#include "pipeline/cli/bake_steps.h"
#include "runtime/base/jobs.h"

namespace flaneur {

class Progress {
 public:
  // `all_s`: expected of `count` steps together, `at_a_time` of which are done side by side.
  Progress(size_t count, double all_s, size_t at_a_time, bool several_tours);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void Begin(const Step& step);
  void End(const Step& step, double expected_s, bool failed);

 private:
  std::string Left() const;
  void Draw();
  void Erase();
  bool Watch();  // now and then; true: it is over

  const size_t count_, at_a_time_;
  const double all_s_, start_s_;
  const bool terminal_;
  std::mutex mutex_;
  size_t done_ = 0;
  double done_s_ = 0;
  double interrupted_s_ = 0;
  bool over_ = false, drawn_ = false;
  std::vector<const Step*> running_;
  Jobs painter_;
  Job painting_;
};

}  // namespace flaneur
