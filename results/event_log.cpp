#include "results/event_log.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::results {
namespace {

std::string text_of(std::span<const std::uint8_t> bytes) {
  return {bytes.begin(), bytes.end()};
}

TextRecord finding_of(std::int64_t t_ns, const std::string& text) {
  const auto cut = text.find('\0');
  if (cut == std::string::npos) return {t_ns, "", text};
  return {t_ns, text.substr(0, cut), text.substr(cut + 1)};
}

}  // namespace

void EventLog::add_bus(const io::Reader& reader, bool spi) {
  const auto head = reader.as<io::BusTransaction>();
  bus.push_back({spi, reader.header().port, head.address, head.read != 0, head.acked != 0,
                 head.length, head.start_ns, reader.header().t_ns});
}

// The first message of a pin is the level that it has at the start, and no edge.
void EventLog::add_pin(const io::Header& header, bool level) {
  const auto [before, first] = pin_levels_.try_emplace(header.port, level);
  std::vector<PulseRecord>& all = pulses[header.port];
  if (!first && level && !before->second) all.push_back({header.t_ns, -1});
  if (!level && !all.empty() && all.back().fall_ns < 0) all.back().fall_ns = header.t_ns;
  before->second = level;
}

void EventLog::add_can(const io::Header& header, const io::CanRecord& r) {
  const std::size_t last = std::clamp<std::size_t>(r.frame.length, 1, 8) - 1;
  can.push_back({header.port, r.sender, r.frame.id, (r.frame.flags & 1) != 0, r.error == 0,
                 (r.frame.data[last] & 0x80) != 0, r.busy_ns, r.tec, r.start_ns, header.t_ns});
}

void EventLog::add_latency(const io::Header& header, std::int64_t raised_ns) {
  const double took_ns = static_cast<double>(header.t_ns) - static_cast<double>(raised_ns);
  LatencyRecord& record = latencies[header.port];
  ++record.count;
  record.sum_ns += took_ns;
  if (took_ns <= record.max_ns && record.count > 1) return;
  record.max_ns = took_ns;
  record.max_at_ns = header.t_ns;
}

bool EventLog::add(const io::Batch& batch) {
  io::Reader reader(batch.bytes());
  while (reader.next()) add(reader);
  return reader.complete();
}

void EventLog::add(const io::Reader& reader) {
  const io::Header& header = reader.header();
  switch (header.kind) {
    case io::Kind::i2c_transaction:
      add_bus(reader, false);
      break;
    case io::Kind::spi_transaction:
      add_bus(reader, true);
      break;
    case io::Kind::can_transfer:
      add_can(header, reader.as<io::CanRecord>());
      break;
    case io::Kind::data_ready:
      data_ready_ns[header.port].push_back(header.t_ns);
      break;
    case io::Kind::pin_edge:
      add_pin(header, reader.as<io::PinEdge>().level != 0);
      break;
    case io::Kind::bus_unread: {
      const auto gap = reader.as<io::BusUnread>();
      unread.push_back({gap.spi != 0, header.port, gap.start_ns, header.t_ns});
      break;
    }
    case io::Kind::finding:
      findings.push_back(finding_of(header.t_ns, text_of(reader.payload())));
      break;
    case io::Kind::cpu_fault:
      cpu_faults.push_back({header.t_ns, reader.as<io::CpuFault>(),
                            text_of(reader.tail_after(sizeof(io::CpuFault)))});
      break;
    case io::Kind::fault_applied:
      faults_applied_ns.emplace(header.port, header.t_ns);
      break;
    case io::Kind::function_call: {
      const auto call = reader.as<io::FunctionCall>();
      if (call.execution_ns < 0) {
        open_calls_ns[header.port].push_back(call.entry_ns);
        break;
      }
      calls[header.port].push_back({call.entry_ns, header.t_ns, call.execution_ns, call.latency_ns,
                                    call.execution_cycles, call.response_cycles});
      break;
    }
    case io::Kind::statistics:
      statistics = text_of(reader.payload());
      break;
    case io::Kind::board_reset:
      resets.push_back({header.t_ns, header.port});
      break;
    case io::Kind::clock_setup:
      clocks.push_back({header.t_ns, reader.as<io::ClockSetup>()});
      break;
    case io::Kind::busy_time: {
      const auto piece = reader.as<io::BusyTime>();
      busy.push_back({piece.since_ns, header.t_ns, piece.busy_ns});
      break;
    }
    case io::Kind::body_motion:
    case io::Kind::esc_state:
    case io::Kind::fault:
    case io::Kind::end_of_run:
    case io::Kind::esc_setpoint:
    case io::Kind::shaft_load:
    case io::Kind::shaft_state:
    case io::Kind::i2c_order:
    case io::Kind::can_order:
    case io::Kind::pulse_train:
    case io::Kind::rc_channels:
    case io::Kind::i2c_reply:
    case io::Kind::shoot_through:
    case io::Kind::uart_delivered:
    case io::Kind::uart_frame:
    case io::Kind::uart_received:
    case io::Kind::instrument_reading:
    case io::Kind::emergency_stop:
    case io::Kind::gnss_solution:
    case io::Kind::signals:
      break;  // no window asks for them
    case io::Kind::interrupt_latency:
      add_latency(header, reader.as<io::InterruptLatency>().raised_ns);
      break;
  }
}

double EventLog::busy_share(std::int64_t from_ns, std::int64_t to_ns) const {
  double all = 0.0, used = 0.0;  // exact up to 2^53 ns, and no sum of any messages overflows
  for (const BusyRecord& piece : busy) {
    if (piece.from_ns < from_ns || piece.to_ns > to_ns) continue;
    all += static_cast<double>(piece.to_ns) - static_cast<double>(piece.from_ns);
    used += static_cast<double>(piece.busy_ns);
  }
  return all > 0.0 ? used / all : std::nan("");
}

}  // namespace whirl::results
