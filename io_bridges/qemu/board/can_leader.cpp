// The end of a joined CAN bus that arbitrates.
#include <algorithm>

#include "base/check.hpp"
#include "io_bridges/qemu/board/can_frames.hpp"
#include "io_bridges/qemu/board/can_wire.hpp"

namespace whirl::board {

using io::CanNews;
using io::WireAct;
using io::WireCanAct;
using io::WireEdge;
using Call = io::CanNews::Call;

// A station of a far board's bus.
class CanLeader::FarNode final : public io::CanNode {
 public:
  FarNode(Far& board, io::CanBus& bus, const std::string& name, int number, std::uint8_t place)
      : board_(board), bus_(bus), station_(bus.join(*this, name, number)), place_(place) {}
  void act(const WireEdge& asked);
  io::CanStation& station() { return station_; }
  const io::CanStation& station() const { return station_; }

 private:
  const io::CanFrame* offered() override { return offer_ ? &*offer_ : nullptr; }
  void begun(Nanoseconds now) override {
    tell(now, {.call = Call::begun, .sending = bus_.sends(station_)});
  }
  void sent(Nanoseconds now) override {
    offer_.reset();
    tell(now, {.call = Call::sent});
  }
  void receive(const io::CanFrame& frame, Nanoseconds now) override;
  void lost_arbitration(Nanoseconds now) override { tell(now, {.call = Call::lost_arbitration}); }
  void failed(io::CanError error, bool sending, Nanoseconds now) override {
    tell(now, {.call = Call::failed, .error = error, .sending = sending});
  }
  void counted(Nanoseconds now) override { tell(now, {.call = Call::counted}); }
  void bus_off(Nanoseconds now) override { tell(now, {.call = Call::bus_off}); }
  void joined(Nanoseconds now) override { tell(now, {.call = Call::joined}); }
  void stirred(Nanoseconds now) override;
  void tell(Nanoseconds now, CanNews news);

  Far& board_;
  io::CanBus& bus_;
  io::CanStation& station_;
  std::uint8_t place_;
  std::optional<io::CanFrame> offer_;
};

class CanLeader::Far {
 public:
  Far(CanLeader& end, io::BoardWire wire, std::string name, int number, std::unique_ptr<CanEar> ear)
      : end_(end),
        wire_(std::move(wire)),
        name_(std::move(name)),
        number_(number),
        ear_(std::move(ear)) {}

  // Before this all that it asks is known.
  Nanoseconds heard_ns() const { return heard_ns_; }
  bool behind(Nanoseconds now) const { return heard_ns_ <= now; }
  // What it was told since it stands may let it ask more at once.
  bool may_react(Nanoseconds now) const { return behind(now) || (stands_ && has_news_); }
  bool waits_for_word(Nanoseconds now) const {
    return stands_ && word_ns_ <= now && word_ns_ < end_.boundary_ns_;
  }
  Nanoseconds next_asked_ns() const { return asked_.empty() ? io::kNever : asked_.front().t_ns; }

  bool listen();  // until it stands; false: the wire is closed
  void go(Nanoseconds now);
  void react(Nanoseconds now);
  void pass_boundary(Nanoseconds now);
  void begin_step(Nanoseconds now);
  void take_asked(Nanoseconds now);
  void post(io::WireMessage message, bool more);
  void receive(const io::CanFrame& frame) {
    if (ear_ != nullptr) ear_->receive(frame);
  }

 private:
  FarNode& node(std::uint8_t place);
  void let_go(Nanoseconds now, Nanoseconds until);

