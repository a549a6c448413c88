#include "firmware/esc/image/can_node.hpp"

#include <array>
#include <limits>

#include "firmware/dronecan/node.hpp"
#include "firmware/esc/core/protocol.hpp"
#include "firmware/esc/image/registers.hpp"
#include "firmware/hal/bxcan.hpp"
#include "firmware/hal/interrupts.hpp"

namespace fw::esc::can_node {
namespace {

using namespace f103;

struct Port {
  using Can = f103::CAN;
  using Filters = f103::CAN;
  using Lock = hal::PriorityLock<kPriorityCan>;
  // 36 MHz / 2 / (1 + 15 + 2), sampled at 89 %.
  static constexpr std::uint32_t kBitTiming = hw::bxcan::bit_timing(2, 15, 2);
  static constexpr std::uint32_t kFirstBank = 0;
  static constexpr std::size_t kRxFrames = 8, kTxFrames = 16;
  static void start() {
    RCC::APB1ENR::set(RCC::CANEN);
    GPIOA::BSRR::write(bit(11));  // pulled up: without a transceiver the bus is idle
    GPIOA::configure(11, kInputPull);
    GPIOA::configure(12, kAlternate);
    Nvic<Irq::CAN_TX>::enable(kPriorityCan);
    Nvic<Irq::CAN_RX0>::enable(kPriorityCan);
    Nvic<Irq::CAN_SCE>::enable(kPriorityCan);
  }
};
using Can = hal::BxCan<Port>;

struct Access {  // one parameter, read only: the serial line sets it while the motor stands
  std::uint32_t motor_number = 1;
  std::size_t count() const { return 1; }
  std::string_view name(std::size_t) const { return "MOTOR"; }
  bool is_whole(std::size_t) const { return true; }
  float value(std::size_t) const { return static_cast<float>(motor_number); }
  float start(std::size_t) const { return 1.0f; }
  float low(std::size_t) const { return 1.0f; }
  float high(std::size_t) const { return 4.0f; }
  bool set(std::size_t, float) { return false; }
};

constexpr std::uint32_t kStatusPeriod_ms = 50, kPhase_ms = 11, kSecond_ms = 1000;
constexpr std::uint32_t kPriority = 16;

constinit Can can;
constinit Access access;
constinit dronecan::Node<Can, Access> node(can, access);
constinit dronecan::Reassembly<40> commands;  // of 20 ESCs
constinit dronecan::Reassembly<47> speeds;    // likewise
constinit bool by_speed = false;              // the mode's set-points are speeds
constinit std::uint16_t setpoint = 0;
constinit bool fresh = false, rejected = false, heard = false;
constinit std::uint32_t ms = 0;
constinit std::uint8_t status_transfer = 0, extended_transfer = 0;

// Ours of an array; one too short to reach it says 0.
std::int32_t own_of(std::span<const std::uint8_t> payload, unsigned width) {
  dronecan::BitsIn in(payload);
  in.skip(width * (access.motor_number - 1));
  return in.left() >= width ? in.get_signed(width) : 0;
}

// Negative: no such set-point.
void follow(std::int32_t v) {
  if (v < 0) {
    rejected = true;
    return;
  }
  setpoint = static_cast<std::uint16_t>(v);
  fresh = true;
}

std::int32_t setpoint_of_raw(std::int32_t raw) {
  return raw < 0 ? -1 : raw / 4;
}

// The nearest step of the speed mode's range. Slower than it begins, or faster than it ends: none.
std::int32_t setpoint_of_speed(std::int32_t speed_rpm) {
  if (speed_rpm == 0) return 0;
  constexpr auto range = range_of(Mode::speed);
  constexpr auto low = static_cast<std::int32_t>(range.min / kRadps_per_rpm + 0.5f);
  constexpr auto high = static_cast<std::int32_t>(range.max / kRadps_per_rpm + 0.5f);
  if (!by_speed || speed_rpm < low || speed_rpm > high) return -1;
  return 1 + ((speed_rpm - low) * (kSetpointMax - 1) + (high - low) / 2) / (high - low);
}

void read_frames() {
  hal::CanFrame frame;
  for (int i = 0; i < 4 && can.read(frame); ++i) {
    heard = true;
    if (dronecan::is_message(frame.id, dronecan::kRawCommand)) {
      if (commands.take(frame, dronecan::kRawCommand)) {
        follow(setpoint_of_raw(own_of(commands.payload(), 14)));
      }
    } else if (dronecan::is_message(frame.id, dronecan::kRpmCommand)) {
      if (speeds.take(frame, dronecan::kRpmCommand)) {
        follow(setpoint_of_speed(own_of(speeds.payload(), 18)));
      }
    } else {
      node.on_frame(frame);
    }
  }
}

void tell(const Report& report) {
  std::array<std::uint8_t, 14> bytes{};
  dronecan::BitsOut out(bytes);
  out.put(0, 32).put(dronecan::to_half(report.voltage_V), 16);
  out.put(dronecan::to_half(report.current_A), 16);
  out.put(dronecan::to_half(std::numeric_limits<float>::quiet_NaN()), 16);  // no thermometer
  out.put(static_cast<std::uint32_t>(report.speed_rpm) & 0x3FFFF, 18).put(0, 7);
  out.put(access.motor_number - 1, 5);
  std::ignore = node.publish(kPriority, dronecan::kEscStatus, status_transfer, bytes);
  std::array<std::uint8_t, 7> more{};
  dronecan::BitsOut extended(more);
  extended.skip(7 + 7 + 9 + 9);
  const std::uint32_t refused = rejected ? std::uint32_t{flag_write_rejected} : 0u;
  extended.put(report.flags | refused, 19);
  extended.put(access.motor_number - 1, 5);
  std::ignore = node.publish(kPriority, dronecan::kEscStatusExtended, extended_transfer, more);
  rejected = false;
}

std::array<std::uint8_t, 16> unique_id() {
  std::array<std::uint8_t, 16> bytes{};
  for (std::uint32_t i = 0; i < 12; ++i) {
    const std::uint32_t word = hw::RegBlock<UID::base>::read(i & ~3u);
    bytes[i] = static_cast<std::uint8_t>(word >> 8 * (i % 4));
  }
  return bytes;
}

}  // namespace

void start(std::uint32_t motor_number) {
  access.motor_number = motor_number;
  const std::uint8_t id = protocol::address_of(motor_number);
  node.be({id, "org.whirlstand.esc", unique_id()});
  const std::array<hal::CanFilter, 2> filters{
      {{dronecan::message_id(0, dronecan::kRawCommand.id, 0),
        0x00FF'FE80},  // and RPMCommand, beside it
       dronecan::Node<Can, Access>::services_to(id)}};
  std::ignore = can.init(filters);
}

bool take_setpoint(Mode mode, std::uint16_t& v) {
  by_speed = mode == Mode::speed;
  read_frames();
  if (!fresh) return false;
  fresh = false;
  v = setpoint;
  return true;
}

void publish(const Report& report) {
  ++ms;
  if (!heard) return;
  if (ms % kStatusPeriod_ms == access.motor_number * kPhase_ms % kStatusPeriod_ms) {
    if (can.waiting() > 0) can.cancel();  // nobody listens any more: the old state is of no use
    tell(report);
  }
  if (ms % kSecond_ms == access.motor_number) {
    node.publish_status(ms / kSecond_ms, dronecan::Health::ok);
  }
}

}  // namespace fw::esc::can_node

extern "C" void can_tx_handler() {
  fw::esc::can_node::can.on_transmit();
}
extern "C" void can_rx0_handler() {
  fw::esc::can_node::can.on_receive();
}
extern "C" void can_sce_handler() {
  fw::esc::can_node::can.on_status();
}
