// Long work without the GIL: other Python threads run, Ctrl-C ends it, progress is told.
#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <cstddef>
#include <functional>

namespace pirsim::python {

/// What the work and who waits for it tell each other.
struct Job {
  std::atomic<std::size_t> n_done{0};
  std::atomic<std::size_t> n_all{0};
  std::atomic<bool> stop{false};

  struct Stopped {};
  /// Counts a step. Throws Stopped where the work can't be told otherwise that it is to end.
  void step_or_stop() {
    ++n_done;
    if (stop) throw Stopped{};
  }
};

/// Has `work` done on a thread of its own and waits for it without the GIL, which is held on entry and exit. About ten
/// times a second `progress(n_done, n_all)` is called, if it isn't None, and signals are looked for: an exception in
/// either (KeyboardInterrupt, say) stops the job and is thrown when the work has ended. Throws what `work` throws.
void attend(nanobind::handle progress, const std::function<void(Job&)>& work);

}  // namespace pirsim::python
