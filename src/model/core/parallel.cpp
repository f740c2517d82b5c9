#include "model/core/parallel.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace pirsim::detail {
namespace {

/// Indices are handed out in order, made by whoever is free, and consumed in order by whoever made the next one.
class Loop {
 public:
  Loop(std::size_t count, std::size_t n_alive, const std::function<std::shared_ptr<void>(std::size_t)>& produce,
       const std::function<void(void*)>& consume, const std::function<bool()>& goes_on)
      : count_(count), produce_(produce), consume_(consume), goes_on_(goes_on), slots_(n_alive) {}

  /// What each thread does until nothing is left to begin.
  void work() {
    std::unique_lock lock(mutex_);
    while (begin_next(lock)) {
      const std::size_t i = next_++;
      lock.unlock();
      Slot made = make(i);
      lock.lock();
      slots_[i % slots_.size()] = std::move(made);
      consume_ready(lock);
    }
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  /// A result, or why there is none.
  struct Slot {
    std::shared_ptr<void> result;
    std::exception_ptr error;
    [[nodiscard]] bool is_ready() const noexcept { return result != nullptr || error != nullptr; }
  };

  /// Waits until there is room for one more result; false if none is to be begun.
  bool begin_next(std::unique_lock<std::mutex>& lock) {
    const auto may_go_on = [&] { return ended_ || next_ == count_ || next_ - consumed_ < slots_.size(); };
    // GCC 12's wait() asks for a newer libstdc++ than systems with glibc 2.34 have; wait_for() doesn't.
    while (!changed_.wait_for(lock, std::chrono::minutes(1), may_go_on)) {
    }
    if (ended_ || next_ == count_) return false;
    try {
      if (!goes_on_ || goes_on_()) return true;
      end(nullptr);
    } catch (...) {
      end(std::current_exception());
    }
    return false;
  }

  Slot make(std::size_t i) const {
    try {
      return {produce_(i), nullptr};
    } catch (...) {
      return {nullptr, std::current_exception()};
    }
  }

  void consume_ready(std::unique_lock<std::mutex>& lock) {
    if (consuming_) return;  // whoever is at it sees this one too
    consuming_ = true;
    while (!error_ && slots_[consumed_ % slots_.size()].is_ready()) {
      Slot slot = std::exchange(slots_[consumed_ % slots_.size()], {});
      lock.unlock();
      std::exception_ptr error = slot.error;
      try {
        if (!error) consume_(slot.result.get());
      } catch (...) {
        error = std::current_exception();
      }
      slot.result.reset();
      lock.lock();
      ++consumed_;
      if (error) end(error);
      changed_.notify_all();
    }
    consuming_ = false;
  }

  void end(std::exception_ptr error) {
    ended_ = true;
    if (!error_) error_ = std::move(error);
    changed_.notify_all();
  }

  const std::size_t count_;
  const std::function<std::shared_ptr<void>(std::size_t)>& produce_;
  const std::function<void(void*)>& consume_;
  const std::function<bool()>& goes_on_;
  std::mutex mutex_;  ///< of all that follows
  std::condition_variable changed_;
  std::vector<Slot> slots_;  ///< those alive lie side by side, so that no two share a slot
  std::size_t next_ = 0, consumed_ = 0;
  bool consuming_ = false, ended_ = false;
  std::exception_ptr error_;
};

}  // namespace

void ordered_parallel(std::size_t count, unsigned threads,
                      const std::function<std::shared_ptr<void>(std::size_t)>& produce,
                      const std::function<void(void*)>& consume, const std::function<bool()>& goes_on) {
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  const unsigned n_threads = threads == 0 ? cores : std::min(threads, cores);
  constexpr std::size_t alive_a_thread = 4;
  Loop loop(count, alive_a_thread * n_threads, produce, consume, goes_on);
  {
    std::vector<std::jthread> others;
    try {
      for (unsigned i = 1; i < n_threads; ++i) others.emplace_back([&loop] { loop.work(); });
    } catch (const std::system_error&) {
      // The system gives no more threads: those there are do it.
    }
    loop.work();
  }
  loop.rethrow();
}

}  // namespace pirsim::detail
