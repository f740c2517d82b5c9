#include "pirsim/core/parallel.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

namespace pirsim::detail {
namespace {

/// While it lives, a step of a loop is under way: it sees whatever was done before any step that has ended, on any
/// thread. oneTBB's pipeline sees to that already, but by means that a thread sanitizer can't follow into a library
/// that wasn't built with it.
class Step {
 public:
  explicit Step(std::atomic<unsigned>& n_ended) : n_ended_(n_ended) { see(); }
  ~Step() {
    see();
    n_ended_.fetch_add(1, std::memory_order_release);
  }
  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;

 private:
  void see() const { (void)n_ended_.load(std::memory_order_acquire); }
  std::atomic<unsigned>& n_ended_;
};

}  // namespace

void ordered_parallel(std::size_t count, unsigned threads,
                      const std::function<std::shared_ptr<void>(std::size_t)>& produce,
                      const std::function<void(void*)>& consume, const std::function<bool()>& goes_on) {
  namespace tbb = oneapi::tbb;
  // More than TBB allows would only make it print a warning; the results don't depend on it.
  const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const std::size_t wanted = threads == 0 ? allowed : std::min<std::size_t>(threads, allowed);
  tbb::task_arena arena(static_cast<int>(wanted));
  std::atomic<unsigned> n_ended{0};
  { const Step before(n_ended); }
  const Step all(n_ended);
  arena.execute([&] {
    std::size_t next = 0;
    const auto take = [&](tbb::flow_control& control) -> std::size_t {
      const Step step(n_ended);
      if (next == count || (goes_on && !goes_on())) {
        control.stop();
        return 0;
      }
      return next++;
    };
    // Results wait here and not in the pipeline, which forgets those under way when an exception ends it. They are
    // consumed in order, so the indices alive lie side by side and no two share a slot.
    const std::size_t n_alive = 4 * static_cast<std::size_t>(arena.max_concurrency());
    std::vector<std::shared_ptr<void>> alive(n_alive);
    const auto make = [&](std::size_t i) {
      const Step step(n_ended);
      alive[i % n_alive] = produce(i);
      return i;
    };
    const auto use = [&](std::size_t i) {
      const Step step(n_ended);
      const std::shared_ptr<void> result = std::move(alive[i % n_alive]);
      consume(result.get());
    };
    const Step pipeline(n_ended);  // ends before what is left in `alive` is freed
    tbb::parallel_pipeline(n_alive, tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, take) &
                                        tbb::make_filter<std::size_t, std::size_t>(tbb::filter_mode::parallel, make) &
                                        tbb::make_filter<std::size_t, void>(tbb::filter_mode::serial_in_order, use));
  });
}

}  // namespace pirsim::detail
