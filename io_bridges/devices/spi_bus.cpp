#include "io_bridges/devices/spi_bus.hpp"

namespace whirl::io {

void SpiBus::add(SpiTarget& target, Wire& chip_select) {
  seats_.push_back(std::make_unique<Seat>(Seat{&target, &chip_select, !chip_select.level()}));
  Seat* seat = seats_.back().get();
  chip_select.watch([seat](bool level, Nanoseconds now) {
    seat->selected = !level;
    seat->target->select(!level, now);
  });
}

void SpiBus::begin(std::uint8_t mosi, std::uint32_t sck_Hz, int mode, Nanoseconds now) {
  for (const auto& seat : seats_) {
    if (seat->selected) seat->target->begin(mosi, sck_Hz, mode, now);
  }
}

std::uint8_t SpiBus::transfer(std::uint8_t mosi, std::uint32_t sck_Hz, int mode, Nanoseconds now) {
  std::uint8_t miso = 0xFF;
  const Wire* selected = nullptr;
  for (const auto& seat : seats_) {
    if (!seat->selected) {
      seat->target->passed_by(mosi, now);
      continue;
    }
    if (selected != nullptr) {
      ++clashes_;
      if (clash_) clash_(*selected, *seat->chip_select, now);
    }
    selected = seat->chip_select;
    miso &= seat->target->transfer(mosi, sck_Hz, mode, now);
  }
  if (selected != nullptr && faults_ != nullptr) miso = faults_->miso(*selected, miso, now);
  if (log_) log_(selected, mosi, miso, now);
  return miso;
}

}  // namespace whirl::io
