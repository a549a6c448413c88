// The bench as the ground's end of a flight controller's MAVLink, on a serial line of this host: a telemetry radio, or a
// cable to its UART.
//
//   Down     each whole frame, of MAVLink 2 or 1, is a message of its own, of the time at which its last byte was read here.
//            What an adapter holds back and a radio takes is in that time. Behind one whose length is spoilt, or whose end
//            is lost, frames are read when as many bytes as it promises have come
//   Up       a frame leaves when it is due, behind those that are on the line. uart_delivered follows when its last stop bit
//            has left this host's end, by the baud rate; a radio's air comes behind that. One that would wait longer than
//            200 ms for the line is dropped, counted and told, as a radio without room drops it
//   Broken   bytes outside of frames, and frames that are missing by their numbers (which count to 255), of each sender by
//            itself, are told once when the run is over; so is the longest stretch of more bytes than the longest frame has
//            without a frame, as one of another rate is. Bytes before the first frame are none of these: the line was joined
//            in the midst of one
//   Rate     never a frame, 5 s after more bytes have come than the longest one has: the run ends. No byte at all, or no frame
//            any more: it goes on, for that may be the firmware's doing, and is told
//   Safe     nothing goes out any more, of a frame that has begun neither
//   Errors   bad_input: the line cannot be opened, or is at another rate; host: it was unplugged
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
  static constexpr std::int64_t kNo_frame_ns = 5'000'000'000,
                                kMost_wait_ns = 200'000'000;  // virtual
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
  // Of a line that had bytes enough, and no frame. within: "", " in 5 s".
  Error no_frames(const std::string& within) const;

 private:
  struct Frame {
    std::int64_t host_ns = 0;  // due, or over
    std::vector<std::uint8_t> bytes;
  };
  struct Stretch {                        // from one frame to the next, without any between them
    std::int64_t from_ns = 0, to_ns = 0;  // virtual
    std::uint64_t bytes = 0;              // outside of frames
  };
  Result<Done> send_due(std::int64_t now_host_ns);
  void publish_delivered(std::int64_t now_host_ns, Arrivals& arrivals);
  Result<Done> read_bytes();
  void publish_frames(std::int64_t now_host_ns, Arrivals& arrivals);
  void on_frame(const io::MavlinkFrame& frame);
  Result<Done> check_rate() const;
  Stretch since_last_frame() const;

  SerialLink link_;
  double pace_;
  std::optional<io::Tty> tty_;
  BenchTime time_;
  io::MavlinkParser parser_;
  std::vector<std::vector<std::uint8_t>> frames_;        // of one turn
  std::map<std::pair<int, int>, std::uint8_t> numbers_;  // the last of each sender
  std::deque<Frame> waiting_, delivering_;               // in order of time
  std::int64_t free_host_ns_ = 0;                        // the line, of what was written
  std::int64_t now_ns_ = 0;                              // virtual, of this turn
  std::int64_t last_frame_ns_ = 0;                       // virtual
  std::optional<std::int64_t> enough_ns_;                // virtual: more bytes than a frame has
  std::uint64_t before_first_B_ = 0, before_last_B_ = 0;
  Stretch longest_;  // that a frame has ended
  bool safe_ = false;
  Counts counts_;
};

}  // namespace whirl::bench
