// What crosses between the harness and a target (virtual board or physical board), on one time
// base.
//
//   Units    SI; times are virtual nanoseconds since power-up of the run
//   Frames   B: body, forward-right-down; W: world, north-east-down; A: the air; as in
//            plant/base/frames.hpp
//   Layout   plain structs, fixed-size, native byte order: both ends run on one host
//   Digest   of a run is taken over all messages, both ways, in order
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <span>
#include <type_traits>
#include <vector>

namespace whirl::io {

inline constexpr int kMostMotors = 12;  // of a vehicle; plant::kMostMotors is compared with it

enum class Kind : std::uint8_t {
  // Harness to target.
  body_motion = 1,      // BodyMotion: the motion of the sensors on the board from here on
  esc_state = 2,        // EscState, port = motor number 1..kMostMotors
  uart_frame = 3,       // bytes to send into UART `port` from t_ns on
  fault = 4,            // FaultCommand + name text
  end_of_run = 5,       // empty
  shaft_load = 6,       // ShaftLoad: air, brake and supply of a power stage, from here on
  i2c_order = 7,        // I2cOrder + bytes to write, port = bus number: not before t_ns
  pulse_train = 8,      // PulseTrain, port = motor number: on its throttle pin, from here on
  rc_channels = 9,      // RcChannels: stick positions that a transmitter sends; silence: it is off
  emergency_stop = 10,  // text, why: a bench is made safe
  can_order = 11,       // CanMessage, port = bus number: a node of the world sends it from t_ns on
  // Target to harness.
  esc_setpoint = 32,     // EscSetpoint, port = motor number 1..kMostMotors
  uart_received = 33,    // bytes the board has sent on UART `port`; t_ns: the last stop bit
  i2c_transaction = 34,  // BusTransaction + bytes + their times, port = bus number
  spi_transaction = 35,  // BusTransaction + bytes (at most 32 kept: MOSI and MISO in turn) + times
                         // of the pairs, port = bus number
  data_ready = 36,       // port = device number: an interrupt line of a sensor rose
  finding = 37,          // text "where\0what"
  cpu_fault = 38,        // CpuFault + text (symbolised backtrace, one frame per line)
  fault_applied = 39,    // port = fault number
  function_call = 40,    // FunctionCall, port = watch number
  interrupt_latency = 41,  // InterruptLatency, port = exception number
  statistics = 42,     // text, JSON: watchers' summaries, unanswered registers; at the end of a run
  board_reset = 43,    // ResetCause in port
  clock_setup = 44,    // ClockSetup: what the firmware set in RCC
  busy_time = 45,      // BusyTime: about ten a second
  shaft_state = 46,    // ShaftState: of a power stage, at each boundary
  i2c_reply = 47,      // I2cReplyHead + bytes read, port = bus number; t_ns: the STOP
  shoot_through = 48,  // ShootThrough, port = leg 0..2: both switches were on until t_ns
  uart_delivered = 49,  // a uart_frame has passed the line to the board; t_ns: the last stop bit
  gnss_solution = 55,  // GnssSolution, port = device number: a GNSS receiver has computed its place
  pin_edge = 50,       // PinEdge, port = number of the pin among those that the board file names
  instrument_reading = 51,  // InstrumentReading, port = place in the bench's list of readings
  bus_unread =
      60,  // BusUnread + text, why; port = bus number: a frame that an analyser saw and could
           // not read; t_ns: its end
  can_transfer =
      52,  // CanRecord, port = bus number: a frame has passed, good or not; t_ns: its end
  // Only in a run's file of messages (results/messages).
  signals = 64,  // a row of the world's signals
};

// Ports of board_reset: stm32::ResetCause by number.
inline constexpr std::uint16_t kResetByIndependentWatchdog = 3, kResetByWindowWatchdog = 4;

struct Header {
  std::int64_t t_ns = 0;
  Kind kind{};
  std::uint8_t board = 0;  // of a run with several: its place in the list of nodes
  std::uint16_t port = 0;
  std::uint32_t size = 0;  // of the payload that follows
};
static_assert(sizeof(Header) == 16);

struct BodyMotion {  // of the body's reference point (centre of mass), at t_ns
  double specific_force_B_mps2[3] = {0, 0, 0};  // what an ideal accelerometer reads
  double w_WB_B_radps[3] = {0, 0, 0};
  double alpha_WB_B_radps2[3] = {0, 0, 0};
  double rotor_speed_radps[kMostMotors] = {};  // for vibration; 0 of rotors that are not there
  double magnetic_field_B_T[3] = {0, 0, 0};
  double static_pressure_Pa = 101325.0;
  double air_temperature_K = 288.15;
  double bus_voltage_V = 16.4;
  double p_WB_W_m[3] = {0, 0, 0};                // W's origin is on the ground
  double v_WB_W_mps[3] = {0, 0, 0};              // over ground
  double q_WB[4] = {1, 0, 0, 0};                 // w x y z, Hamilton
  double v_AB_B_mps[3] = {0, 0, 0};              // through the air around it
  double rotor_thrust_N[kMostMotors] = {};       // along the shafts; 0 of rotors that are not there
  double rotor_bus_current_A[kMostMotors] = {};  // into each motor's bridge, mean of the last step
  double battery_current_A = 0.0;                // out of the pack, mean of the last step
  double rotor_unbalance_m[kMostMotors] = {};    // mass x arm over the vehicle's mass
};

struct GnssSolution {  // of the moment t_ns; what is sent of it comes later, rounded
  double latitude_rad = 0.0, longitude_rad = 0.0, height_m = 0.0;  // over the ellipsoid
  double p_WB_W_m[3] = {0, 0, 0};     // the same place in W, its error included
  double p_error_W_m[3] = {0, 0, 0};  // of that, faults' offsets included
  double v_error_W_mps[3] = {0, 0, 0};
};

struct EscState {
  double bus_current_A = 0.0;  // filtered, as the ESC reports it
  double speed_rpm = 0.0;      // mechanical
  std::uint8_t flags = 0;      // esc protocol, status flags
  std::uint8_t pad[7] = {};
};

struct EscSetpoint {
  std::uint16_t value = 0;  // 0..2047 as on the wire
  std::uint8_t valid = 0;   // 1: accepted; 0: rejected (length, CRC, upper bits)
  std::uint8_t pad[5] = {};
  std::int64_t start_ns = 0;  // START of the write that carried it; Header::t_ns is its STOP
};

inline constexpr std::uint32_t kLate = UINT32_MAX;

// Since the start of a transaction, as its message keeps it.
inline std::uint32_t passed_ns(std::int64_t start_ns, std::int64_t now_ns) {
  return static_cast<std::uint32_t>(std::min<std::int64_t>(now_ns - start_ns, kLate));
}

struct BusTransaction {
  std::int64_t start_ns = 0;  // START or chip select; Header::t_ns is STOP or deselect
  std::uint16_t address = 0;  // I2C address; SPI: device number
  std::uint8_t read = 0;
  std::uint8_t acked = 1;  // every byte that wanted an acknowledge got one
  std::uint32_t length = 0;
  std::uint32_t kept = 0;  // bytes behind this struct; then, as u32 in ns since start_ns, when each
                           // one's last clock (I2C: its ninth) had passed; kLate: after 4.29 s
  std::uint32_t pad = 0;
};

struct CanMessage {
  std::uint32_t id = 0;    // 11 or 29 bits
  std::uint8_t flags = 0;  // 1: 29 bits, 2: remote
  std::uint8_t length = 0;
  std::uint8_t pad[2] = {};
  std::uint8_t data[8] = {};
};

struct CanRecord {
  std::int64_t start_ns = 0;  // start of frame
  CanMessage frame;
  // Its number on the board. -1: the microcontroller, -2: a fault's babbling node, from kFirst_board on: another board
  // that takes no device's place.
  static constexpr std::int32_t kFirst_board = 1000;
  std::int32_t sender = -1;
  std::uint32_t busy_ns = 0;  // of the bus, intermission included
  std::uint32_t tec = 0;      // the sender's error counter after it
  std::uint16_t bit = 0;      // where the error was found, in bits of the wire from start of frame
  std::uint8_t error = 0;     // 0: good; else as bxCAN's LEC: 1 stuff .. 6 CRC
  std::uint8_t losers = 0;    // of the arbitration
};

struct FaultCommand {  // the name follows as text, for messages to people
  std::uint32_t number = 0;
  std::uint32_t kind = 0;  // FaultKind of io_bridges/devices/faults.hpp
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
  std::int32_t bus = 0;
  std::int32_t address = 0;
  double value = 0.0;
  std::int32_t axis = 0;  // of what the device senses (BoardDevice::senses)
  std::int32_t pad = 0;
};

struct CpuFault {
  std::uint32_t exception = 0;  // 3 HardFault, 4 MemManage, 5 BusFault, 6 UsageFault;
                                // 254, 255: board::StoppedCore
  std::uint32_t pc = 0, lr = 0, sp = 0, xpsr = 0, cfsr = 0, hfsr = 0, mmfar = 0, bfar = 0;
  std::uint32_t r[13] = {};
};

struct FunctionCall {
  std::int64_t entry_ns = 0;  // Header::t_ns is the return
  // Without what preempted it; -1: the run ended before it returned.
  std::int64_t execution_ns = 0;
  // Of the interrupt whose handler called it: from the request to the handler's first instruction.
  std::int64_t latency_ns = -1;  // -1: called from no interrupt, or from one that nobody requested
  // Of HCLK, as it was; -1: not known, or no code of the core's.
  std::int64_t execution_cycles = -1, response_cycles = -1;
};

struct InterruptLatency {
  std::int64_t raised_ns = 0;  // Header::t_ns is the first instruction of the handler
};

struct BusyTime {  // of (since_ns, Header::t_ns]
  std::int64_t since_ns = 0;
  std::int64_t busy_ns = 0;  // outside of sleep; interrupts included
};

struct ShaftLoad {
  double torque_Nm_s2 = 0.0;  // of the air, over the square of speed
  double brake_Nm = 0.0;      // holds the shaft once it stands; negative: drives it backward
  double source_V = 0.0;      // of the supply, behind its resistance
  double source_ohm = 0.0;
};

struct ShaftState {  // means and sums of the time since the last boundary, states at this one
  double speed_radps = 0.0;
  double angle_rad = 0.0;         // electrical, 0..2 pi
  double air_torque_Nm = 0.0;     // mean
  double source_current_A = 0.0;  // mean, out of the supply
  double bridge_current_A = 0.0;  // mean, into the bridge
  double bridge_peak_A = 0.0;     // largest mean of a PWM period that has ended
  double winding_peak_A = 0.0;    // largest magnitude
  double bus_voltage_V = 0.0;     // at this instant
  double bus_highest_V = 0.0, bus_lowest_V = 0.0;
  double electrical_in_J = 0.0, copper_J = 0.0, diode_J = 0.0, no_load_J = 0.0;
  double magnetic_J = 0.0, kinetic_J = 0.0, air_J = 0.0;
  // What the supply gave, of that the heat of its resistance, and into the capacitor before the bridge.
  double source_J = 0.0, feed_J = 0.0, capacitor_J = 0.0;
};

struct I2cOrder {
  std::uint16_t address = 0;
  std::uint16_t read = 0;    // bytes to read after the written ones
  std::uint32_t number = 0;  // comes back in the reply
};

struct PulseTrain {  // high for width once per period; width 0: low
  std::int64_t width_ns = 0;
  std::int64_t period_ns = 20'000'000;
  std::int64_t glitch_ns = 0;  // the line inverted for so long, so long after each rising edge
  std::int64_t glitch_after_ns = 0;
};

inline constexpr int kRcChannels = 16;

// Shares of full travel, -1..1 from stop to stop: a receiver of any kind scales them to its own counts.
struct RcChannels {
  double position[kRcChannels] = {};  // channel 1 first
};

struct I2cReplyHead {
  std::uint32_t number = 0;
  std::uint8_t acked = 0;
  std::uint8_t timed_out = 0;
  std::uint8_t pad[2] = {};
  std::int64_t stretched_ns = 0;  // the longest that SCL was held
};

struct PinEdge {
  std::uint8_t level = 0;  // from t_ns on
  std::uint8_t pad[7] = {};
};

struct InstrumentReading {  // of a bench: what was measured when (t_ns), in SI
  double value = 0.0;
};

struct BusUnread {
  std::int64_t start_ns = 0;
  std::uint8_t spi = 0;
  std::uint8_t pad[7] = {};
};

struct ShootThrough {
  std::int64_t start_ns = 0;
};

struct ClockSetup {
  double sysclk_Hz = 0, hclk_Hz = 0, pclk1_Hz = 0, pclk2_Hz = 0;
};

// A batch of messages in one flat buffer, appended in order of time.
class Batch {
 public:
  void clear() { bytes_.clear(); }
  bool empty() const { return bytes_.empty(); }
  std::span<const std::uint8_t> bytes() const { return bytes_; }
  void assign(std::span<const std::uint8_t> bytes) { bytes_.assign(bytes.begin(), bytes.end()); }

