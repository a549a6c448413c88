// A telemetry radio between the MCU's UART and a ground station that talks MAVLink.
//
//   Up       frames given with their earliest time; each waits for the air, may be lost on it
//            (seeded), then goes to the MCU byte by byte at the radio's own baud rate; its last stop
//            bit is told
//   Down     what the MCU sends is parsed; each whole frame is handed over with the time of its
//            last stop bit, unless the air loses it
//   Air      half duplex: both directions share air_bytes_per_s; a direction whose frames wait
//            longer than buffer_ns allows loses the frame, and that is a finding
//   Findings overrun of the air; bytes outside frames; a baud rate or format that does not fit
//   Left out the radio's own time slots and injected status packets
#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "base/random.hpp"
#include "io_bridges/devices/bus.hpp"
#include "io_bridges/protocols/mavlink.hpp"

namespace whirl::io {

class MavlinkLink : public UartPeer {
 public:
  struct Params {
    double baud = 57600.0;
    double uplink_loss = 0.0;    // probability per frame
    double downlink_loss = 0.0;  // probability per frame
    double air_bytes_per_s = 5760.0;
    Nanoseconds buffer_ns = 200'000'000;
    std::uint64_t seed = 1;
  };
  struct Counts {
    std::uint64_t up = 0, up_lost = 0, down = 0, down_lost = 0, overruns = 0;
    double air_busy_s = 0.0;
  };
  using FrameSink = std::function<void(std::span<const std::uint8_t> frame, Nanoseconds t_ns)>;

  MavlinkLink(EventQueue& queue, const Params& params, FindingSink findings);

  void on_frame(FrameSink sink) { sink_ = std::move(sink); }
  void on_delivered(FrameSink sink) { delivered_ = std::move(sink); }
  // Bytes of one frame, to be sent no earlier than t_ns.
  void send_frame(std::span<const std::uint8_t> bytes, Nanoseconds t_ns);
  void receive(const UartByte& byte, const UartFormat& format, Nanoseconds now) override;

  const Counts& counts() const { return counts_; }
  const MavlinkParser::Counts& parser_counts() const { return parser_.counts(); }

 private:
  struct Waiting {
    Nanoseconds t_ns;
    std::vector<std::uint8_t> bytes;
  };
  bool takes_air(std::size_t bytes, Nanoseconds now, const char* direction);
  void next_frame();
  void next_byte();
  void frame_down(std::span<const std::uint8_t> raw);
  void check_format(const UartFormat& format, Nanoseconds now);
  void note_stray(Nanoseconds now);
  void report(Nanoseconds now, std::string what);

  EventQueue& queue_;
  Params params_;
  FindingSink findings_;
  FrameSink sink_, delivered_;
  MavlinkParser parser_;
  RandomStream up_loss_, down_loss_;
  std::deque<Waiting> waiting_;                   // uplink frames, in order of time
  std::deque<std::vector<std::uint8_t>> to_mcu_;  // under way on the serial line
  std::size_t sent_ = 0;                          // bytes of the first of them
  Event frame_due_, byte_due_;
  Nanoseconds air_free_ns_ = 0;
  Nanoseconds heard_ns_ = 0;
  bool stray_told_ = false, format_told_ = false;
  Counts counts_;
};

}  // namespace whirl::io
