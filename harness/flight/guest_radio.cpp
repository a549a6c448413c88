#include "harness/flight/guest_radio.hpp"

#include <algorithm>
#include <array>

#include "harness/flight/vehicle_system.hpp"
#include "io_bridges/protocols/mavlink_messages.hpp"

namespace whirl::flight {
namespace {

constexpr std::array<std::uint16_t, 3> kMoving{400, 22, 21};  // MAV_CMD: arm, take off, land

bool moves_the_vehicle(const io::MavlinkFrame& frame) {
  if (const auto target = io::unpack<io::SetPositionTargetLocalNed>(frame)) {
    return target->target_system == kVehicle;
  }
  const auto command = io::unpack<io::CommandLong>(frame);
  return command && command->target_system == kVehicle &&
         std::find(kMoving.begin(), kMoving.end(), command->command) != kMoving.end();
}

}  // namespace

bool GuestRadio::add(const std::vector<std::uint8_t>& bytes) {
  bool leads = false;
  io::MavlinkParser parser([&leads](const io::MavlinkFrame& frame, std::span<const std::uint8_t>) {
    leads = leads || moves_the_vehicle(frame);
  });
  for (const std::uint8_t byte : bytes) parser.add(byte);
  waiting_.push_back(bytes);
  return leads;
}

void GuestRadio::send(std::uint8_t board, std::uint16_t port, std::int64_t t_ns,
                      io::Batch& sensed) {
  for (const std::vector<std::uint8_t>& bytes : waiting_) {
    sensed.add({t_ns, io::Kind::uart_frame, board, port, 0}, {std::span(bytes)});
  }
  waiting_.clear();
}

}  // namespace whirl::flight
