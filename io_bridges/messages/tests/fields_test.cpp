#include "io_bridges/messages/fields.hpp"

#include <gtest/gtest.h>

#include <map>

namespace whirl::io {
namespace {

// A kind that is added without a name here does not compile (-Wswitch).
bool has_to_be_listed(Kind kind) {
  switch (kind) {
    case Kind::body_motion:
    case Kind::esc_state:
    case Kind::uart_frame:
    case Kind::fault:
    case Kind::end_of_run:
    case Kind::shaft_load:
    case Kind::i2c_order:
    case Kind::pulse_train:
    case Kind::rc_channels:
    case Kind::esc_setpoint:
    case Kind::uart_received:
    case Kind::i2c_transaction:
    case Kind::spi_transaction:
    case Kind::data_ready:
    case Kind::finding:
    case Kind::cpu_fault:
    case Kind::fault_applied:
    case Kind::function_call:
    case Kind::interrupt_latency:
    case Kind::statistics:
    case Kind::board_reset:
    case Kind::clock_setup:
    case Kind::busy_time:
    case Kind::shaft_state:
    case Kind::i2c_reply:
    case Kind::shoot_through:
    case Kind::uart_delivered:
    case Kind::gnss_solution:
    case Kind::bus_unread:
    case Kind::can_order:
    case Kind::can_transfer:
    case Kind::pin_edge:
    case Kind::instrument_reading:
    case Kind::emergency_stop:
    case Kind::signals:
      return true;
  }
  return false;
}

TEST(Fields, EveryKindIsListedOnce) {
  std::map<std::string_view, int> names;
  for (int number = 0; number < 256; ++number) {
    const KindInfo* info = kind_info(static_cast<Kind>(number));
    EXPECT_EQ(info != nullptr, has_to_be_listed(static_cast<Kind>(number))) << number;
    if (info == nullptr) continue;
    EXPECT_EQ(++names[info->name], 1) << info->name;
  }
}

// Between two fields there is padding at most: a member that the table lacks would be a hole.
TEST(Fields, TheyCoverTheirStruct) {
  for (int number = 0; number < 256; ++number) {
    const KindInfo* info = kind_info(static_cast<Kind>(number));
    if (info == nullptr || info->fields.empty()) continue;
    std::size_t end = 0;
    for (const Field& field : info->fields) {
      EXPECT_GE(field.offset, end) << info->name << " " << field.name;
      EXPECT_LT(field.offset, end + 8) << info->name << ": something before " << field.name;
      end = field.offset + field.count * size_of(field.type);
    }
    EXPECT_LE(end, info->size);
    EXPECT_GT(end + 8, info->size) << info->name << ": something at its end";
  }
}

std::span<const std::uint8_t> payload_of(const Batch& batch) {
  return batch.bytes().subspan(sizeof(Header));
}

TEST(Fields, AreWrittenWithTheirNamesAndTheTail) {
  Batch batch;
  const BusTransaction t{.start_ns = 5, .address = 0x29, .read = 1, .acked = 0, .length = 2};
  const std::uint8_t bytes[] = {0x6A, 0x01};
  const std::uint32_t times[] = {22'500, passed_ns(5, 5'000'000'005)};
  add_transaction(Kind::i2c_transaction, 3, 7, t, bytes, times, batch);
  EXPECT_EQ(fields_text(*kind_info(Kind::i2c_transaction), payload_of(batch)),
            "start_ns=5;address=41;read=1;acked=0;length=2;kept=2;bytes=6A01;passed_ns=22500 late");
  Reader read(batch.bytes());
  ASSERT_TRUE(read.next());
  EXPECT_EQ(std::vector<std::uint8_t>(read.transferred().begin(), read.transferred().end()),
            (std::vector<std::uint8_t>{0x6A, 0x01}));
  batch.clear();
  batch.add(Kind::shaft_load, 1, 0, ShaftLoad{-1.5e-9, 0.25, 16.4, 0.0});
  EXPECT_EQ(fields_text(*kind_info(Kind::shaft_load), payload_of(batch)),
            "torque_Nm_s2=-1.5e-09;brake_Nm=0.25;source_V=16.4;source_ohm=0");
  batch.clear();
  EscState state{1.0, -2.0, 5, {}};
  batch.add(Kind::esc_state, 1, 0, &state, 9);  // cut off within the second number
  EXPECT_TRUE(fields_text(*kind_info(Kind::esc_state), payload_of(batch))
                  .starts_with("bus_current_A=1;speed_rpm="));
  EXPECT_TRUE(fields_text(*kind_info(Kind::esc_state), payload_of(batch)).ends_with(";flags=0"));
}

TEST(Fields, TextsAndArraysReadAsSuch) {
  Batch batch;
  batch.add(Kind::finding, 0, 0, "spi1\0odd", 8);
  EXPECT_EQ(fields_text(*kind_info(Kind::finding), payload_of(batch)), "text=spi1 odd");
  batch.clear();
  BodyMotion motion;
  motion.p_WB_W_m[2] = -1.25;
  batch.add(Kind::body_motion, 0, 0, motion);
  EXPECT_NE(
      fields_text(*kind_info(Kind::body_motion), payload_of(batch)).find(";p_WB_W_m=0 0 -1.25;"),
      std::string::npos);
}

TEST(Fields, ABodysMotionEndsWithThrustsCurrentsAndUnbalance) {
  Batch batch;
  BodyMotion motion;
  motion.rotor_thrust_N[0] = 2.5;
  motion.rotor_bus_current_A[1] = 3.5;
  motion.battery_current_A = 12.25;
  motion.rotor_unbalance_m[3] = 0.5;
  batch.add(Kind::body_motion, 0, 0, motion);
  EXPECT_TRUE(
      fields_text(*kind_info(Kind::body_motion), payload_of(batch))
          .ends_with(";rotor_thrust_N=2.5 0 0 0 0 0 0 0 0 0 0 0"
                     ";rotor_bus_current_A=0 3.5 0 0 0 0 0 0 0 0 0 0;battery_current_A=12.25"
                     ";rotor_unbalance_m=0 0 0 0.5 0 0 0 0 0 0 0 0"));
}

}  // namespace
}  // namespace whirl::io
