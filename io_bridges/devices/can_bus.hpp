// A CAN bus: one arbiter for all its nodes, in bit times.
//
//   Starts   a frame when the bus is free; all that have one at that instant arbitrate bit by bit.
//            What is requested later waits for the end of the intermission
//   Ends     of a good frame: the last bit of the end of frame, for its sender and its receivers alike
//            (ISO lets receivers have it one bit earlier). Of a bad one: error flags, as long as those
//            of all nodes together are, delimiter, intermission; its sender tries again by itself
//            A sender that is reset in its frame: what is left of it is recessive, so the frame fails; that
//            it does so at once, and not where the frame would have ended, is left out
//   Nodes    own their bit time. One that is off by more than CAN's oscillators may be (1.58 %) reads
//            nonsense: it breaks the others' frames, and they its own. That is a finding
//   Counters TEC and REC as ISO 11898-1 has them (error active, passive above 127, bus-off above 255);
//            after bus-off a node listens for 128 times eleven recessive bits, when it asks to rejoin
//   Faults   see CanFaults; a bit that is spoiled is spoiled for everybody
//   Joined   to a bus of another board: one of the two arbitrates, and the other one follows (CanArbiter)
//   Left out overload frames; a receiver's own local error (all see the same bits); the resynchronisation
//            of a node whose bit time is right
#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "io_bridges/devices/bus.hpp"
#include "io_bridges/devices/can_bits.hpp"
#include "io_bridges/protocols/can_frame.hpp"

namespace whirl::io {

enum class CanError : std::uint8_t {  // as bxCAN's LEC counts them
  none = 0,
  stuff = 1,
  form = 2,
  acknowledge = 3,
  bit_recessive = 4,  // sent recessive, saw dominant
  bit_dominant = 5,
  crc = 6,
};

class CanNode {
 public:
  virtual ~CanNode() = default;
  // What it has for the next start of frame, or null. Asked again after each: a frame is withdrawn by
  // no longer being offered, but not while it is on the wire.
  virtual const CanFrame* offered() = 0;
  virtual void begun(Nanoseconds /*now*/) {}  // it is on the wire, or in the arbitration
  virtual void sent(Nanoseconds now) = 0;
  virtual void receive(const CanFrame& frame, Nanoseconds now) = 0;
  virtual void lost_arbitration(Nanoseconds /*now*/) {}
  // Its counters have moved, `sending`: its own frame failed.
  virtual void failed(CanError /*error*/, bool /*sending*/, Nanoseconds /*now*/) {}
  virtual void counted(Nanoseconds /*now*/) {}  // they have, and nothing else
  virtual void bus_off(Nanoseconds /*now*/) {}
  virtual void joined(Nanoseconds /*now*/) {}   // takes part from here on
  virtual void stirred(Nanoseconds /*now*/) {}  // a frame begins, whether it takes part or not
};

// A node's place on its bus.
class CanStation {
 public:
  const std::string& name() const { return name_; }
  int number() const { return number_; }
  int place() const { return place_; }  // in the order in which they joined
  double bit_ns() const { return bit_ns_; }
  bool silent() const { return silent_; }
  int tec() const { return tec_; }
  int rec() const { return rec_; }
  bool passive() const { return tec_ > 127 || rec_ > 127; }
  bool is_bus_off() const { return bus_off_; }
  bool takes_part() const { return on_; }

 private:
  friend class CanBus;
  CanNode* node_ = nullptr;
  std::string name_;
  int number_ = kNobody, place_ = 0;
  double bit_ns_ = 1000.0;
  bool silent_ = false, alone_ = false;
  bool on_ = false, bus_off_ = false;
  int tec_ = 0, rec_ = 0;
  int idles_to_go_ = 0;  // runs of eleven recessive bits until it joins; 0: it does not wait
  Nanoseconds listens_since_ = 0;  // of those
  Nanoseconds may_send_ns_ = 0;    // suspended until then, or held by a fault
  bool held_ = false;
  bool hears_ = false;           // the frame that is on the wire
  std::unique_ptr<Event> stub_;  // sends into a cut wire until then

