// A ground station, what it sends, and a vehicle that answers by hand.
#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "harness/flight/station.hpp"
#include "harness/flight/tests/milliseconds.hpp"

namespace whirl::flight {

struct Air {
  Station station;
  std::vector<io::MavlinkFrame> sent;
  std::vector<std::int64_t> times;
  io::MavlinkSender vehicle{1, 1, 0};
  io::MavlinkParser parser{
      [this](const io::MavlinkFrame& f, std::span<const std::uint8_t>) { sent.push_back(f); }};
  Station::Send send = [this](std::int64_t t_ns, std::span<const std::uint8_t> frame) {
    times.push_back(t_ns);
    for (const std::uint8_t byte : frame) parser.add(byte);
  };

  void run(std::int64_t from_ms, std::int64_t to_ms) {
    for (std::int64_t ms = from_ms; ms < to_ms; ++ms) station.step(ms * kMs, send);
  }
  template <typename Message>
  void vehicle_says(const Message& message, std::int64_t t_ns) {
    station.receive(io::encode(io::pack(message, vehicle)), t_ns);
  }
};

}  // namespace whirl::flight
