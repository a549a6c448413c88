#include "io_bridges/messages/fields.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <type_traits>

#include "base/text.hpp"

namespace whirl::io {
namespace {

template <typename T>
constexpr Field::Type type_of() {
  if (std::is_same_v<T, double>) return Field::Type::real;
  if (std::is_same_v<T, std::int64_t>) return Field::Type::int64;
  if (std::is_same_v<T, std::int32_t>) return Field::Type::int32;
  if (std::is_same_v<T, std::uint32_t>) return Field::Type::uint32;
  if (std::is_same_v<T, std::uint16_t>) return Field::Type::uint16;
  static_assert(std::is_floating_point_v<T> || sizeof(T) > 1 || std::is_same_v<T, std::uint8_t>);
  return Field::Type::uint8;
}

template <typename Member>
constexpr Field field(std::string_view name, std::size_t offset) {
  using T = std::remove_all_extents_t<Member>;
  const std::size_t count = std::is_array_v<Member> ? std::extent_v<Member> : 1;
  return {name, type_of<T>(), static_cast<std::uint16_t>(offset),
          static_cast<std::uint16_t>(count)};
}

#define WHIRL_FIELD(s, member) field<decltype(s::member)>(#member, offsetof(s, member))

constexpr Field kBodyMotion[] = {
    WHIRL_FIELD(BodyMotion, specific_force_B_mps2),
    WHIRL_FIELD(BodyMotion, w_WB_B_radps),
    WHIRL_FIELD(BodyMotion, alpha_WB_B_radps2),
    WHIRL_FIELD(BodyMotion, rotor_speed_radps),
    WHIRL_FIELD(BodyMotion, magnetic_field_B_T),
    WHIRL_FIELD(BodyMotion, static_pressure_Pa),
    WHIRL_FIELD(BodyMotion, air_temperature_K),
    WHIRL_FIELD(BodyMotion, bus_voltage_V),
    WHIRL_FIELD(BodyMotion, p_WB_W_m),
    WHIRL_FIELD(BodyMotion, v_WB_W_mps),
    WHIRL_FIELD(BodyMotion, q_WB),
    WHIRL_FIELD(BodyMotion, v_AB_B_mps),
    WHIRL_FIELD(BodyMotion, rotor_thrust_N),
    WHIRL_FIELD(BodyMotion, rotor_bus_current_A),
    WHIRL_FIELD(BodyMotion, battery_current_A),
    WHIRL_FIELD(BodyMotion, rotor_unbalance_m),
};
constexpr Field kEscState[] = {
    WHIRL_FIELD(EscState, bus_current_A),
    WHIRL_FIELD(EscState, speed_rpm),
    WHIRL_FIELD(EscState, flags),
};
constexpr Field kFaultCommand[] = {
    WHIRL_FIELD(FaultCommand, number),   WHIRL_FIELD(FaultCommand, kind),
    WHIRL_FIELD(FaultCommand, start_ns), WHIRL_FIELD(FaultCommand, end_ns),
    WHIRL_FIELD(FaultCommand, bus),      WHIRL_FIELD(FaultCommand, address),
    WHIRL_FIELD(FaultCommand, value),    WHIRL_FIELD(FaultCommand, axis),
};
constexpr Field kShaftLoad[] = {
    WHIRL_FIELD(ShaftLoad, torque_Nm_s2),
    WHIRL_FIELD(ShaftLoad, brake_Nm),
    WHIRL_FIELD(ShaftLoad, source_V),
    WHIRL_FIELD(ShaftLoad, source_ohm),
};
constexpr Field kI2cOrder[] = {
    WHIRL_FIELD(I2cOrder, address),
    WHIRL_FIELD(I2cOrder, read),
    WHIRL_FIELD(I2cOrder, number),
};
constexpr Field kPulseTrain[] = {
    WHIRL_FIELD(PulseTrain, width_ns),
    WHIRL_FIELD(PulseTrain, period_ns),
    WHIRL_FIELD(PulseTrain, glitch_ns),
    WHIRL_FIELD(PulseTrain, glitch_after_ns),
};
constexpr Field kRcChannelsFields[] = {
    WHIRL_FIELD(RcChannels, position),
};
constexpr Field kEscSetpoint[] = {
    WHIRL_FIELD(EscSetpoint, value),
    WHIRL_FIELD(EscSetpoint, valid),
    WHIRL_FIELD(EscSetpoint, start_ns),
};
constexpr Field kBusTransaction[] = {
    WHIRL_FIELD(BusTransaction, start_ns), WHIRL_FIELD(BusTransaction, address),
    WHIRL_FIELD(BusTransaction, read),     WHIRL_FIELD(BusTransaction, acked),
    WHIRL_FIELD(BusTransaction, length),   WHIRL_FIELD(BusTransaction, kept),
};
constexpr Field kCanMessage[] = {
    WHIRL_FIELD(CanMessage, id),
    WHIRL_FIELD(CanMessage, flags),
    WHIRL_FIELD(CanMessage, length),
    WHIRL_FIELD(CanMessage, data),
};
constexpr Field kCanRecord[] = {
    WHIRL_FIELD(CanRecord, start_ns),    WHIRL_FIELD(CanRecord, frame.id),
    WHIRL_FIELD(CanRecord, frame.flags), WHIRL_FIELD(CanRecord, frame.length),
    WHIRL_FIELD(CanRecord, frame.data),  WHIRL_FIELD(CanRecord, sender),
    WHIRL_FIELD(CanRecord, busy_ns),     WHIRL_FIELD(CanRecord, tec),
    WHIRL_FIELD(CanRecord, bit),         WHIRL_FIELD(CanRecord, error),
    WHIRL_FIELD(CanRecord, losers),
};
constexpr Field kCpuFault[] = {
    WHIRL_FIELD(CpuFault, exception), WHIRL_FIELD(CpuFault, pc),    WHIRL_FIELD(CpuFault, lr),
    WHIRL_FIELD(CpuFault, sp),        WHIRL_FIELD(CpuFault, xpsr),  WHIRL_FIELD(CpuFault, cfsr),
    WHIRL_FIELD(CpuFault, hfsr),      WHIRL_FIELD(CpuFault, mmfar), WHIRL_FIELD(CpuFault, bfar),
    WHIRL_FIELD(CpuFault, r),
};
constexpr Field kFunctionCall[] = {
    WHIRL_FIELD(FunctionCall, entry_ns),        WHIRL_FIELD(FunctionCall, execution_ns),
    WHIRL_FIELD(FunctionCall, latency_ns),      WHIRL_FIELD(FunctionCall, execution_cycles),
    WHIRL_FIELD(FunctionCall, response_cycles),
};
constexpr Field kInterruptLatency[] = {
    WHIRL_FIELD(InterruptLatency, raised_ns),
};
constexpr Field kClockSetup[] = {
    WHIRL_FIELD(ClockSetup, sysclk_Hz),
    WHIRL_FIELD(ClockSetup, hclk_Hz),
    WHIRL_FIELD(ClockSetup, pclk1_Hz),
    WHIRL_FIELD(ClockSetup, pclk2_Hz),
};
constexpr Field kBusyTime[] = {
    WHIRL_FIELD(BusyTime, since_ns),
    WHIRL_FIELD(BusyTime, busy_ns),
};
constexpr Field kShaftState[] = {
    WHIRL_FIELD(ShaftState, speed_radps),
    WHIRL_FIELD(ShaftState, angle_rad),
    WHIRL_FIELD(ShaftState, air_torque_Nm),
    WHIRL_FIELD(ShaftState, source_current_A),
    WHIRL_FIELD(ShaftState, bridge_current_A),
    WHIRL_FIELD(ShaftState, bridge_peak_A),
    WHIRL_FIELD(ShaftState, winding_peak_A),
    WHIRL_FIELD(ShaftState, bus_voltage_V),
    WHIRL_FIELD(ShaftState, bus_highest_V),
    WHIRL_FIELD(ShaftState, bus_lowest_V),
    WHIRL_FIELD(ShaftState, electrical_in_J),
    WHIRL_FIELD(ShaftState, copper_J),
    WHIRL_FIELD(ShaftState, diode_J),
    WHIRL_FIELD(ShaftState, no_load_J),
    WHIRL_FIELD(ShaftState, magnetic_J),
    WHIRL_FIELD(ShaftState, kinetic_J),
    WHIRL_FIELD(ShaftState, air_J),
    WHIRL_FIELD(ShaftState, source_J),
    WHIRL_FIELD(ShaftState, feed_J),
    WHIRL_FIELD(ShaftState, capacitor_J),
};
constexpr Field kI2cReplyHead[] = {
    WHIRL_FIELD(I2cReplyHead, number),
    WHIRL_FIELD(I2cReplyHead, acked),
    WHIRL_FIELD(I2cReplyHead, timed_out),
    WHIRL_FIELD(I2cReplyHead, stretched_ns),
};
constexpr Field kGnssSolution[] = {
    WHIRL_FIELD(GnssSolution, latitude_rad), WHIRL_FIELD(GnssSolution, longitude_rad),
    WHIRL_FIELD(GnssSolution, height_m),     WHIRL_FIELD(GnssSolution, p_WB_W_m),
    WHIRL_FIELD(GnssSolution, p_error_W_m),  WHIRL_FIELD(GnssSolution, v_error_W_mps),
};
constexpr Field kShootThrough[] = {
    WHIRL_FIELD(ShootThrough, start_ns),
};
constexpr Field kPinEdge[] = {
    WHIRL_FIELD(PinEdge, level),
};

constexpr Field kInstrumentReading[] = {
    WHIRL_FIELD(InstrumentReading, value),
};
constexpr Field kBusUnread[] = {
    WHIRL_FIELD(BusUnread, start_ns),
    WHIRL_FIELD(BusUnread, spi),
};

#undef WHIRL_FIELD

constexpr KindInfo kKinds[] = {
    {Kind::body_motion, "body_motion", true, kBodyMotion, sizeof(BodyMotion), Tail::none},
    {Kind::esc_state, "esc_state", true, kEscState, sizeof(EscState), Tail::none},
    {Kind::uart_frame, "uart_frame", true, {}, 0, Tail::bytes},
    {Kind::fault, "fault", true, kFaultCommand, sizeof(FaultCommand), Tail::text},
    {Kind::end_of_run, "end_of_run", true, {}, 0, Tail::none},
    {Kind::shaft_load, "shaft_load", true, kShaftLoad, sizeof(ShaftLoad), Tail::none},
    {Kind::i2c_order, "i2c_order", true, kI2cOrder, sizeof(I2cOrder), Tail::bytes},
    {Kind::pulse_train, "pulse_train", true, kPulseTrain, sizeof(PulseTrain), Tail::none},
    {Kind::rc_channels, "rc_channels", true, kRcChannelsFields, sizeof(RcChannels), Tail::none},
    {Kind::emergency_stop, "emergency_stop", true, {}, 0, Tail::text},
    {Kind::can_order, "can_order", true, kCanMessage, sizeof(CanMessage), Tail::none},
    {Kind::esc_setpoint, "esc_setpoint", false, kEscSetpoint, sizeof(EscSetpoint), Tail::none},
    {Kind::uart_received, "uart_received", false, {}, 0, Tail::bytes},
    {Kind::i2c_transaction, "i2c_transaction", false, kBusTransaction, sizeof(BusTransaction),
     Tail::transfer},
    {Kind::spi_transaction, "spi_transaction", false, kBusTransaction, sizeof(BusTransaction),
     Tail::transfer},
    {Kind::data_ready, "data_ready", false, {}, 0, Tail::none},
    {Kind::finding, "finding", false, {}, 0, Tail::text},
    {Kind::cpu_fault, "cpu_fault", false, kCpuFault, sizeof(CpuFault), Tail::text},
    {Kind::fault_applied, "fault_applied", false, {}, 0, Tail::none},
    {Kind::function_call, "function_call", false, kFunctionCall, sizeof(FunctionCall), Tail::none},
    {Kind::interrupt_latency, "interrupt_latency", false, kInterruptLatency,
     sizeof(InterruptLatency), Tail::none},
    {Kind::statistics, "statistics", false, {}, 0, Tail::text},
    {Kind::board_reset, "board_reset", false, {}, 0, Tail::none},
    {Kind::clock_setup, "clock_setup", false, kClockSetup, sizeof(ClockSetup), Tail::none},
    {Kind::busy_time, "busy_time", false, kBusyTime, sizeof(BusyTime), Tail::none},
    {Kind::shaft_state, "shaft_state", false, kShaftState, sizeof(ShaftState), Tail::none},
    {Kind::i2c_reply, "i2c_reply", false, kI2cReplyHead, sizeof(I2cReplyHead), Tail::bytes},
    {Kind::can_transfer, "can_transfer", false, kCanRecord, sizeof(CanRecord), Tail::none},
    {Kind::instrument_reading, "instrument_reading", false, kInstrumentReading,
     sizeof(InstrumentReading), Tail::none},
    {Kind::shoot_through, "shoot_through", false, kShootThrough, sizeof(ShootThrough), Tail::none},
    {Kind::uart_delivered, "uart_delivered", false, {}, 0, Tail::bytes},
    {Kind::gnss_solution, "gnss_solution", false, kGnssSolution, sizeof(GnssSolution), Tail::none},
    {Kind::bus_unread, "bus_unread", false, kBusUnread, sizeof(BusUnread), Tail::text},
    {Kind::pin_edge, "pin_edge", false, kPinEdge, sizeof(PinEdge), Tail::none},
    {Kind::signals, "signals", false, {}, 0, Tail::none},
};

template <typename T>
T value_at(std::span<const std::uint8_t> payload, std::size_t offset) {
  T value{};
  if (offset < payload.size()) {
    std::memcpy(&value, payload.data() + offset, std::min(sizeof value, payload.size() - offset));
  }
  return value;
}

std::string value_text(Field::Type type, std::span<const std::uint8_t> payload, std::size_t at) {
  switch (type) {
    case Field::Type::real: {
      char text[32];
      const auto end = std::to_chars(text, text + sizeof text, value_at<double>(payload, at)).ptr;
      return {text, end};
    }
    case Field::Type::int64:
      return std::to_string(value_at<std::int64_t>(payload, at));
    case Field::Type::int32:
      return std::to_string(value_at<std::int32_t>(payload, at));
    case Field::Type::uint32:
      return std::to_string(value_at<std::uint32_t>(payload, at));
    case Field::Type::uint16:
      return std::to_string(value_at<std::uint16_t>(payload, at));
    case Field::Type::uint8:
      return std::to_string(value_at<std::uint8_t>(payload, at));
  }
  return "";
}

void add_transfer(std::size_t kept, std::span<const std::uint8_t> tail, std::string& text) {
  const auto bytes = tail.first(std::min(kept, tail.size()));
  add_hex(bytes, text += ";bytes=");
  const auto times = tail.subspan(bytes.size());
  for (std::size_t at = 0; at + 4 <= times.size(); at += 4) {
    text += at == 0 ? ";passed_ns=" : " ";
    const auto passed_ns = value_at<std::uint32_t>(times, at);
    text += passed_ns == kLate ? "late" : std::to_string(passed_ns);
  }
}

void add_tail(const KindInfo& info, std::span<const std::uint8_t> payload, std::string& text) {
  const auto tail = payload.subspan(std::min(info.size, payload.size()));
  if (tail.empty()) return;
  const std::string comma = text.empty() ? "" : ";";
  switch (info.tail) {
    case Tail::none:
      return;
    case Tail::bytes:
      return add_hex(tail, text += comma + "bytes=");
    case Tail::text:
      text += comma + "text=";
      for (const std::uint8_t c : tail) text += c == 0 ? ' ' : static_cast<char>(c);
      return;
    case Tail::transfer:
      return add_transfer(value_at<BusTransaction>(payload, 0).kept, tail, text);
  }
}

}  // namespace

std::size_t size_of(Field::Type type) {
  switch (type) {
    case Field::Type::real:
    case Field::Type::int64:
      return 8;
    case Field::Type::int32:
    case Field::Type::uint32:
      return 4;
    case Field::Type::uint16:
      return 2;
    case Field::Type::uint8:
      return 1;
  }
  return 1;
}

const KindInfo* kind_info(Kind kind) {
  const auto it = std::find_if(std::begin(kKinds), std::end(kKinds),
                               [kind](const KindInfo& info) { return info.kind == kind; });
  return it == std::end(kKinds) ? nullptr : it;
}

std::string fields_text(const KindInfo& info, std::span<const std::uint8_t> payload) {
  std::string text;
  for (const Field& field : info.fields) {
    text += text.empty() ? "" : ";";
    text.append(field.name) += '=';
    for (std::size_t i = 0; i < field.count; ++i) {
      text += i == 0 ? "" : " ";
      text += value_text(field.type, payload, field.offset + i * size_of(field.type));
    }
  }
  add_tail(info, payload, text);
  return text;
}

}  // namespace whirl::io
