#include "pirsim/core/parallel.hpp"

#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

namespace pirsim::detail {

void ordered_parallel(std::size_t count, unsigned threads,
                      const std::function<std::shared_ptr<void>(std::size_t)>& produce,
                      const std::function<void(void*)>& consume) {
  namespace tbb = oneapi::tbb;
  tbb::task_arena arena(threads == 0 ? tbb::task_arena::automatic : static_cast<int>(threads));
  arena.execute([&] {
    std::size_t next = 0;
    const auto take = [&](tbb::flow_control& control) -> std::size_t {
      if (next == count) {
        control.stop();
        return 0;
      }
      return next++;
    };
    tbb::parallel_pipeline(
        4 * static_cast<std::size_t>(arena.max_concurrency()),
        tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, take) &
            tbb::make_filter<std::size_t, std::shared_ptr<void>>(tbb::filter_mode::parallel, produce) &
            tbb::make_filter<std::shared_ptr<void>, void>(
                tbb::filter_mode::serial_in_order, [&](const std::shared_ptr<void>& result) { consume(result.get()); }));
  });
}

}  // namespace pirsim::detail
