// A CAN bus that three boards have, and the same nodes on one bus.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <sstream>
#include <thread>

#include "io_bridges/devices/can_wire_faults.hpp"
#include "io_bridges/qemu/board/tests/two_boards.hpp"

namespace whirl::board {

using io::CanBus;
using io::CanFrame;
using io::EventQueue;
using io::FaultKind;

inline constexpr Nanoseconds kBit = 1000;
inline constexpr int kBus = 1;

// Writes down all that it is told. Sends in order; after bus-off it comes back.
class Scribe final : public io::CanNode {
 public:
  Scribe(EventQueue& events, CanBus& bus, const std::string& name, int number)
      : events_(events), bus_(bus), station_(bus.join(*this, name, number)) {}

  void come(double bit_ns) {
    bus_.configure(station_, bit_ns);
    bus_.connect(station_, 1);
  }
  void go() {
    on_wire_ = false;
    bus_.disconnect(station_);
  }
  void send(const CanFrame& frame) {
    queue_.push_back(frame);
    bus_.request(station_);
  }
  void drop() { queue_.clear(); }
  const std::string& told() const { return told_; }
  std::string counters() const {
    return std::to_string(station_.tec()) + " " + std::to_string(station_.rec()) +
           (station_.is_bus_off() ? " off" : "") + (station_.takes_part() ? " on" : " away");
  }

 private:
  const CanFrame* offered() override {
    if (!on_wire_ && !queue_.empty()) out_ = queue_.front();
    return on_wire_ || queue_.empty() ? nullptr : &out_;
  }
  void begun(Nanoseconds now) override {
    on_wire_ = true;
    say(now, bus_.sends(station_) ? "begun" : "begun, lost");
  }
  void sent(Nanoseconds now) override {
    on_wire_ = false;
    if (!queue_.empty()) queue_.pop_front();
    say(now, "sent");
  }
  void receive(const CanFrame& frame, Nanoseconds now) override {
    say(now, "got " + std::to_string(frame.id) + " " + std::to_string(frame.length) + " " +
                 std::to_string(frame.data[7]));
  }
  void lost_arbitration(Nanoseconds now) override {
    on_wire_ = false;
    say(now, "lost");
  }
  void failed(io::CanError error, bool sending, Nanoseconds now) override {
    if (sending) on_wire_ = false;
    say(now, "failed " + std::to_string(static_cast<int>(error)) + (sending ? " sending" : ""));
  }
  void bus_off(Nanoseconds now) override {
    say(now, "bus-off");
    bus_.connect(station_, CanBus::kIdles_after_bus_off);
  }
  void joined(Nanoseconds now) override { say(now, "joined"); }
  void say(Nanoseconds now, const std::string& what) {
    told_ += std::to_string(now) + " " + what + " (" + counters() + ")\n";
  }

  EventQueue& events_;
  CanBus& bus_;
  io::CanStation& station_;
  std::deque<CanFrame> queue_;
  CanFrame out_;
  bool on_wire_ = false;
  std::string told_;
};

// What happens to a node from outside.
struct Deed {
  Nanoseconds t_ns = 0;
  std::size_t node = 0;
  std::function<void(Scribe&)> act;
  io::Rank rank = io::Rank::own;
};

struct Script {
  std::vector<Deed> deeds;
  std::vector<io::Fault> faults;
  int grains = 4;

  void send(std::size_t node, Nanoseconds t_ns, std::uint32_t id, std::uint8_t length = 0) {
    CanFrame frame;
    frame.id = id;
    frame.extended = id > 0x7FF;
    frame.length = length;
    for (unsigned i = 0; i < length; ++i) frame.data[i] = static_cast<std::uint8_t>(id * 7 + i);
    deeds.push_back({t_ns, node, [frame](Scribe& scribe) { scribe.send(frame); }});
  }
  void come(std::size_t node, Nanoseconds t_ns, double bit_ns = 1000.0) {
    deeds.push_back({t_ns, node, [bit_ns](Scribe& scribe) { scribe.come(bit_ns); }});
  }
  void go(std::size_t node, Nanoseconds t_ns) {
    deeds.push_back({t_ns, node, [](Scribe& scribe) { scribe.go(); }});
  }
  void drop(std::size_t node, Nanoseconds t_ns) {
    deeds.push_back({t_ns, node, [](Scribe& scribe) { scribe.drop(); }});
  }
  void fault(FaultKind kind, Nanoseconds from, Nanoseconds to, double value = 0.0,
             int address = io::kAnywhere) {
    faults.push_back({.number = static_cast<std::uint32_t>(faults.size() + 1),
                      .kind = kind,
                      .start_ns = from,
                      .end_ns = to,
                      .bus = kBus,
                      .address = address,
                      .value = value});
  }
};

// Nodes 0 and 1 are the arbiter's own, 2 and 3 of the second board, 4 of the third one.
inline constexpr std::size_t kNodes = 5;
inline constexpr int kNumbers[kNodes] = {-1, 0, 1, 1, 2};
inline constexpr const char* kNames[kNodes] = {"node0", "node1", "node2", "node2, 1", "node4"};
inline constexpr std::size_t kBoard_of[kNodes] = {0, 0, 1, 1, 2};

// One board: its nodes and what happens to them.
struct Place {
  EventQueue events;
  std::vector<io::Finding> findings;
  bool closed = false;
  CanBus bus{events, "can1", [this](const io::Finding& f) { findings.push_back(f); }};
  io::FaultBook book;
  std::unique_ptr<io::CanWireFaults> faults;
  std::vector<std::string> log;
  std::deque<Scribe> scribes;
  std::vector<std::unique_ptr<io::Event>> deeds;

