#include "harness/live/udp_port.hpp"

#include <gtest/gtest.h>

#include <string>

namespace whirl::live {
namespace {

std::string here(std::uint16_t port) {
  return "127.0.0.1:" + std::to_string(port);
}

std::vector<std::uint8_t> next(UdpPort& port) {
  const auto datagram = port.receive();
  return datagram ? std::vector<std::uint8_t>(datagram->begin(), datagram->end())
                  : std::vector<std::uint8_t>();
}

TEST(UdpPort, CarriesDatagramsBothWays) {
  auto far = UdpPort::open(here(9), 0);
  ASSERT_TRUE(far.ok());
  auto near = UdpPort::open(here(far.value().own_port()), 0);
  ASSERT_TRUE(near.ok());
  EXPECT_FALSE(near.value().receive().has_value());
  const std::vector<std::uint8_t> one{1, 2, 3}, large(1400, 7);
  near.value().send(one);
  near.value().send(large);
  EXPECT_EQ(near.value().sent(), 2u);
  EXPECT_EQ(next(far.value()), one);
  EXPECT_EQ(next(far.value()), large);
  EXPECT_FALSE(far.value().receive().has_value());
}

TEST(UdpPort, NobodyListeningIsNoError) {
  auto far = UdpPort::open(here(9), 0);
  const std::string gone = here(far.value().own_port());
  { const UdpPort closes = std::move(far.value()); }
  auto port = UdpPort::open(gone, 0);
  ASSERT_TRUE(port.ok());
  for (int i = 0; i < 10; ++i) port.value().send(std::vector<std::uint8_t>{1});
  EXPECT_EQ(port.value().sent() + port.value().not_sent(), 10u);
}

TEST(UdpPort, WrongAddressesAndTakenPortsAreRefused) {
  for (const char* peer :
       {"", "127.0.0.1", ":14550", "127.0.0.1:", "127.0.0.1:x", "no.such.host.invalid:1"}) {
    const auto port = UdpPort::open(peer, 0);
    ASSERT_FALSE(port.ok()) << peer;
    EXPECT_EQ(port.error().kind, ErrorKind::bad_input) << peer;
  }
  const auto first = UdpPort::open(here(9), 0);
  const auto second = UdpPort::open(here(9), first.value().own_port());
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.error().kind, ErrorKind::host);
}

}  // namespace
}  // namespace whirl::live
