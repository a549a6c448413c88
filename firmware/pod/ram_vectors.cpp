#include "firmware/pod/ram_vectors.hpp"

#include <array>
#include <bit>

#include "firmware/hal/registers.hpp"

namespace fw::pod {
namespace {

constexpr std::size_t kEntries = 16 + hw::kIrqCount;
alignas(512) constinit std::array<std::uint32_t,
                                  kEntries> table{};  // VTOR: a power of two above its size

}  // namespace

void move_vectors_to_ram() {
  const auto* from = std::bit_cast<const std::uint32_t*>(hw::SCB::VTOR::read());
  for (std::size_t i = 0; i < kEntries; ++i) table[i] = from[i];
  hw::SCB::VTOR::write(std::bit_cast<std::uint32_t>(table.data()));
  __asm volatile("dsb" ::: "memory");
}

}  // namespace fw::pod
