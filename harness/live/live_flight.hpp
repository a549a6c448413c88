// A flight that a MAVLink client watches and commands: paced to the host's clock, its radio bridged to UDP. Of a bench, which
// keeps its own pace, the radio is that of a physical board.
//
//   Down     each frame that the radio has received, of MAVLink 2 or 1, goes out as one datagram
//   Up       datagrams are looked for before each step: what has come is cut into pieces
//            (datagram_pieces.hpp), recorded, and goes into the radio with that step. The serial line to the
//            radio takes 5760 B/s and holds 1024 B, half of it for frames only: a flood loses what is beyond,
//            and so is a datagram of more than 1500 B; the loss is told of. Of a bench,
//            whose vehicle is at hand, datagrams of another host than the client's are left out and told of
//   Sticks   of a person's game controller, where there is one (pilot_stick.hpp): looked at each 20 ms, as a transmitter
//            does; what has changed goes to the vehicle's receiver and is recorded
//   Shown    once a second of the host: time, armed, mode, place, lateness
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "harness/executive/companion.hpp"
#include "harness/live/recording.hpp"
#include "harness/live/udp_port.hpp"
#include "harness/pacing/pacer.hpp"

namespace whirl::live {

struct LiveOptions {
  double pace = 1.0;                             // virtual seconds to one of the host
  bool waits = true;                             // false: the target keeps its own pace
  bool client_only = false;                      // what other hosts send is left out
  std::optional<std::int64_t> end_ns;            // virtual; none: until wants_end
  std::function<bool()> wants_end;               // asked before each step
  std::function<void(const std::string&)> show;  // the line of state
  std::function<request::Sticks()> sticks;       // null: nobody is at any
};

class LiveFlight final : public Companion {
 public:
  LiveFlight(pacing::HostClock& clock, UdpPort port, LiveOptions options);

  Result<bool> turn(std::int64_t t_ns, World& world) override;
  void on_happened(std::int64_t t_ns, const io::Batch& happened, const World& world) override;

  const Recording& recording() const { return recording_; }
  const pacing::Lateness& lateness() const { return pacer_.lateness(); }
  std::int64_t ended_ns() const { return ended_ns_; }
  // Of the world's signals, in SI; NaN: it has no such signal, or nothing was read yet.
  double last(const std::string& signal) const;
  // For the report: how well the pace was held, what went over UDP.
  std::vector<std::string> summary() const;

 private:
  Result<Done> take_in(std::int64_t t_ns, World& world);
  Result<Done> look_at_sticks(std::int64_t t_ns, World& world);
  void show_state(std::int64_t t_ns, const World& world);
  std::string state_line(std::int64_t t_ns) const;

  pacing::HostClock& clock_;
  pacing::Pacer pacer_;
  UdpPort port_;
  LiveOptions options_;
  Recording recording_;
  std::vector<std::string> names_;  // of the signals
  std::vector<double> values_;
  std::int64_t ended_ns_ = 0, next_shown_ns_ = 0, next_sticks_ns_ = 0;
  std::optional<request::Sticks> sticks_;  // as they were told last
  double line_free_B_;
  std::uint64_t datagrams_ = 0, of_others_ = 0, dropped_B_ = 0;
};

}  // namespace whirl::live
