// step() may not touch the heap: this program counts every operator new.
#include <cstdlib>
#include <new>

#include "plant/rotor/tests/test_blades.hpp"

namespace {
std::size_t allocations = 0;
}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
  std::abort();
}
void operator delete(void* p) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}

namespace whirl::plant {
namespace {

TEST(Rotor, StepTouchesNoHeap) {
  Rotor rotor(hobbyking(), 1);
  RotorConditions c = hover(4500.0);
  c.v_AP_P_mps = {2.0, 1.0, -1.0};
  const std::size_t before = allocations;
  EXPECT_GT(before, 0u);  // the counter is in place
  double thrust = 0.0;
  for (int i = 0; i < 100; ++i) thrust += rotor.step(c, 1e-3).thrust_N;
  const std::size_t after = allocations;
  EXPECT_EQ(after, before);
  EXPECT_GT(thrust, 0.0);
}

}  // namespace
}  // namespace whirl::plant
