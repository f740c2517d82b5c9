#include "model/core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include "support/catch.hpp"

using namespace pirsim;

namespace {

/// Counts how many of its kind are alive.
struct Counted {
  static inline std::atomic<int> alive{0}, most{0};
  std::size_t number;
  explicit Counted(std::size_t i) : number(i) { count(); }
  Counted(const Counted& other) : number(other.number) { count(); }
  Counted& operator=(const Counted&) = delete;
  ~Counted() { --alive; }

 private:
  static void count() {
    const int now = ++alive;
    int seen = most;
    while (now > seen && !most.compare_exchange_weak(seen, now)) {
    }
  }
};

}  // namespace

TEST_CASE("results come in order and few are alive at a time", "[core]") {
  for (const unsigned threads : {1U, 2U, 5U}) {
    Counted::most = 0;
    std::vector<std::size_t> order;
    ordered_parallel<Counted>(
        1000, threads, [](std::size_t i) { return Counted(i); }, [&](Counted& one) { order.push_back(one.number); });
    REQUIRE(order.size() == 1000);
    CHECK(std::is_sorted(order.begin(), order.end()));
    CHECK(Counted::alive == 0);
    CHECK(Counted::most <= static_cast<int>(5 * threads));  // four wait, one is being copied
  }
}

TEST_CASE("results that wait for a slow one are kept", "[core]") {
  constexpr std::size_t ahead = 6;  // of eight that two threads may have under way
  std::atomic<std::size_t> produced{0};
  std::vector<std::size_t> order;
  ordered_parallel<Counted>(
      100, 2,
      [&](std::size_t i) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);  // on a single core nobody comes
        while (i == 0 && produced < ahead && std::chrono::steady_clock::now() < end) std::this_thread::yield();
        ++produced;
        return Counted(i);
      },
      [&](Counted& one) { order.push_back(one.number); });
  REQUIRE(order.size() == 100);
  for (std::size_t i = 0; i < order.size(); ++i) CHECK(order[i] == i);
}

TEST_CASE("an exception ends a parallel loop and leaves no result behind", "[core]") {
  for (const unsigned threads : {1U, 2U, 5U}) {
    for (const std::size_t fatal : {0U, 3U, 500U}) {
      const auto consume = [&](Counted& one) {
        if (one.number == fatal) throw std::runtime_error("consumed");
      };
      CHECK_THROWS_WITH(ordered_parallel<Counted>(
                            1000, threads, [](std::size_t i) { return Counted(i); }, consume),
                        "consumed");
      CHECK(Counted::alive == 0);
      const auto produce = [&](std::size_t i) {
        if (i == fatal) throw std::runtime_error("produced");
        return Counted(i);
      };
      CHECK_THROWS_WITH(ordered_parallel<Counted>(1000, threads, produce, [](Counted&) {}), "produced");
      CHECK(Counted::alive == 0);
    }
  }
}

TEST_CASE("what comes before a failure in order has been consumed, and nothing after it", "[core]") {
  for (const unsigned threads : {1U, 2U}) {
    std::vector<std::size_t> consumed;
    const auto produce = [](std::size_t i) {
      // The later failure is there first, as a rule.
      if (i == 20) std::this_thread::sleep_for(std::chrono::milliseconds(20));
      if (i == 20 || i == 23) throw std::runtime_error(std::to_string(i));
      return Counted(i);
    };
    CHECK_THROWS_WITH(
        ordered_parallel<Counted>(100, threads, produce, [&](Counted& one) { consumed.push_back(one.number); }), "20");
    CHECK(consumed.size() == 20);
  }
}

TEST_CASE("a loop that is told to stop finishes what it began", "[core]") {
  std::atomic<int> produced{0};
  int consumed = 0;
  ordered_parallel<int>(
      1000, 3,
      [&](std::size_t i) {
        ++produced;
        return static_cast<int>(i);
      },
      [&](int& i) { CHECK(i == consumed++); }, [&] { return produced < 10; });
  CHECK(consumed == produced);
  CHECK(consumed >= 10);
  CHECK(consumed < 1000);
}
