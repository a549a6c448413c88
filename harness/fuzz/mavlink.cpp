// Fuzzes MAVLink frames in a stream: what is taken is encoded and taken again as the same.
#include "io_bridges/protocols/mavlink.hpp"

#include "base/check.hpp"
#include "io_bridges/protocols/mavlink_messages.hpp"

namespace {

using namespace whirl::io;

void check_frame(const MavlinkFrame& frame) {
  bool same = false;
  MavlinkParser parser([&](const MavlinkFrame& again, std::span<const std::uint8_t>) {
    same = again.msgid == frame.msgid && again.payload == frame.payload && again.seq == frame.seq;
  });
  for (const std::uint8_t byte : encode(frame)) parser.add(byte);
  WHIRL_CHECK(same, frame.msgid);
  if (const auto text = unpack<Statustext>(frame)) std::ignore = text->string();
  std::ignore = unpack<CommandLong>(frame);
  std::ignore = unpack<ViconPositionEstimate>(frame);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  MavlinkParser parser(
      [](const MavlinkFrame& frame, std::span<const std::uint8_t>) { check_frame(frame); });
  for (std::size_t i = 0; i < size; ++i) parser.add(data[i]);
  return 0;
}
