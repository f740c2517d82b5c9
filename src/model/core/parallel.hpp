// The one parallel loop of ensembles: work in any order, results in order, memory bounded.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace pirsim {

namespace detail {
void ordered_parallel(std::size_t count, unsigned threads,
                      const std::function<std::shared_ptr<void>(std::size_t)>& produce,
                      const std::function<void(void*)>& consume, const std::function<bool()>& goes_on);
}  // namespace detail

/// Calls `produce(i)` for i in [0, count) on up to `threads` threads (0: all cores) and hands the results to
/// `consume`, one at a time and in the order of i. At most four results a thread are alive. Where produce(i) or consume
/// throws, all results before i have been consumed and none after it is; the exception is rethrown when every thread
/// has stopped. `goes_on`, if given, is asked before each i: after a false nothing new is begun, and what was begun is
/// finished and consumed.
template <typename Result>
void ordered_parallel(std::size_t count, unsigned threads, const std::function<Result(std::size_t)>& produce,
                      const std::function<void(Result&)>& consume, const std::function<bool()>& goes_on = {}) {
  detail::ordered_parallel(
      count, threads, [&](std::size_t i) { return std::make_shared<Result>(produce(i)); },
      [&](void* result) { consume(*static_cast<Result*>(result)); }, goes_on);
}

}  // namespace pirsim
