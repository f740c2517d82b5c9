#include "attend.hpp"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace pirsim::python {
namespace {

namespace nb = nanobind;

/// Calls a function on a thread; wait_for() tells whether it has ended.
class Worker {
 public:
  explicit Worker(const std::function<void()>& function)
      : thread_([this, &function] {
          try {
            function();
          } catch (...) {
            fault_ = std::current_exception();
          }
          const std::scoped_lock lock(mutex_);
          ended_ = true;
          changed_.notify_one();
        }) {}

  [[nodiscard]] bool wait_for(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, time, [this] { return ended_; });
  }
  /// Of a function that has ended.
  [[nodiscard]] std::exception_ptr fault() {
    thread_.join();
    return fault_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ended_ = false;
  std::exception_ptr fault_;
  std::jthread thread_;
};

/// Tells each number once.
class Teller {
 public:
  explicit Teller(nb::handle progress) : progress_(progress) {}
  void tell(const Job& job) {
    const std::size_t n_done = job.n_done;
    if (progress_.is_none() || n_done == told_) return;
    told_ = n_done;
    progress_(n_done, job.n_all.load());
  }

 private:
  nb::handle progress_;
  std::size_t told_ = 0;
};

}  // namespace

void attend(nb::handle progress, const std::function<void(Job&)>& work) {
  constexpr std::chrono::milliseconds patience(100);
  Job job;
  Teller teller(progress);
  std::exception_ptr python_fault;
  const std::function<void()> function = [&] { work(job); };
  Worker worker(function);
  for (bool ended = false; !ended;) {
    {
      nb::gil_scoped_release release;
      ended = worker.wait_for(patience);
    }
    if (python_fault) continue;
    try {
      if (PyErr_CheckSignals() != 0) throw nb::python_error();
      teller.tell(job);
    } catch (...) {
      python_fault = std::current_exception();
      job.stop = true;
    }
  }
  const std::exception_ptr fault = worker.fault();
  if (python_fault) std::rethrow_exception(python_fault);
  if (fault) std::rethrow_exception(fault);
}

}  // namespace pirsim::python
