#include "firmware/pod/escs.hpp"

#include <utility>

#include "firmware/hal/interrupts.hpp"
#include "firmware/pod/pod_pins.hpp"

namespace fw::pod {
namespace {

using BusLock = hal::PriorityLock<kPriorityBus>;
constexpr std::uint8_t kFirst = 0x29;

}  // namespace

constinit std::array<PodEsc, kEscs> escs{PodEsc{kFirst}, PodEsc{kFirst + 1}, PodEsc{kFirst + 2},
                                         PodEsc{kFirst + 3}};

void start_escs() {
  esc_bus_12.start(escs[0], kFirst, escs[1], kFirst + 1);
  esc_bus_34.start(escs[2], kFirst + 2, escs[3], kFirst + 3);
}

void PodEsc::set_status(const whirl::core::EscStatusCounts& status) {
  const BusLock lock;
  part_.set_status(status);
}

std::optional<whirl::core::EscI2c::Write> PodEsc::take_write() {
  const BusLock lock;
  return std::exchange(newest_, std::nullopt);
}

}  // namespace fw::pod