  // A message as it is, under this header.
  void add(const Header& header, std::span<const std::uint8_t> payload) {
    append(&header, sizeof header);
    append(payload.data(), payload.size());
  }
  // The same with a payload in pieces; header.size is counted here.
  void add(Header header, std::initializer_list<std::span<const std::uint8_t>> pieces) {
    header.size = 0;
    for (const auto& piece : pieces) header.size += static_cast<std::uint32_t>(piece.size());
    append(&header, sizeof header);
    for (const auto& piece : pieces) append(piece.data(), piece.size());
  }
  void add(const Batch& other) { append(other.bytes_.data(), other.bytes_.size()); }
  void add(Kind kind, std::uint16_t port, std::int64_t t_ns, const void* payload,
           std::uint32_t size) {
    const Header header{t_ns, kind, 0, port, size};
    append(&header, sizeof header);
    append(payload, size);
  }
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void add(Kind kind, std::uint16_t port, std::int64_t t_ns, const T& payload) {
    add(kind, port, t_ns, &payload, sizeof payload);
  }
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void add(Kind kind, std::uint16_t port, std::int64_t t_ns, const T& head, const void* tail,
           std::uint32_t tail_size) {
    const Header header{t_ns, kind, 0, port, static_cast<std::uint32_t>(sizeof head) + tail_size};
    append(&header, sizeof header);
    append(&head, sizeof head);
    append(tail, tail_size);
  }

