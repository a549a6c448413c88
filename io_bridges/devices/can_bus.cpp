#include "io_bridges/devices/can_bus.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::io {
namespace {

// A node whose bit time differs by more cannot follow a frame (ISO 11898-1: 1.58 % at best, both ends).
constexpr double kOscillators = 0.0158;

}  // namespace

CanBus::CanBus(EventQueue& queue, std::string name, FindingSink finding)
    : queue_(queue),
      name_(std::move(name)),
      finding_(std::move(finding)),
      start_(
          queue, [this] { start(); }, Rank::arbiter),
      end_(queue, [this] { end(); }),
      joining_(queue, [this] { rejoin(); }),
      dominant_(queue, [this] { stay_dominant(); }) {}

CanStation& CanBus::join(CanNode& node, std::string name, int number) {
  CanStation& station = stations_.emplace_back();
  station.node_ = &node;
  station.name_ = std::move(name);
  station.number_ = number;
  station.place_ = stations() - 1;
  station.stub_ = std::make_unique<Event>(queue_, [this, &station] { retry_on_stub(station); });
  return station;
}

void CanBus::configure(CanStation& station, double bit_ns, bool silent, bool alone) {
  station.bit_ns_ = bit_ns;
  station.silent_ = silent;
  station.alone_ = alone;
  if (arbiter_ != nullptr) arbiter_->configured(station);
}

void CanBus::connect(CanStation& station, int idles) {
  station.idles_to_go_ = idles;
  station.listens_since_ = queue_.now() == end_ns_ ? recessive_since_ns_ : queue_.now();
  if (arbiter_ != nullptr) return arbiter_->connected(station, idles);
  plan_joining();
}

void CanBus::disconnect(CanStation& station) {
  station.on_ = station.held_ = false;
  station.idles_to_go_ = 0;
  station.stub_->cancel();
  if (arbiter_ != nullptr) arbiter_->disconnected(station);
}

void CanBus::request(CanStation& station) {
  if (!station.on_) return;
  arbiter_ != nullptr ? arbiter_->requested(station) : plan_start(queue_.now());
}

Nanoseconds CanBus::bits_ns(double count) const {
  return std::llround(count * bit_ns_);
}

void CanBus::plan_start(Nanoseconds t) {
  if (busy_ || held_dominant_) return;
  t = std::max({t, free_ns_, queue_.now()});
  if (!start_.pending() || start_.due() > t) start_.at(t);
}

// Asked once for each start of frame: what keeps it from that plans the next one itself.
bool CanBus::may_send(CanStation& station, Nanoseconds now) {
  if (!station.on_ || station.silent_ || station.stub_->pending()) return false;
  const CanFrame* frame = station.node_->offered();
  if (frame == nullptr) return false;
  if (faults_ != nullptr && faults_->cut(station.number_, now)) {
    send_on_stub(station, *frame);
    return false;
  }
  const Nanoseconds hold =
      faults_ != nullptr && !station.held_ ? faults_->held(station.number_, now) : 0;
  if (hold > 0) {
    station.held_ = true;
    station.may_send_ns_ = now + hold;
  }
  if (station.may_send_ns_ <= now) return true;
  plan_start(station.may_send_ns_);
  return false;
}

void CanBus::start() {
  if (busy_ || held_dominant_) return;
  const Nanoseconds now = queue_.now();
  std::vector<CanStation*>& wanting = losers_;
  wanting.clear();
  for (CanStation& station : stations_) {
    if (may_send(station, now)) wanting.push_back(&station);
  }
  if (wanting.empty()) return;
  start_.cancel();
  arbitrate(now);
}

void CanBus::arbitrate(Nanoseconds now) {
  count_idle(now);
  const auto key = [](CanStation* s) { return can_arbitration(*s->node_->offered()); };
  sender_ = *std::min_element(losers_.begin(), losers_.end(),
                              [&key](CanStation* a, CanStation* b) { return key(a) < key(b); });
  twin_ = nullptr;
  std::erase(losers_, sender_);
  for (CanStation* other : losers_) {
    if (key(other) == key(sender_)) twin_ = other;
  }
  std::erase(losers_, twin_);
  busy_ = true;
  joining_.cancel();
  bit_ns_ = sender_->bit_ns_;
  current_ = {};
  current_.frame = *sender_->node_->offered();
  current_.sender = sender_->number_;
  current_.start_ns = now;
  current_.losers = static_cast<int>(losers_.size());
  const CanBits bits = can_bits(current_.frame);
  note_hearers(now);
  verdict_ = judge(bits, now);
  int length = bits.count + kCanTail;
  if (verdict_.error != CanError::none) {
    length = verdict_.bit + 1 + flag_bits(bits) + kCanErrorDelimiter;
  }
  end_.at(now + bits_ns(length));
  sender_->node_->begun(now);
  if (twin_ != nullptr) twin_->node_->begun(now);
  for (CanStation* loser : losers_) loser->node_->begun(now);
  for (CanStation& station : stations_) station.node_->stirred(now);
}

