// Fuzzes DroneCAN: frames of any bytes to transfers, and what decodes is encoded to the same payload again.
#include <algorithm>

#include "base/check.hpp"
#include "io_bridges/protocols/dronecan/allocation.hpp"
#include "io_bridges/protocols/dronecan/esc.hpp"
#include "io_bridges/protocols/dronecan/esc_extended.hpp"
#include "io_bridges/protocols/dronecan/gnss.hpp"
#include "io_bridges/protocols/dronecan/imu_samples.hpp"
#include "io_bridges/protocols/dronecan/param.hpp"
#include "io_bridges/protocols/dronecan/pod.hpp"
#include "io_bridges/protocols/dronecan/sensors.hpp"
#include "io_bridges/protocols/dronecan/types.hpp"
#include "io_bridges/protocols/dronecan/vehicle_state.hpp"

namespace {

using namespace whirl::io;
using namespace whirl::io::dronecan;

// Bits that the layout calls void, and NaN patterns, may come back otherwise: sizes may not.
template <typename Message>
void check(std::span<const std::uint8_t> payload) {
  const auto message = decode<Message>(payload);
  if (!message) return;
  const Payload again = encode(*message);
  WHIRL_CHECK(again.size == payload.size(), again.size, payload.size());
  const auto twice = decode<Message>(again.bytes());
  WHIRL_CHECK(twice.has_value());
  WHIRL_CHECK(std::ranges::equal(encode(*twice).bytes(), again.bytes()));
}

template <typename... Messages>
void check_as_any(std::span<const std::uint8_t> payload) {
  (check<Messages>(payload), ...);
}

void check_all(std::span<const std::uint8_t> payload) {
  check_as_any<NodeStatus, GetNodeInfoRequest, GetNodeInfoResponse, Allocation, RawCommand,
               RpmCommand, EscStatus, EscStatusExtended, RawImu, MagneticFieldStrength2,
               StaticPressure, StaticTemperature, Fix2, BatteryInfo, ArmingStatus, GetSetRequest,
               GetSetResponse, Imu14, Imu16, PodSample, PodFrame, PodSetpoint>(payload);
}

}  // namespace

// All of it as a payload of every type; then as frames of 14 bytes: identifier, length, time, data.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  check_all({data, std::min(size, kMost_payload)});
  Assembler assembler(known_type, 1);
  std::int64_t now_ns = 0;
  for (std::size_t at = 0; at + 14 <= size; at += 14) {
    const std::uint8_t* p = data + at;
    CanFrame frame{
        .id = p[0] | p[1] << 8 | p[2] << 16 | static_cast<std::uint32_t>(p[3] & 0x1F) << 24,
        .extended = (p[3] & 0x80) == 0,
        .remote = (p[3] & 0x40) != 0,
        .length = static_cast<std::uint8_t>(p[4] & 0x0F)};
    now_ns += p[5] * std::int64_t{10'000'000};
    std::copy_n(p + 6, 8, frame.data.begin());
    if (const Transfer* transfer = assembler.take(frame, now_ns)) check_all(transfer->payload);
  }
  const TransferCounts& c = assembler.counts();
  WHIRL_CHECK(c.transfers <= c.frames);
  return 0;
}