  static constexpr int kNobody = -1;
};

// What crossed the wire, good or not.
struct CanTransfer {
  CanFrame frame;
  int sender = -1;           // its number; -1: the microcontroller
  Nanoseconds start_ns = 0;  // start of frame
  Nanoseconds end_ns = 0;    // last bit before the intermission
  Nanoseconds busy_ns = 0;   // with it
  CanError error = CanError::none;
  int bit = 0;     // in error: its bit on the wire, stuff bits counted
  int losers = 0;  // that wanted to send at the same time
  int tec = 0;     // the sender's, after it
};

class CanFaults {
 public:
  virtual ~CanFaults() = default;
  virtual bool cut(int number, Nanoseconds now) = 0;           // its wire to the bus is open
  virtual bool acknowledged(int sender, Nanoseconds now) = 0;  // may the ACK pass?
  virtual bool spoiled(int sender, Nanoseconds now) = 0;       // a bit of this frame is inverted
  virtual bool lost(int receiver, Nanoseconds now) = 0;        // acknowledged, and yet not received
  virtual Nanoseconds held(int sender, Nanoseconds now) = 0;   // each frame waits so long before
};

// What a station of a bus that follows is told: the calls of CanNode, and what goes with them.
struct CanNews {
  enum class Call : std::uint8_t {
    begun,
    sent,
    receive,
    lost_arbitration,
    failed,
    bus_off,
    joined,
    stirred,
    counted
  };
  Call call = Call::counted;  // counted: only its counters have moved
  CanError error = CanError::none;
  bool sending = false;  // as failed() has it; of begun: it has won
  bool bus_off = false;
  int tec = 0, rec = 0;
  CanFrame frame = {};
};

// The bus that arbitrates, as one that follows sees it: what this one's stations ask goes there.
class CanArbiter {
 public:
  virtual ~CanArbiter() = default;
  virtual void configured(CanStation& station) = 0;
  virtual void connected(CanStation& station, int idles) = 0;
  virtual void disconnected(CanStation& station) = 0;
  virtual void requested(CanStation& station) = 0;
};

class CanBus {
 public:
  CanBus(EventQueue& queue, std::string name, FindingSink finding = {});

  // -1 is the microcontroller. A station takes no part until connect().
  CanStation& join(CanNode& node, std::string name, int number = -1);
  void set_faults(CanFaults* faults) { faults_ = faults; }
  void on_transfer(std::function<void(const CanTransfer&)> log) { log_ = std::move(log); }
  void set_finding(FindingSink finding) { finding_ = OnceFindings(std::move(finding)); }
  const std::string& name() const { return name_; }

  // silent: sends nothing at all, not even an ACK. alone: it acknowledges and hears its own frames
  // (bxCAN's loop-back).
  void configure(CanStation& station, double bit_ns, bool silent = false, bool alone = false);
  static constexpr int kIdles_after_bus_off = 128;
  // It joins after so many runs of eleven recessive bits: 1, or kIdles_after_bus_off. Its counters begin anew.
  void connect(CanStation& station, int idles);
  void disconnect(CanStation& station);
  // It has something to send.
  void request(CanStation& station);

  // The wire held dominant, and let go: all nodes flag errors until they are passive, a sender until
  // it is off the bus.
  void hold_dominant(Nanoseconds now);
  void release(Nanoseconds now);

  // It arbitrates no more. What stations have asked so far is passed on. Pre: nothing is on the wire.
  void follow(CanArbiter& arbiter);
  int stations() const { return static_cast<int>(stations_.size()); }
  CanStation& station(int place) { return stations_[static_cast<std::size_t>(place)]; }
  // What a station that takes part has to send, of a bus that follows; else null.
  const CanFrame* offer_of(CanStation& station);
  void hear(CanStation& station, const CanNews& news);

