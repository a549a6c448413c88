#include "io_bridges/devices/spi_master.hpp"

#include <cmath>
#include <utility>

#include "base/check.hpp"

namespace whirl::io {

SpiMaster::SpiMaster(EventQueue& queue, SpiSlave& slave, Wire& chip_select, int mode)
    : queue_(queue),
      slave_(slave),
      chip_select_(chip_select),
      driver_(chip_select.add_driver("an SPI master")),
      late_phase_((mode & 1) != 0),
      edge_(queue, [this] { edge(); }),
      stop_(queue, [this] { finish(); }) {
  chip_select_.drive(driver_, Drive::high, queue.now());
}

Nanoseconds SpiMaster::at_half_clocks(std::int64_t n) const {
  return first_edge_ns_ + std::llround(static_cast<double>(n) * 0.5e9 / request_.sck_Hz);
}

void SpiMaster::transfer(SpiRequest request, Done done) {
  WHIRL_CHECK(!busy_ && !request.mosi.empty());
  busy_ = true;
  request_ = std::move(request);
  done_ = std::move(done);
  reply_ = {};
  reply_.start_ns = queue_.now();
  first_edge_ns_ = queue_.now() + request_.lead_ns;
  chip_select_.drive(driver_, Drive::low, queue_.now());
  if (!late_phase_) shift_out();
  out_next_ = late_phase_;
  schedule();
}

void SpiMaster::shift_out() {
  const Nanoseconds waited_ns = slave_.shift_out(queue_.now());
  if (reply_.waited_ns.size() < request_.mosi.size()) reply_.waited_ns.push_back(waited_ns);
}

// Sixteen half clocks make a byte; the one that is due belongs to byte miso.size().
void SpiMaster::schedule() {
  const auto byte = static_cast<std::int64_t>(reply_.miso.size());
  const std::int64_t early = late_phase_ ? 0 : 1;
  edge_.at(at_half_clocks(out_next_ ? 16 * byte - early : 16 * byte + 15 - early));
}

void SpiMaster::edge() {
  if (out_next_) {
    shift_out();
    out_next_ = false;
    if (reply_.miso.size() < request_.mosi.size()) schedule();
    return;
  }
  const std::uint8_t mosi = request_.mosi[reply_.miso.size()];
  reply_.miso.push_back(slave_.sampled(mosi, 8, queue_.now()));
  out_next_ = true;
  const bool last = reply_.miso.size() == request_.mosi.size();
  if (!last || !late_phase_) schedule();
  if (!last) return;
  const auto bytes = static_cast<std::int64_t>(request_.mosi.size());
  stop_.at(at_half_clocks(16 * bytes) + request_.tail_ns);
}

void SpiMaster::finish() {
  edge_.cancel();
  reply_.stop_ns = queue_.now();
  chip_select_.drive(driver_, Drive::high, queue_.now());
  busy_ = false;
  done_(reply_);
}

}  // namespace whirl::io
