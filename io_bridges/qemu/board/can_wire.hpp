// A CAN bus that several boards have: the end that arbitrates, with a wire to each of the others, and the end of a
// board that follows.
//
//   Arbiter   the bus of one of the boards (io_bridges/devices/can_bus.hpp). Every station of the others' buses has a place
//             there: microcontrollers, devices, a babbling node. So all arbitrate, acknowledge and count by one rule
//   Ahead     a board that has nothing to send runs on until the arbiter's bus could first tell it anything, whatever is
//             asked until then: the end of the frame on the wire, or CanBus::least_ahead_ns() after the bus is
//             free, 40 us at 1 Mbit/s. The arbiter's board stays behind all of them: it passes no nanosecond before
//             each has said what it asks until then
//   Sending   who offers a frame stands still until it is decided, at each start of frame that it could be: whether
//             its frame is on the wire it always knows
//   Exact     times of frames, arbitration lost, error frames, counters, bus-off, joining: as if all were on one board
//   Not exact a bus at rest wakes a sleeping controller kWake_ns after the start of frame. Two that send one base identifier at
//             once with other data, and a node of another rate in its first frame, may have it told late: a finding
//   Waiting   each waits for the other at times of virtual time alone, so what happens does not depend on who was
//             faster. Who arbitrates waits for reports, who follows for leave to go on; at a boundary both have it
#pragma once
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io_bridges/devices/can_bus.hpp"
#include "io_bridges/qemu/board/wire_site.hpp"

namespace whirl::board {

// Listens to what a far board is sent, and tells it to the device that the board takes the place of.
class CanEar final : io::CanArbiter {
 public:
  CanEar(io::EventQueue& events, const std::string& name) : bus_(events, name) {
    bus_.follow(*this);
  }
  io::CanBus& bus() { return bus_; }
  void receive(const io::CanFrame& frame);

 private:
  void configured(io::CanStation&) override {}
  void connected(io::CanStation& station, int idles) override;
  void disconnected(io::CanStation&) override {}
  void requested(io::CanStation& station) override;  // what it sends is gone

  io::CanBus bus_;
};

class CanLeader {
 public:
  static constexpr Nanoseconds kWake_ns = 40'000;

  CanLeader(WireSite site, io::CanBus& bus);
  ~CanLeader();
  const io::CanBus& bus() const { return bus_; }

  // number: of its stations on the bus, as faults and logs know them. `ear` may be null.
  void add(io::BoardWire wire, std::string name, int number, std::unique_ptr<CanEar> ear);
  void at_boundary(Nanoseconds now);
  void after_boundary(Nanoseconds now, Nanoseconds next);

 private:
  class Far;
  class FarNode;
  void hear();
  bool catch_up(Nanoseconds now);  // false: a wire is closed
  void plan(Nanoseconds now);
  void give_word();

  WireSite site_;
  io::CanBus& bus_;
  io::Event hear_, word_;
  std::vector<std::unique_ptr<Far>> boards_;
  Nanoseconds boundary_ns_ = 0;
};

class CanFollower final : io::CanArbiter {
 public:
  CanFollower(const WireSite& site, io::BoardWire wire, io::CanBus& bus);

  void after_boundary(Nanoseconds now, Nanoseconds next);
  void run_ends(Nanoseconds now);

 private:
  struct Offer {
    std::optional<io::CanFrame> told;
    bool on_wire = false;  // or in the arbitration
  };
  void configured(io::CanStation& station) override;
  void connected(io::CanStation& station, int idles) override;
  void disconnected(io::CanStation& station) override;
  void requested(io::CanStation& station) override;

  void pause();
  bool tell_offers();  // false: none has changed
  bool offers() const;
  void stop(Nanoseconds now);
  // Until it may go on. False: at a boundary, or the wire is closed.
  bool take_news(Nanoseconds now);
  void hear(const io::WireMessage& message, Nanoseconds now);
  void stir();
  void tell(io::WireCanAct act, io::WireCan can, bool more);

  WireSite site_;
  io::BoardWire wire_;
  io::CanBus& bus_;
  io::Event pause_, stir_;
  std::deque<Offer> offers_;  // by the station's place
  Nanoseconds go_until_ns_ = 0, boundary_ns_ = 0;
  bool at_boundary_ = true;  // and has leave to pass it
  std::int64_t late_ = 0;
  Nanoseconds latest_ns_ = 0;
};

}  // namespace whirl::board
