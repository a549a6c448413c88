#include "io_bridges/devices/gnss_node.hpp"

#include <algorithm>

#include "io_bridges/protocols/dronecan/gnss.hpp"

namespace whirl::io {
namespace {

constexpr std::uint8_t kGnssNode_priority = 20;
constexpr Nanoseconds kGnssNode_boot_ns = 500'000'000, kGnssNode_look_ns = 2'000'000'000;
constexpr std::uint8_t kGnssNode_pvt = 0x07;

}  // namespace

GnssNode::GnssNode(EventQueue& queue, CanBus& bus, const DroneCanNode::Setup& node,
                   const Ublox::Params& part, Ublox::Sense sense, FaultBook* faults,
                   FindingSink findings)
    : queue_(queue),
      node_(queue, bus, node),
      part_(queue, part, std::move(sense), faults, std::move(findings)),
      parser_([this](const UbxFrame& frame) { on_frame(frame); }),
      look_(queue, [this] {
        if (!std::exchange(heard_, false)) set_up();
        look_.in(kGnssNode_look_ns);
      }) {
  part_.join([this](const UartByte& byte, const UartFormat&) { parser_.add(byte.value); });
  look_.in(kGnssNode_boot_ns);
}

void GnssNode::tell(const UbxFrame& frame) {
  for (const std::uint8_t byte : encode(frame)) {
    part_.receive({.value = byte}, {.baud = kBaud}, queue_.now());
  }
}

void GnssNode::set_up() {
  UbxPayload port;  // UART1, 8N1, UBX in and out
  port.put<std::uint16_t>(1).put<std::uint16_t>(0).put<std::uint32_t>(0x8D0).put(kBaud);
  port.put<std::uint16_t>(1).put<std::uint16_t>(1).zeros(4);
  tell({ublox::kCfg, 0x00, port.take()});
  UbxPayload rate;
  rate.put<std::uint16_t>(200).put<std::uint16_t>(1).put<std::uint16_t>(1);
  tell({ublox::kCfg, 0x08, rate.take()});
  UbxPayload model;  // dynModel and fixMode: airborne below 1 g, 3D
  model.put<std::uint16_t>(0x05).put<std::uint8_t>(6).put<std::uint8_t>(2).zeros(32);
  tell({ublox::kCfg, 0x24, model.take()});
  tell({ublox::kCfg, 0x01, {ublox::kNav, kGnssNode_pvt, 1}});
}

void GnssNode::on_frame(const UbxFrame& frame) {
  if (frame.message_class != ublox::kNav || frame.id != kGnssNode_pvt) return;
  heard_ = true;
  dronecan::Fix2 fix;
  const bool good = frame.get<std::uint8_t>(20) == 3 && (frame.get<std::uint8_t>(21) & 1) != 0;
  fix.status = good ? dronecan::Fix2::fix_3d : dronecan::Fix2::no_fix;
  fix.satellites = frame.get<std::uint8_t>(23);
  fix.longitude_1e8_deg = std::int64_t{10} * frame.get<std::int32_t>(24);
  fix.latitude_1e8_deg = std::int64_t{10} * frame.get<std::int32_t>(28);
  fix.height_ellipsoid_mm = frame.get<std::int32_t>(32);
  fix.height_sea_mm = frame.get<std::int32_t>(36);
  for (std::size_t i = 0; i < 3; ++i) {
    fix.v_WB_W_mps[i] = 1e-3f * static_cast<float>(frame.get<std::int32_t>(48 + 4 * i));
  }
  const auto squared = [&frame](std::size_t at) {  // of millimetres
    const float size = 1e-3f * static_cast<float>(frame.get<std::uint32_t>(at));
    return std::min(size * size, 65504.0f);  // the largest of 16 bits
  };
  const float level_m2 = squared(40) / 2.0f, down_m2 = squared(44),
              speed_m2ps2 = squared(68) / 2.0f;
  for (const float variance :
       {level_m2, level_m2, down_m2, speed_m2ps2, speed_m2ps2, speed_m2ps2}) {
    fix.covariance.add(variance);
  }
  fix.pdop = 0.01f * static_cast<float>(frame.get<std::uint16_t>(76));
  node_.send(fix, kGnssNode_priority);
}

}  // namespace whirl::io
