#include "firmware/pod/sensors.hpp"

#include "firmware/hal/interrupts.hpp"
#include "firmware/pod/pod_pins.hpp"
#include "firmware/pod/pod_time.hpp"

namespace fw::pod {
namespace {

using BusLock = hal::PriorityLock<kPriorityBus>;
using whirl::core::kNever;
using whirl::core::Ms5611;
constexpr std::int64_t kRead_ns = 1'000'000;  // a read of the six data bytes and some

}  // namespace

constinit PodBarometer barometer;
constinit PodMagnetometer magnetometer;

void start_sensors() {
  magnetometer.power_up();
  sensor_bus.start(barometer, PodBarometer::kAddress, magnetometer,
                   whirl::core::Hmc5883l::kI2c_address);
}

// ---- Barometer

void PodBarometer::set_prom(const Ms5611::Prom& prom) {
  const BusLock lock;
  part_.set_prom(prom);
}

void PodBarometer::set_counts(std::uint8_t quantity, std::uint32_t counts) {
  const BusLock lock;
  counts_[quantity & 1] = counts;
}

void PodBarometer::conversion_begins(Ms5611::Quantity, std::size_t osr, std::int64_t now) {
  const auto& row = Ms5611::kOversampling[osr];
  due_ns_ = now + (row.shortest_ns + row.longest_ns) / 2;
}

void PodBarometer::poll() {
  const BusLock lock;
  if (now_ns() < due_ns_) return;
  due_ns_ = kNever;
  part_.converted(counts_[static_cast<std::size_t>(part_.quantity())], false, 0);
}

void PodBarometer::write(std::uint8_t byte) {
  part_.write(byte, now_ns());
}

// ---- Magnetometer

void PodMagnetometer::power_up() {
  const BusLock lock;
  part_.supply(true, now_ns());
}

void PodMagnetometer::set_counts(const std::array<std::int16_t, 3>& counts) {
  const BusLock lock;
  counts_ = counts;
  fresh_ = true;
  came_ns_ = now_ns();
}

void PodMagnetometer::poll() {
  const BusLock lock;
  const std::int64_t now = now_ns();
  if (!fresh_ || now < due_ns_) return;
  if (part_.locked() && now - came_ns_ < kRead_ns) return;
  fresh_ = false;
  due_ns_ = kNever;  // measuring continuously, the part asks for the next one
  part_.write_begins();
  part_.place(counts_, false, now);
}

void PodMagnetometer::write(std::uint8_t byte) {
  part_.write(byte, now_ns());
}

std::uint8_t PodMagnetometer::read() {
  return part_.read(now_ns());
}

}  // namespace fw::pod
