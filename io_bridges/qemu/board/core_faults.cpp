#include "io_bridges/qemu/board/core_faults.hpp"

#include "io_bridges/devices/faults.hpp"

namespace whirl::board {
namespace {

constexpr double kVdd_V = 3.3;
constexpr std::array<std::uint16_t, 2> kSleep_for_ever{0xBF30,
                                                       0xE7FD};  // WFI, and a branch back to it

}  // namespace

bool CoreFaults::on_fault(const io::FaultCommand& fault) {
  switch (static_cast<io::FaultKind>(fault.kind)) {
    case io::FaultKind::code_hangs:
      hang(fault);
      return true;
    case io::FaultKind::reset_pin:
      pull_reset_pin(fault);
      return true;
    case io::FaultKind::board_unplugged:
      unplug(fault);
      return true;
    default:
      return false;
  }
}

void CoreFaults::hang(const io::FaultCommand& fault) {
  const auto number = static_cast<std::size_t>(fault.address);
  if (number < site_.watch.size()) {
    hangs_.add(fault, site_.image.functions_named(site_.watch[number]));
  }
}

void CoreFaults::applied(std::uint32_t number) {
  site_.happened.add(io::Kind::fault_applied, static_cast<std::uint16_t>(number),
                     site_.events.now(), nullptr, 0);
}

// Devices have no reset line: they keep what they were set to.
void CoreFaults::pull_reset_pin(const io::FaultCommand& fault) {
  const auto pull = [this, number = fault.number] {
    applied(number);
    site_.emulator.reset_core(stm32::ResetCause::pin);
  };
  due_.emplace_back(site_.events, pull).at(fault.start_ns);
}

void CoreFaults::unplug(const io::FaultCommand& fault) {
  const auto out = [this, number = fault.number] {
    applied(number);
    if (unplugged_++ == 0) supply_gone();
  };
  due_.emplace_back(site_.events, out).at(fault.start_ns);
  if (fault.end_ns == io::kNever) return;
  const auto back = [this] {
    if (--unplugged_ == 0) supply_back();
  };
  due_.emplace_back(site_.events, back).at(fault.end_ns);
}

std::uint32_t CoreFaults::first_instruction() const {
  std::uint32_t address = 0;
  site_.emulator.peek(site_.vectors + 4, &address, sizeof address);
  return address & ~1u;
}

void CoreFaults::supply_gone() {
  const std::uint32_t first = first_instruction();
  site_.emulator.peek(first, code_.data(), sizeof code_);
  site_.emulator.write_cells(first, kSleep_for_ever.data(), sizeof kSleep_for_ever);
  site_.set_vdd(0.0);
  site_.emulator.reset_core(stm32::ResetCause::pin);
}

void CoreFaults::supply_back() {
  site_.set_vdd(kVdd_V);
  site_.emulator.write_cells(first_instruction(), code_.data(), sizeof code_);
  site_.emulator.lose_memories();
  site_.emulator.reset_core(stm32::ResetCause::power_on);
}

}  // namespace whirl::board
