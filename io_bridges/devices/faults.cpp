#include "io_bridges/devices/faults.hpp"

namespace whirl::io {
namespace {

struct KindName {
  FaultKind kind;
  const char* name;
};

constexpr KindName kNames[] = {
    {FaultKind::i2c_nack, "i2c_nack"},
    {FaultKind::i2c_stuck_sda, "i2c_stuck_sda"},
    {FaultKind::i2c_stuck_scl, "i2c_stuck_scl"},
    {FaultKind::i2c_flip_bit, "i2c_flip_bit"},
    {FaultKind::i2c_late, "i2c_late"},
    {FaultKind::i2c_silence, "i2c_silence"},
    {FaultKind::spi_frozen, "spi_frozen"},
    {FaultKind::spi_flip, "spi_flip"},
    {FaultKind::spi_silent, "spi_silent"},
    {FaultKind::sensor_frozen, "sensor_frozen"},
    {FaultKind::sensor_offset, "sensor_offset"},
    {FaultKind::sensor_wrong_identity, "sensor_wrong_identity"},
    {FaultKind::sensor_saturated, "sensor_saturated"},
    {FaultKind::uart_loss, "uart_loss"},
    {FaultKind::uart_silence, "uart_silence"},
    {FaultKind::uart_flip, "uart_flip"},
    {FaultKind::supply_dip, "supply_dip"},
    {FaultKind::capture_lost, "capture_lost"},
    {FaultKind::esc_stopped, "esc_stopped"},
    {FaultKind::code_hangs, "code_hangs"},
    {FaultKind::sensor_late, "sensor_late"},
    {FaultKind::reset_pin, "reset_pin"},
    {FaultKind::gnss_jammed, "gnss_jammed"},
    {FaultKind::gnss_spoofed, "gnss_spoofed"},
    {FaultKind::gnss_dropout, "gnss_dropout"},
    {FaultKind::rc_link_lost, "rc_link_lost"},
    {FaultKind::rc_glitch, "rc_glitch"},
    {FaultKind::memory_removed, "memory_removed"},
    {FaultKind::memory_cut, "memory_cut"},
    {FaultKind::memory_write_error, "memory_write_error"},
    {FaultKind::memory_crc_error, "memory_crc_error"},
    {FaultKind::memory_busy, "memory_busy"},
    {FaultKind::sensor_brown_out, "sensor_brown_out"},
    {FaultKind::gnss_brown_out, "gnss_brown_out"},
    {FaultKind::gnss_forgets, "gnss_forgets"},
    {FaultKind::sensor_scale, "sensor_scale"},
    {FaultKind::can_bit_error, "can_bit_error"},
    {FaultKind::can_no_ack, "can_no_ack"},
    {FaultKind::can_lost, "can_lost"},
    {FaultKind::can_late, "can_late"},
    {FaultKind::can_cut, "can_cut"},
    {FaultKind::can_stuck_dominant, "can_stuck_dominant"},
    {FaultKind::can_babble, "can_babble"},
    {FaultKind::capture_frozen, "capture_frozen"},
    {FaultKind::board_unplugged, "board_unplugged"},
    {FaultKind::sensor_drift, "sensor_drift"},
    {FaultKind::winding_short, "winding_short"},
    {FaultKind::capture_moved, "capture_moved"},
    {FaultKind::capture_turned, "capture_turned"},
};

bool matches(int wanted, int here) {
  return wanted == kAnywhere || here == kAnywhere || wanted == here;
}

}  // namespace

std::optional<FaultKind> fault_kind(std::string_view wanted) {
  for (const KindName& entry : kNames) {
    if (wanted == entry.name) return entry.kind;
  }
  return std::nullopt;
}

const char* name(FaultKind kind) {
  for (const KindName& entry : kNames) {
    if (kind == entry.kind) return entry.name;
  }
  return "unknown";
}

void FaultBook::add(const Fault& fault) {
  entries_.push_back({fault});
  for (const auto& listener : added_) listener(fault);
}

const Fault* FaultBook::find(FaultKind kind, int bus, int address, Nanoseconds now,
                             int axis) const {
  for (const Entry& entry : entries_) {
    const Fault& f = entry.fault;
    if (f.kind == kind && f.start_ns <= now && now < f.end_ns && matches(f.bus, bus) &&
        matches(f.address, address) && (axis == kAnywhere || f.axis == axis)) {
      return &f;
    }
  }
  return nullptr;
}

void FaultBook::applied(const Fault& fault, Nanoseconds now) {
  for (Entry& entry : entries_) {
    if (&entry.fault != &fault || entry.applied) continue;
    entry.applied = true;
    if (sink_) sink_(fault.number, now);
  }
}

const Fault* FaultBook::apply(FaultKind kind, int bus, int address, Nanoseconds now, int axis) {
  const Fault* fault = find(kind, bus, address, now, axis);
  if (fault != nullptr) applied(*fault, now);
  return fault;
}

double added_by_faults(FaultBook* book, int bus, int address, Nanoseconds now, int axis) {
  constexpr double kMinute_ns = 60e9;
  double added = 0.0;
  if (const Fault* f = apply(book, FaultKind::sensor_offset, bus, address, now, axis))
    added += f->value;
  if (const Fault* f = apply(book, FaultKind::sensor_drift, bus, address, now, axis)) {
    added += f->value * static_cast<double>(now - f->start_ns) / kMinute_ns;
  }
  return added;
}

std::vector<std::uint32_t> FaultBook::pending() const {
  std::vector<std::uint32_t> numbers;
  for (const Entry& entry : entries_) {
    if (!entry.applied) numbers.push_back(entry.fault.number);
  }
  return numbers;
}

}  // namespace whirl::io