  void arbitrates(const Script& script) {
    faults = std::make_unique<io::CanWireFaults>(events, book, bus, kBus, 1000.0);
    bus.on_transfer([this](const io::CanTransfer& t) {
      std::ostringstream line;
      line << t.start_ns << ' ' << t.end_ns << ' ' << t.busy_ns << " id " << t.frame.id << " from "
           << t.sender << " error " << static_cast<int>(t.error) << " bit " << t.bit << " losers "
           << t.losers << " tec " << t.tec;
      log.push_back(line.str());
    });
    for (const io::Fault& fault : script.faults) book.add(fault);
  }
  Scribe& scribe(std::size_t node) {
    return scribes.emplace_back(events, bus, kNames[node], kNumbers[node]);
  }
  void plan(const Deed& deed, Scribe& scribe) {
    deeds.push_back(std::make_unique<io::Event>(
        events, [&scribe, deed] { deed.act(scribe); }, deed.rank));
    deeds.back()->at(deed.t_ns);
  }
};

struct Seen {
  std::vector<std::string> log, told, counters, findings;
  bool operator==(const Seen&) const = default;
};

inline void add(const Place& place, const std::vector<Scribe*>& scribes, Seen& seen) {
  for (const Scribe* scribe : scribes) {
    seen.told.push_back(scribe->told());
    seen.counters.push_back(scribe->counters());
  }
  for (const auto& f : place.findings)
    seen.findings.push_back(std::to_string(f.t_ns) + " " + f.what);
  seen.log.insert(seen.log.end(), place.log.begin(), place.log.end());
}

inline Seen on_one_bus(const Script& script) {
  Place place;
  place.arbitrates(script);
  std::vector<Scribe*> scribes;
  for (std::size_t n = 0; n < kNodes; ++n) scribes.push_back(&place.scribe(n));
  for (const Deed& deed : script.deeds) place.plan(deed, place.scribes[deed.node]);
  place.events.run_until(script.grains * kGrain_ns);
  Seen seen;
  add(place, scribes, seen);
  return seen;
}

// Not `Board`: that is the virtual board itself, in this namespace.
struct BoardOnBus : Place {
  WireEnds ends{
      {events, [this](const io::Finding& f) { findings.push_back(f); }, [this] { closed = true; }}};
  void step(Nanoseconds from, Nanoseconds to) { wired_step(events, ends, from, to, closed); }
};

class ThreeBoards {
 public:
  explicit ThreeBoards(const Script& script) : grains_(script.grains) {
    boards_[0].arbitrates(script);
    for (std::size_t n = 0; n < kNodes; ++n) scribes_.push_back(&boards_[kBoard_of[n]].scribe(n));
    for (int b = 1; b < 3; ++b) {
      auto& wire = wires_.emplace_back(std::move(io::BoardWire::create(99).value()));
      EXPECT_TRUE(boards_[0].ends.arbitrate(dup(wire.fd()), boards_[0].bus,
                                            "node" + std::to_string(b == 1 ? 2 : 4), b, nullptr));
      EXPECT_TRUE(boards_[b].ends.share(dup(wire.fd()), boards_[b].bus));
    }
    for (const Deed& deed : script.deeds) {
      boards_[kBoard_of[deed.node]].plan(deed, *scribes_[deed.node]);
    }
  }
  BoardOnBus& board(std::size_t number) { return boards_[number]; }
  io::BoardWire& wire(std::size_t number) { return wires_[number - 1]; }

  // All but that one stand, for what it would say.
  bool all_wait(std::size_t but) const {
    if (but != 0 && !wires_[but - 1].leader_waits()) return false;
    for (std::size_t b = 1; b < 3; ++b) {
      if (b != but && !wires_[b - 1].follower_waits()) return false;
    }
    return true;
  }

  // Until grain `to`, all boards but `but`.
  void run(int from, int to, int but = -1) {
    for (int k = from; k < to; ++k) {
      std::vector<std::thread> threads;
      for (int b = 0; b < 3; ++b) {
        if (b == but) continue;
        threads.emplace_back([this, b, k] { boards_[b].step(k * kGrain_ns, (k + 1) * kGrain_ns); });
      }
      for (std::thread& thread : threads) thread.join();
    }
  }
  Seen seen() {
    run(0, grains_);
    Seen seen;
    for (BoardOnBus& board : boards_) board.ends.run_ends(grains_ * kGrain_ns);
    add(boards_[0], scribes_, seen);
    for (int b = 1; b < 3; ++b) add(boards_[b], {}, seen);
    return seen;
  }

 private:
  int grains_;
  BoardOnBus boards_[3];
  std::deque<io::BoardWire> wires_;
  std::vector<Scribe*> scribes_;
};

}  // namespace whirl::board
