// What the kernel says of an interface, read from messages laid out by hand as its headers have them, and each
// refusal of a bench.
#include "io_bridges/socketcan/can_interface.hpp"

#include <gtest/gtest.h>

#include <cerrno>

#include "io_bridges/socketcan/error_frame.hpp"
#include "io_bridges/socketcan/tests/link_message.hpp"

namespace whirl::io {
namespace {

std::string why(const std::optional<CanInterface>& found, std::uint32_t bps) {
  const auto good = check_can_interface("can0", found, bps);
  return good ? "" : good.error().message();
}

TEST(CanInterface, AControllerIsReadWithItsRateStateAndCounters) {
  const auto found = parse_link_message(
      link_message(ARPHRD_CAN, IFF_UP, "can", controller_at(500'000, CAN_STATE_ERROR_PASSIVE)));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->name, "can0");
  EXPECT_EQ(found->index, 7);
  EXPECT_TRUE(found->is_can && found->up);
  EXPECT_EQ(found->bit_rate_bps, 500'000u);
  EXPECT_EQ(found->state, CanBusState::passive);
  EXPECT_EQ(found->restart_ms, 100u);
  EXPECT_EQ(found->transmit_errors, 130);
  EXPECT_EQ(found->receive_errors, 4);
}

TEST(CanInterface, ATornMessageIsReadAsFarAsItGoesOrNotAtAll) {
  const Bytes whole =
      link_message(ARPHRD_CAN, IFF_UP, "can", controller_at(500'000, CAN_STATE_ERROR_ACTIVE));
  for (std::size_t n = 0; n < whole.size(); ++n) {
    EXPECT_FALSE(parse_link_message(std::span(whole).first(n))) << n;
  }
  Bytes torn = whole;
  for (std::size_t at = sizeof(nlmsghdr) + sizeof(ifinfomsg); at < whole.size(); ++at) {
    torn[at] = 0xFF;
    std::ignore = parse_link_message(torn);  // no more than what is there is read
  }
}

TEST(CanInterface, EachRefusalSaysWhatIsWrongAndWhatHelps) {
  const auto active = controller_at(1'000'000, CAN_STATE_ERROR_ACTIVE);
  const auto up = parse_link_message(link_message(ARPHRD_CAN, IFF_UP, "can", active));
  EXPECT_EQ(why(up, 1'000'000), "");
  EXPECT_EQ(why(up, 0), "");
  EXPECT_NE(why(up, 500'000).find("runs at 1000000 bit/s, and 500000 are wanted"),
            std::string::npos);
  EXPECT_NE(why(std::nullopt, 0).find("no such CAN interface"), std::string::npos);
  const auto down = parse_link_message(link_message(ARPHRD_CAN, 0, "can", active));
  EXPECT_NE(why(down, 500'000).find("is down"), std::string::npos);
  EXPECT_NE(why(down, 500'000).find("bitrate 500000"), std::string::npos);
  const auto ethernet = parse_link_message(link_message(ARPHRD_ETHER, IFF_UP, "veth", {}));
  EXPECT_NE(why(ethernet, 0).find("is no CAN interface"), std::string::npos);
  const auto off = parse_link_message(
      link_message(ARPHRD_CAN, IFF_UP, "can", controller_at(1'000'000, CAN_STATE_BUS_OFF)));
  EXPECT_NE(why(off, 0).find("bus-off"), std::string::npos);
  const auto virtual_one = parse_link_message(link_message(ARPHRD_CAN, IFF_UP, "vcan", {}));
  EXPECT_EQ(why(virtual_one, 1'000'000), "");
}

TEST(CanInterface, WithoutASocketTheCauseIsSaid) {
  const std::pair<int, const char*> all[] = {{EAFNOSUPPORT, "no CAN (AF_CAN)"},
                                             {EPERM, "no permission"},
                                             {ENODEV, "no such CAN interface"},
                                             {ENETDOWN, "is down"},
                                             {EBUSY, "held by another program"}};
  for (const auto& [error, says] : all) {
    const Error refusal = why_no_can_socket("can0", error);
    EXPECT_EQ(refusal.kind, ErrorKind::bad_input);
    EXPECT_NE(refusal.message().find(says), std::string::npos) << refusal.message();
  }
}

TEST(CanInterface, ThisHostAnswersForItsLoopback) {
  const auto found = read_can_interface("lo");
  ASSERT_TRUE(found.ok()) << found.error().message();
  ASSERT_TRUE(found.value());
  EXPECT_FALSE(found.value()->is_can);
  const auto none = read_can_interface("nosuchbus0");
  ASSERT_TRUE(none.ok());
  EXPECT_FALSE(none.value());
}

TEST(CanErrorFrame, SaysWhatTheControllerSays) {
  const CanTrouble off = parse_error_frame(0x20000040, {});
  EXPECT_TRUE(off.bus_off);
  EXPECT_EQ(off.state, CanBusState::bus_off);
  const CanTrouble alone = parse_error_frame(0x200000A8, {0, 0, 0x80, 0x19, 0, 0, 96, 3});
  EXPECT_TRUE(alone.no_acknowledge && alone.protocol && alone.bus_error);
  EXPECT_EQ(alone.transmit_errors, 96);
  const CanTrouble passive = parse_error_frame(0x20000204, {0, 0x20, 0, 0, 0, 0, 128, 0});
  EXPECT_EQ(passive.state, CanBusState::passive);
  EXPECT_EQ(passive.transmit_errors, 128);
  EXPECT_EQ(passive.receive_errors, 0);
  EXPECT_EQ(alone.receive_errors, 3);
  EXPECT_TRUE(parse_error_frame(0x20000001, {}).transmit_time_out);
  EXPECT_TRUE(parse_error_frame(0x20000010, {}).transceiver);
  EXPECT_FALSE(alone.transmit_time_out || alone.transceiver);
  EXPECT_TRUE(parse_error_frame(0x20000004, {0, 0x01}).receive_overflow);
  EXPECT_EQ(parse_error_frame(0x20000100, {}).state, CanBusState::active);
  EXPECT_NE(text_of(alone).find("nobody acknowledges"), std::string::npos);
}

}  // namespace
}  // namespace whirl::io
