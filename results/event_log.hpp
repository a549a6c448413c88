// What a run's windows and tables are judged by, decoded as it crosses: when transfers, calls and
// interrupts came, and what the board said of itself. Bytes are in the run's file of messages only.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "io_bridges/messages/messages.hpp"

namespace whirl::results {

struct BusRecord {
  bool spi = false;
  std::uint16_t bus = 0;
  std::uint16_t address = 0;  // SPI: device number
  bool read = false;
  bool acked = true;
  std::uint32_t length = 0;
  std::int64_t start_ns = 0;
  std::int64_t stop_ns = 0;
};

struct UnreadRecord {  // a frame that an analyser saw and could not read
  bool spi = false;
  std::uint16_t bus = 0;
  std::int64_t start_ns = 0, stop_ns = 0;
};

struct PulseRecord {                       // a pin was high
  std::int64_t rise_ns = 0, fall_ns = -1;  // -1: it is so still
};

// A frame on CAN, good or not.
struct CanFrameRecord {
  std::uint16_t bus = 0;
  std::int32_t sender = -1;  // its number on the board; -1: the microcontroller
  std::uint32_t id = 0;
  bool extended = false, good = true;
  bool begins = false;  // its last byte is that of a DroneCAN transfer's first frame
  std::uint32_t busy_ns = 0, tec = 0;
  std::int64_t start_ns = 0, end_ns = 0;

  // A message, and no service, of that data type of DroneCAN.
  bool is_message(std::uint32_t type) const {
    return extended && (id & 0x80) == 0 && (id >> 8 & 0xFFFF) == type;
  }
};

struct CallRecord {
  std::int64_t entry_ns = 0;
  std::int64_t return_ns = 0;
  std::int64_t execution_ns = 0;
  std::int64_t latency_ns = -1;  // of the interrupt that called it; -1: none
  std::int64_t execution_cycles = -1, response_cycles = -1;  // -1: no code, or not known
};

// Of one exception's requests, from the line to the first instruction of the handler.
struct LatencyRecord {
  std::size_t count = 0;
  double sum_ns = 0.0, max_ns = 0.0;  // exact up to 2^53 ns, and no times of any messages overflow
  std::int64_t max_at_ns = 0;         // the handler's first instruction
};

struct BusyRecord {
  std::int64_t from_ns = 0, to_ns = 0, busy_ns = 0;
};

struct TextRecord {
  std::int64_t t_ns = 0;
  std::string where;
  std::string what;
};

struct CpuFaultRecord {
  std::int64_t t_ns = 0;
  io::CpuFault registers;
  std::string backtrace;
};

struct ResetRecord {
  std::int64_t t_ns = 0;
  std::uint16_t cause = 0;
};

struct ClockRecord {
  std::int64_t t_ns = 0;
  io::ClockSetup setup;
};

class EventLog {
 public:
  // Takes a batch of either direction; false: it was cut short, which no target may do.
  bool add(const io::Batch& batch);
  void add(const io::Reader& message);  // where the reader stands

  std::vector<BusRecord> bus;
  std::vector<UnreadRecord> unread;
  std::map<std::uint16_t, std::vector<PulseRecord>> pulses;  // by pin number
  std::vector<CanFrameRecord> can;
  std::map<std::uint16_t, std::vector<CallRecord>> calls;            // by watch number
  std::map<std::uint16_t, LatencyRecord> latencies;                  // by exception number
  std::map<std::uint16_t, std::vector<std::int64_t>> open_calls_ns;  // entries: never returned
  std::map<std::uint16_t, std::vector<std::int64_t>> data_ready_ns;  // by device number
  std::map<std::uint32_t, std::int64_t> faults_applied_ns;           // first, by fault number
  std::vector<TextRecord> findings;
  std::vector<CpuFaultRecord> cpu_faults;
  std::vector<ResetRecord> resets;
  std::vector<BusyRecord> busy;
  std::vector<ClockRecord> clocks;  // each change
  std::string statistics;

  // Share of [from, to] outside of sleep, from the pieces that lie wholly inside; NaN without any.
  double busy_share(std::int64_t from_ns, std::int64_t to_ns) const;

 private:
  void add_bus(const io::Reader& reader, bool spi);
  void add_pin(const io::Header& header, bool level);
  void add_can(const io::Header& header, const io::CanRecord& r);
  void add_latency(const io::Header& header, std::int64_t raised_ns);

  std::map<std::uint16_t, bool> pin_levels_;
};

}  // namespace whirl::results