  CanLeader& end_;
  io::BoardWire wire_;
  std::string name_;
  int number_;
  std::unique_ptr<CanEar> ear_;
  std::deque<FarNode> nodes_;
  std::deque<WireEdge> asked_;  // in order of time
  Nanoseconds heard_ns_ = 0;
  Nanoseconds word_ns_ = 0;  // it stands and waits for what is decided then
  bool stands_ = false, has_news_ = false;
};

// ---- A station

void CanLeader::FarNode::act(const WireEdge& asked) {
  const io::WireCan& can = asked.can;
  switch (static_cast<WireCanAct>(can.act)) {
    case WireCanAct::configure:
      return bus_.configure(station_, can.bit_ns, can.silent);
    case WireCanAct::connect:
      return bus_.connect(station_, can.idles);
    case WireCanAct::disconnect:
      offer_.reset();
      return bus_.disconnect(station_);
    case WireCanAct::offer:
      offer_ = frame_of(can);
      return bus_.request(station_);
    case WireCanAct::withdraw:
      offer_.reset();
      return;
    case WireCanAct::stopped:
      return;
  }
}

void CanLeader::FarNode::receive(const io::CanFrame& frame, Nanoseconds now) {
  if (place_ == 0) board_.receive(frame);
  tell(now, {.call = Call::receive, .frame = frame});
}

void CanLeader::FarNode::tell(Nanoseconds now, CanNews news) {
  news.tec = station_.tec();
  news.rec = station_.rec();
  news.bus_off = station_.is_bus_off();
  board_.post({.t_ns = now, .act = WireAct::can_news, .can = packed(news, place_)}, true);
}

// Its board may be ahead of this by as much. Of all nodes only a microcontroller's asks.
void CanLeader::FarNode::stirred(Nanoseconds now) {
  if (place_ != 0 || station_.takes_part()) return;
  io::WireCan can;
  can.station = place_;
  board_.post({.t_ns = now + kWake_ns, .act = WireAct::can_stir, .can = can}, true);
}

// ---- A board

CanLeader::FarNode& CanLeader::Far::node(std::uint8_t place) {
  while (nodes_.size() <= place) {
    const std::string more = nodes_.empty() ? "" : ", " + std::to_string(nodes_.size());
    nodes_.emplace_back(*this, end_.bus_, name_ + more, number_,
                        static_cast<std::uint8_t>(nodes_.size()));
  }
  return nodes_[place];
}

void CanLeader::Far::post(io::WireMessage message, bool more) {
  has_news_ = has_news_ || message.act == WireAct::can_news;
  if (!wire_.post(message, more)) end_.site_.closed();
}

bool CanLeader::Far::listen() {
  while (!stands_) {
    const auto said = wire_.next_edge();
    if (!said) return false;
    if (static_cast<WireCanAct>(said->can.act) == WireCanAct::stopped) {
      const bool then_too = said->level != 0;
      stands_ = true;
      word_ns_ = then_too ? said->t_ns : io::kNever;
      heard_ns_ = said->t_ns + (then_too ? 1 : 0);
      if (!then_too) return true;
    }
    asked_.push_back(*said);
  }
  return true;
}

// Until the bus could first tell it anything.
void CanLeader::Far::go(Nanoseconds now) {
  take_asked(now);  // when a station joins tells how far
  Nanoseconds until = end_.boundary_ns_;
  for (FarNode& node : nodes_) until = std::min(until, end_.bus_.untouched_until(node.station()));
  let_go(now, std::max(until, now + 1));
}

void CanLeader::Far::react(Nanoseconds now) {
  behind(now) ? go(now) : let_go(now, now);
}

void CanLeader::Far::let_go(Nanoseconds now, Nanoseconds until) {
  begin_step(now);
  post({.t_ns = until, .act = WireAct::can_go}, false);
  has_news_ = false;
}

void CanLeader::Far::pass_boundary(Nanoseconds now) {
  stands_ = has_news_ = false;
  post({.t_ns = now, .act = WireAct::to_boundary}, false);
}

// What it is told may let it ask more at this nanosecond.
void CanLeader::Far::begin_step(Nanoseconds now) {
  heard_ns_ = now;
  stands_ = false;
  word_ns_ = io::kNever;
}

void CanLeader::Far::take_asked(Nanoseconds now) {
  while (!asked_.empty() && asked_.front().t_ns <= now) {
    const WireEdge asked = asked_.front();
    asked_.pop_front();
    node(asked.can.station).act(asked);
  }
}

// ---- All of them

CanLeader::CanLeader(WireSite site, io::CanBus& bus)
    : site_(std::move(site)),
      bus_(bus),
      hear_(
          site_.events, [this] { hear(); }, io::Rank::wire),
      word_(
          site_.events, [this] { give_word(); }, io::Rank::arbiter) {}

CanLeader::~CanLeader() = default;

void CanLeader::add(io::BoardWire wire, std::string name, int number, std::unique_ptr<CanEar> ear) {
  boards_.push_back(
      std::make_unique<Far>(*this, std::move(wire), std::move(name), number, std::move(ear)));
}

void CanLeader::hear() {
  const Nanoseconds now = site_.events.now();
  if (!catch_up(now)) return site_.closed();
  for (const auto& board : boards_) board->take_asked(now);
  plan(now);
}

// Until all have said what they ask at this nanosecond.
bool CanLeader::catch_up(Nanoseconds now) {
  const auto may_react = [now](const auto& board) { return board->may_react(now); };
  for (;;) {
    for (const auto& board : boards_) {
      if (board->behind(now) && !board->listen()) return false;
    }
    if (std::none_of(boards_.begin(), boards_.end(), may_react)) return true;
    for (const auto& board : boards_) {
      if (may_react(board)) board->react(now);
    }
  }
}

void CanLeader::plan(Nanoseconds now) {
  Nanoseconds next = io::kNever;
  bool word = false;
  for (const auto& board : boards_) {
    next = std::min({next, board->heard_ns(), board->next_asked_ns()});
    word = word || board->waits_for_word(now);
  }
  hear_.at(next);
  if (word) word_.at(now);
}

// What could start now has.
void CanLeader::give_word() {
  const Nanoseconds now = site_.events.now();
  for (const auto& board : boards_) {
    if (board->waits_for_word(now)) board->go(now);
  }
  hear_.at(now);
}

void CanLeader::at_boundary(Nanoseconds now) {
  for (const auto& board : boards_) board->pass_boundary(now);
}

void CanLeader::after_boundary(Nanoseconds now, Nanoseconds next) {
  boundary_ns_ = next;
  for (const auto& board : boards_) board->begin_step(now);
  hear_.at(now);
}

}  // namespace whirl::board