bool CanBus::connected(const CanStation& station, Nanoseconds now) {
  return station.on_ && (faults_ == nullptr || !faults_->cut(station.number_, now));
}

// Settled at its start: a wire that is cut or joined meanwhile counts from the next frame on.
void CanBus::note_hearers(Nanoseconds now) {
  for (CanStation& station : stations_) {
    station.hears_ = connected(station, now) && &station != sender_ && &station != twin_;
  }
}

bool CanBus::rates_fit(double bit_ns, double others_bit_ns) {
  return std::abs(bit_ns / others_bit_ns - 1.0) <= kOscillators;
}

void CanBus::end() {
  const Nanoseconds now = queue_.now();
  busy_ = false;
  free_ns_ = now + bits_ns(kCanIntermission);
  end_ns_ =
      now;  // its last eight bits were recessive, for one too that has left the bus by this very frame
  recessive_since_ns_ = now - bits_ns(kCanErrorDelimiter);
  const bool gone = std::none_of(stations_.begin(), stations_.end(), [this](const CanStation& s) {
    return (&s == sender_ || &s == twin_) && s.on_;
  });
  if (gone && verdict_.error == CanError::none) verdict_.error = CanError::stuff;
  finish(verdict_.error, now);
  for (CanStation& station : stations_) {
    if (station.listens_since_ == now) station.listens_since_ = recessive_since_ns_;
    station.listens_since_ = std::max(station.listens_since_, recessive_since_ns_);
  }
  plan_joining();
  plan_start(free_ns_);
}

void CanBus::finish(CanError error, Nanoseconds now) {
  CanStation* const sender = sender_;
  const std::vector<CanStation*> losers = losers_;
  error == CanError::none ? deliver(now) : fail(now);
  current_.error = error;
  current_.bit = error == CanError::none ? 0 : verdict_.bit;
  current_.end_ns = now;
  current_.busy_ns = now - current_.start_ns + bits_ns(kCanIntermission);
  current_.tec = sender->tec_;
  sender_ = twin_ = nullptr;
  if (sender->passive()) sender->may_send_ns_ = free_ns_ + bits_ns(kCanSuspend);
  if (log_) log_(current_);
  for (CanStation* loser : losers) loser->node_->lost_arbitration(now);
}

void CanBus::deliver(Nanoseconds now) {
  for (CanStation* sender : {sender_, twin_}) {
    if (sender == nullptr) continue;
    sender->tec_ = std::max(sender->tec_ - 1, 0);
    sender->held_ = false;
    sender->node_->sent(now);
  }
  if (sender_->alone_) sender_->node_->receive(current_.frame, now);
  hand_out(now);
}

void CanBus::hand_out(Nanoseconds now) {
  for (CanStation& station : stations_) {
    if (!station.hears_) continue;
    if (!rate_fits(station)) {
      count_error(station, false, CanError::crc, false, now);
      continue;
    }
    station.rec_ = station.rec_ > kPassive ? 120 : std::max(station.rec_ - 1, 0);
    if (faults_ != nullptr && faults_->lost(station.number_, now)) {
      station.node_->counted(now);
      continue;
    }
    station.node_->receive(current_.frame, now);
  }
}

void CanBus::send_on_stub(CanStation& station, const CanFrame& frame) {
  const int bits =
      can_bits(frame).count + kCanAckSlotAfter + 1 + kCanErrorFlag + kCanErrorDelimiter;
  station.stub_->in(std::llround((bits + kCanIntermission) * station.bit_ns_));
}

void CanBus::retry_on_stub(CanStation& station) {
  const Nanoseconds now = queue_.now();
  count_error(station, true, CanError::acknowledge, false, now);
  plan_start(now);
}

void CanBus::count_idle(Nanoseconds until) {
  for (CanStation& station : stations_) {
    if (station.idles_to_go_ == 0) continue;
    const double idle = static_cast<double>(until - station.listens_since_) / station.bit_ns_;
    station.idles_to_go_ -= std::min(static_cast<int>(idle / kCanIdle), station.idles_to_go_ - 1);
    station.listens_since_ = until;
  }
}

// If nothing is sent until then.
Nanoseconds CanBus::joins_at(const CanStation& station) const {
  return station.listens_since_ + std::llround(station.idles_to_go_ * kCanIdle * station.bit_ns_);
}

void CanBus::plan_joining() {
  joining_.cancel();
  if (busy_ || held_dominant_) return;
  for (const CanStation& station : stations_) {
    if (station.idles_to_go_ == 0) continue;
    const Nanoseconds due = joins_at(station);
    if (!joining_.pending() || due < joining_.due()) joining_.at(due);
  }
}

void CanBus::rejoin() {
  const Nanoseconds now = queue_.now();
  for (CanStation& station : stations_) {
    if (station.idles_to_go_ == 0) continue;
    if (joins_at(station) > now) continue;
    station.idles_to_go_ = station.tec_ = station.rec_ = 0;
    station.bus_off_ = station.held_ = false;
    station.on_ = true;
    station.may_send_ns_ = now;
    station.node_->joined(now);
  }
  plan_joining();
  plan_start(now);
}

}  // namespace whirl::io
