// The bench as the ground's end of a flight controller's MAVLink, on a serial line of this host: a telemetry radio, or a
// cable to its UART.
//
//   Down     each whole frame is a message of its own, of the time at which its last byte was read here. What an adapter
//            holds back and a radio takes is in that time
//   Up       a frame leaves when it is due, behind those that are on the line. uart_delivered follows when its last stop bit
//            has left this host's end, by the baud rate; a radio's air comes behind that. One that would wait longer than
//            200 ms for the line is dropped, counted and told, as a radio without room drops it
//   Broken   bytes outside of frames, and frames that are missing by their numbers, of each sender by itself, are told once
//            when the run is over. Bytes before the first frame are none of these: the line was joined in the midst of one
//   Deaf     more bytes than the longest frame has, and no frame within 5 s: the run ends. No byte at all: it goes on, for
//            that may be the firmware's doing, and is told
//   Safe     nothing goes out any more
//   Errors   bad_input: the line cannot be opened, or is deaf, most likely by its rate; host: it was unplugged
#pragma once
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/target/bench/bench_description.hpp"
#include "harness/target/bench/link.hpp"
#include "io_bridges/protocols/mavlink.hpp"
#include "io_bridges/serial/tty.hpp"

namespace whirl::bench {

class MavlinkLine final : public Link {
 public:
  static constexpr std::int64_t kDeaf_ns = 5'000'000'000, kMost_wait_ns = 200'000'000;  // virtual
  static constexpr std::size_t kLongest_frame_B = 280;

  struct Counts {
    std::uint64_t bytes = 0, frames = 0;
    std::uint64_t outside_B = 0;  // of frames, since the first one
    std::uint64_t missing = 0;    // by their numbers
    std::uint64_t dropped = 0;    // of those for the board
  };

  // pace: of the bench. At half of it a line carries half as much in a second of the host.
  explicit MavlinkLine(SerialLink link, double pace = 1.0);

  std::string name() const override { return link_.name; }
  Result<Done> open() override;
  void keep_time(BenchTime time) override { time_ = std::move(time); }
  bool take(const io::Reader& order, std::int64_t due_host_ns) override;
  Result<Done> serve(std::int64_t now_host_ns, Arrivals& arrivals) override;
  std::int64_t next_due_host_ns() const override;
  int file() const override { return tty_ ? tty_->file() : -1; }
  void make_safe() override;
  void close() override { tty_.reset(); }
  std::vector<std::pair<std::string, std::string>> versions() const override;
  std::vector<std::string> findings() const override;

  Counts counts() const;
  // Once it is: it has heard bytes enough, and no frame.
  Error deaf(const std::string& within) const;

 private:
  struct Frame {
    std::int64_t host_ns = 0;  // due, or over
    std::vector<std::uint8_t> bytes;
  };
  Result<Done> send_due(std::int64_t now_host_ns);
  void tell_delivered(std::int64_t now_host_ns, Arrivals& arrivals);
  Result<Done> take_in(std::int64_t now_host_ns, Arrivals& arrivals);
  void hear(const io::MavlinkFrame& frame);
  Result<Done> check_heard(std::int64_t now_host_ns);

  SerialLink link_;
  double pace_;
  std::optional<io::Tty> tty_;
  BenchTime time_;
  io::MavlinkParser parser_;
  std::vector<std::vector<std::uint8_t>> frames_;        // of one turn
  std::map<std::pair<int, int>, std::uint8_t> numbers_;  // the last of each sender
  std::deque<Frame> waiting_, delivering_;               // in order of time
  std::int64_t free_host_ns_ = 0;                        // the line, of what was written
  std::uint64_t before_first_B_ = 0;
  bool safe_ = false;
  Counts counts_;
};

}  // namespace whirl::bench