  // The first nanosecond at which the station may be told anything, whatever any other asks from now on: see
  // least_ahead_ns(). Its own requests are not foreseen. Pre: its node's offered() changes nothing.
  Nanoseconds untouched_until(CanStation& station) const;
  // All may be told something then: a fault of the wire begins.
  void foresee(Nanoseconds t) { foreseen_.insert(t); }
  // From a start of frame to what anybody is first told of it but its senders: 40 bits of the fastest node, which is a
  // base frame without data, a bit of its CRC spoiled, six bits of error flag and eight behind it; 19 where
  // a node reads another rate (six bits of its own, or more, and fourteen of the sender's). No more than at kFastest.
  Nanoseconds least_ahead_ns() const;
  static constexpr double kFastest_bit_ns = 1000.0;
  static constexpr int kLeastAhead_bits = 40, kLeastAheadMisread_bits = 19;

  bool busy() const { return busy_; }
  // On the wire right now.
  bool sends(const CanStation& station) const { return sender_ == &station; }

 private:
  // Counters: above the first a node is passive, above the second off the bus; REC stays at the third.
  static constexpr int kPassive = 127, kBusOff = 255, kHighest = 135;
  struct Verdict {
    CanError error = CanError::none;
    int bit = 0;                  // the last one before the first error flag
    CanStation* first = nullptr;  // who finds it
    bool inverted = false;        // that bit, by a fault
  };
  void start();
  void arbitrate(Nanoseconds now);
  bool may_send(CanStation& station, Nanoseconds now);
  bool connected(const CanStation& station, Nanoseconds now);
  void note_hearers(Nanoseconds now);
  static bool rates_fit(double bit_ns, double others_bit_ns);
  bool rate_fits(const CanStation& station) const { return rates_fit(station.bit_ns_, bit_ns_); }
  Verdict judge(const CanBits& bits, Nanoseconds now);
  template <typename Keep>
  void collide(const CanBits& bits, Keep keep);
  Verdict misread(const CanBits& bits, CanStation& by) const;
  int flag_bits(const CanBits& bits);
  void end();
  void finish(CanError error, Nanoseconds now);
  void deliver(Nanoseconds now);
  void hand_out(Nanoseconds now);
  void fail(Nanoseconds now);
  void count_error(CanStation& station, bool sending, CanError error, bool first, Nanoseconds now);
  void send_on_stub(CanStation& station, const CanFrame& frame);
  void retry_on_stub(CanStation& station);
  void plan_start(Nanoseconds t);
  void count_idle(Nanoseconds until);
  void plan_joining();
  Nanoseconds joins_at(const CanStation& station) const;
  void rejoin();
  void stay_dominant();
  Nanoseconds bits_ns(double count) const;

  EventQueue& queue_;
  std::string name_;
  OnceFindings finding_;
  CanFaults* faults_ = nullptr;
  std::function<void(const CanTransfer&)> log_;
  CanArbiter* arbiter_ = nullptr;  // elsewhere
  std::set<Nanoseconds> foreseen_;
  std::deque<CanStation> stations_;  // handed out by reference: they stay
  Event start_, end_, joining_, dominant_;

  bool busy_ = false, held_dominant_ = false;
  Nanoseconds free_ns_ = 0;                           // end of the last intermission
  Nanoseconds end_ns_ = -1, recessive_since_ns_ = 0;  // of the last frame
  CanStation* sender_ = nullptr;
  CanStation* twin_ = nullptr;             // sends the same identifier
  CanStation* dominant_sender_ = nullptr;  // whose frame was on the wire when it was held
  std::vector<CanStation*> losers_;
  CanTransfer current_;
  Verdict verdict_;
  double bit_ns_ = 1000.0;
};

}  // namespace whirl::io