 private:
  void append(const void* data, std::size_t size) {
    const auto* first = static_cast<const std::uint8_t*>(data);
    bytes_.insert(bytes_.end(), first, first + size);
  }
  std::vector<std::uint8_t> bytes_;
};

// A transaction with its bytes and when each had passed; `times_ns` counts from its start.
inline void add_transaction(Kind kind, std::uint16_t bus, std::int64_t stop_ns, BusTransaction head,
                            std::span<const std::uint8_t> bytes,
                            std::span<const std::uint32_t> times_ns, Batch& batch) {
  head.kept = static_cast<std::uint32_t>(bytes.size());
  batch.add(Header{stop_ns, kind, 0, bus, 0},
            {{reinterpret_cast<const std::uint8_t*>(&head), sizeof head},
             bytes,
             {reinterpret_cast<const std::uint8_t*>(times_ns.data()), times_ns.size_bytes()}});
}

// Walks a batch: for (Reader r(bytes); r.next();) switch (r.header().kind) ...
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  bool next() {
    if (rest_.size() < sizeof header_) return false;
    std::memcpy(&header_, rest_.data(), sizeof header_);
    if (rest_.size() - sizeof header_ < header_.size) return false;
    payload_ = rest_.subspan(sizeof header_, header_.size);
    rest_ = rest_.subspan(sizeof header_ + header_.size);
    return true;
  }
  bool complete() const { return rest_.empty(); }  // after the walk: nothing was cut off
  const Header& header() const { return header_; }
  std::span<const std::uint8_t> payload() const { return payload_; }

  template <typename T>
  requires std::is_trivially_copyable_v<T> T as()
  const {  // short payloads are zero-extended
    T value{};
    std::memcpy(&value, payload_.data(),
                payload_.size() < sizeof value ? payload_.size() : sizeof value);
    return value;
  }
  std::span<const std::uint8_t> tail_after(std::size_t head) const {
    return payload_.size() > head ? payload_.subspan(head) : std::span<const std::uint8_t>{};
  }
  // Of a BusTransaction: its bytes, without their times.
  std::span<const std::uint8_t> transferred() const {
    const auto tail = tail_after(sizeof(BusTransaction));
    return tail.first(std::min<std::size_t>(as<BusTransaction>().kept, tail.size()));
  }

 private:
  std::span<const std::uint8_t> rest_;
  std::span<const std::uint8_t> payload_;
  Header header_{};
};

// The messages of `from`, as those of this board, at the end of `to`.
inline void add_for_board(const Batch& from, std::uint8_t board, Batch& to) {
  for (Reader r(from.bytes()); r.next();) {
    Header header = r.header();
    header.board = board;
    to.add(header, r.payload());
  }
}

}  // namespace whirl::io
