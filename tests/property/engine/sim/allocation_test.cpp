// Ticks allocate nothing: memory doesn't grow with the number of runs, and threads don't meet in the allocator.
#include <cstdlib>
#include <map>
#include <new>
#include <string>

#include "engine/sim/run_state.hpp"
#include "pirsim/state.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"

namespace {

thread_local std::size_t n_allocations = 0;

void* counted(std::size_t size) {
  ++n_allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++n_allocations;
  return std::malloc(size == 0 ? 1 : size);
}
void* operator new[](std::size_t size, const std::nothrow_t& tag) noexcept { return operator new(size, tag); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

using namespace pirsim;
using namespace pirsim::test;

TEST_CASE("the loop over ticks allocates nothing, apart from the moments when an action begins or ends") {
  const std::vector<std::string> scattered{"trials.for_each.seat=[S4]", "replicates=2",
                                           "people.0.seat_scatter.position_sd_m=0.05"};
  const Model model(compile(shipped_scene("meeting_room.gltf"), shipped_script("studyA.yaml", scattered)));
  for (std::uint32_t run = 0; run < 2; ++run) {
    State state(model, run);
    std::map<std::string, std::size_t> allocating_ticks;
    std::size_t n_ticks = 0;
    while (!state.finished()) {
      const std::size_t before = n_allocations;
      step_tick(model, state);
      const std::size_t after = n_allocations;
      ++n_ticks;
      const std::string phase =
          state.run_state().crowd.actors().empty() ? "" : std::string(state.run_state().crowd.actors().front().phase());
      if (after != before) ++allocating_ticks[phase];
    }
    INFO("run " << run);
    CHECK(n_ticks > 9000);
    CHECK(allocating_ticks["working"] == 0);
    std::size_t all = 0;
    for (const auto& [phase, count] : allocating_ticks) all += count;
    // Ways are searched, tracks begun, action by action: Study A has six actions of a few errands each.
    CHECK(all < 40);
    WARN(all << " of " << n_ticks << " ticks allocate");
  }
}
