#include "core/parallel.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

namespace pirsim::detail {
namespace {

namespace tbb = oneapi::tbb;

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

struct Loop {
  std::size_t count;
  const std::function<std::shared_ptr<void>(std::size_t)>& produce;
  const std::function<void(void*)>& consume;
  const std::function<bool()>& goes_on;
  /// Results wait here and not in the pipeline, which forgets those under way when an exception ends it. They are
  /// consumed in order, so the indices alive lie side by side and no two share a slot.
  std::vector<std::shared_ptr<void>> alive;
  std::size_t next = 0;
  std::atomic<unsigned> n_ended{0};

  std::size_t take(tbb::flow_control& control) {
    const Step step(n_ended);
    if (next == count || (goes_on && !goes_on())) {
      control.stop();
      return 0;
    }
    return next++;
  }
  std::size_t make(std::size_t i) {
    const Step step(n_ended);
    alive[i % alive.size()] = produce(i);
    return i;
  }
  void use(std::size_t i) {
    const Step step(n_ended);
    const std::shared_ptr<void> result = std::move(alive[i % alive.size()]);
    consume(result.get());
  }
};

/// What oneTBB calls: a method of the loop. Where the loop is, is read before any step begins, hence unseen by a thread
/// sanitizer.
template <auto method>
struct Call {
  Loop* loop;
  template <typename Argument>
  __attribute__((no_sanitize("thread"))) auto operator()(Argument&& argument) const {
    return (loop->*method)(std::forward<Argument>(argument));
  }
};

}  // namespace

void ordered_parallel(std::size_t count, unsigned threads,
                      const std::function<std::shared_ptr<void>(std::size_t)>& produce,
                      const std::function<void(void*)>& consume, const std::function<bool()>& goes_on) {
  // More than TBB allows would only make it print a warning; the results don't depend on it.
  const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const std::size_t wanted = threads == 0 ? allowed : std::min<std::size_t>(threads, allowed);
  tbb::task_arena arena(static_cast<int>(wanted));
  const auto n_alive = 4 * static_cast<std::size_t>(arena.max_concurrency());
  Loop loop{count, produce, consume, goes_on, std::vector<std::shared_ptr<void>>(n_alive)};
  { const Step before(loop.n_ended); }
  const Step all(loop.n_ended);
  arena.execute([&] {
    using tbb::filter_mode;
    tbb::parallel_pipeline(
        n_alive, tbb::make_filter<void, std::size_t>(filter_mode::serial_in_order, Call<&Loop::take>{&loop}) &
                     tbb::make_filter<std::size_t, std::size_t>(filter_mode::parallel, Call<&Loop::make>{&loop}) &
                     tbb::make_filter<std::size_t, void>(filter_mode::serial_in_order, Call<&Loop::use>{&loop}));
  });
}

}  // namespace pirsim::detail

namespace pirsim {

void without_help(const std::function<void()>& work) { oneapi::tbb::task_arena(1).execute(work); }

}  // namespace pirsim
