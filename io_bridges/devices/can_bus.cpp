#include "io_bridges/devices/can_bus.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace whirl::io {
namespace {

// A node whose bit time differs by more cannot follow a frame (ISO 11898-1: 1.58 % at best, both ends).
constexpr double kOscillators = 0.0158;
constexpr int kPassive = 127, kBusOff = 255, kHighest = 135;
constexpr int kDominantRun = 8;  // each so many bits of a held wire count once more

std::string rate_text(double bit_ns) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g kbit/s", 1e6 / bit_ns);
  return text;
}

// Equal bits that end at `at`.
int run_at(const CanBits& bits, int at, std::uint8_t value) {
  int run = 0;
  while (at - run >= 0 && bits.value[static_cast<std::size_t>(at - run)] == value) ++run;
  return run;
}

}  // namespace

CanBus::CanBus(EventQueue& queue, std::string name, FindingSink finding)
    : queue_(queue),
      name_(std::move(name)),
      finding_(std::move(finding)),
      start_(queue, [this] { start(); }),
      end_(queue, [this] { end(); }),
      joining_(queue, [this] { rejoin(); }),
      dominant_(queue, [this] { stay_dominant(); }) {}

CanStation& CanBus::join(CanNode& node, std::string name, int number) {
  CanStation& station = stations_.emplace_back();
  station.node_ = &node;
  station.name_ = std::move(name);
  station.number_ = number;
  station.stub_ = std::make_unique<Event>(queue_, [this, &station] { retry_on_stub(station); });
  return station;
}

void CanBus::configure(CanStation& station, double bit_ns, bool silent, bool alone) {
  station.bit_ns_ = bit_ns;
  station.silent_ = silent;
  station.alone_ = alone;
}

void CanBus::connect(CanStation& station, int idles) {
  station.idles_to_go_ = idles;
  station.listens_since_ = queue_.now();
  plan_joining();
}

void CanBus::disconnect(CanStation& station) {
  station.on_ = station.held_ = false;
  station.idles_to_go_ = 0;
  station.stub_->cancel();
}

void CanBus::request(CanStation& station) {
  if (station.on_) plan_start(queue_.now());
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

bool CanBus::rate_fits(const CanStation& station) const {
  return std::abs(station.bit_ns_ / bit_ns_ - 1.0) <= kOscillators;
}

// What is wrong with the frame first.
CanBus::Verdict CanBus::judge(const CanBits& bits, Nanoseconds now) {
  Verdict worst;
  const auto keep = [&worst](Verdict v) {
    if (worst.error == CanError::none || v.bit < worst.bit) worst = v;
  };
  if (faults_ != nullptr && faults_->spoiled(sender_->number_, now)) {
    const int bit = bits.count - 8;  // in the CRC: nobody mistakes it for another frame
    const bool recessive = bits.value[static_cast<std::size_t>(bit)] == 1;
    keep({recessive ? CanError::bit_recessive : CanError::bit_dominant, bit, sender_, true});
  }
  if (twin_ != nullptr) collide(bits, keep);
  bool acknowledged = sender_->alone_;
  for (CanStation& station : stations_) {
    if (!station.hears_) continue;
    if (rate_fits(station)) {
      acknowledged = acknowledged || !station.silent_;
      continue;
    }
    finding_.report({now, name_,
                     station.name_ + " runs at " + rate_text(station.bit_ns_) + ", " +
                         sender_->name_ + " at " + rate_text(bit_ns_)});
    if (!station.silent_ && !station.passive()) keep(misread(bits, station));
  }
  if (acknowledged && faults_ != nullptr)
    acknowledged = faults_->acknowledged(sender_->number_, now);
  if (!acknowledged) keep({CanError::acknowledge, bits.count + kCanAckSlotAfter, sender_});
  return worst;
}

// Two with one identifier: whoever sends the first recessive bit against a dominant one finds it.
template <typename Keep>
void CanBus::collide(const CanBits& bits, Keep keep) {
  const CanBits other = can_bits(*twin_->node_->offered());
  finding_.report({queue_.now(), name_,
                   sender_->name_ + " and " + twin_->name_ + " send one identifier at once"});
  for (int i = 0; i < std::min(bits.count, other.count); ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (bits.value[at] == other.value[at]) continue;
    return keep({CanError::bit_recessive, i, bits.value[at] == 1 ? sender_ : twin_});
  }
}

// A node of another bit time sees six equal bits where there are none, or at last a wrong CRC.
CanBus::Verdict CanBus::misread(const CanBits& bits, CanStation& by) const {
  const double six_bits = 5.8 * by.bit_ns_ / bit_ns_;  // its sixth sample
  int run = 0;
  for (int i = 0; i < bits.count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    run = i > 0 && bits.value[at] == bits.value[at - 1] ? run + 1 : 1;
    if (run >= six_bits) return {CanError::stuff, i, &by};
  }
  return {CanError::crc, bits.count - 1, &by};
}

// From the first flag's first bit to the last one's last: the others find six equal bits only some
// bits into the first flag, and then begin their own.
int CanBus::flag_bits(const CanBits& bits) {
  const bool others = std::any_of(stations_.begin(), stations_.end(), [&](CanStation& s) {
    const bool involved = s.hears_ || &s == sender_ || &s == twin_;
    return involved && &s != verdict_.first && !s.silent_ && !s.passive();
  });
  if (!others) return kCanErrorFlag;
  if (verdict_.bit >= bits.count) return 1 + kCanErrorFlag;  // in the acknowledge delimiter
  const std::uint8_t flag = verdict_.first->passive() ? 1 : 0;
  const auto before = static_cast<std::size_t>(verdict_.bit);
  const std::uint8_t on_wire = bits.value[before] ^ (verdict_.inverted ? 1 : 0);
  const int run =
      on_wire != flag ? 0 : 1 + (verdict_.bit > 0 ? run_at(bits, verdict_.bit - 1, flag) : 0);
  return kCanErrorFlag - std::min(run, kCanErrorFlag) + kCanErrorFlag;
}

void CanBus::end() {
  const Nanoseconds now = queue_.now();
  busy_ = false;
  free_ns_ = now + bits_ns(kCanIntermission);
  finish(verdict_.error, now);
  // The last eight bits were recessive, for one too that has left the bus by this very frame.
  const Nanoseconds recessive = now - bits_ns(kCanErrorDelimiter);
  for (CanStation& station : stations_) {
    if (station.listens_since_ == now || station.listens_since_ < recessive) {
      station.listens_since_ = recessive;
    }
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
    if (faults_ != nullptr && faults_->lost(station.number_, now)) continue;
    station.node_->receive(current_.frame, now);
  }
}

void CanBus::fail(Nanoseconds now) {
  const bool unheard = verdict_.error == CanError::acknowledge && sender_->passive();
  for (CanStation* sender : {sender_, twin_}) {
    if (sender != nullptr) count_error(*sender, true, verdict_.error, false, now);
  }
  if (unheard) return hand_out(now);  // its flag is recessive: the others see a good frame
  for (CanStation& station : stations_) {
    if (!station.hears_) continue;
    const bool first = &station == verdict_.first;
    count_error(station, false, first ? verdict_.error : CanError::stuff, first, now);
  }
}

void CanBus::count_error(CanStation& station, bool sending, CanError error, bool first,
                         Nanoseconds now) {
  if (sending) {
    const bool waits = error == CanError::acknowledge && station.passive();
    station.tec_ += waits ? 0 : 8;
  } else {
    station.rec_ = std::min(station.rec_ + (first ? 9 : 1), kHighest);
  }
  if (station.tec_ > kBusOff) {
    disconnect(station);
    station.bus_off_ = true;
  }
  station.node_->failed(error, sending, now);
  if (!station.bus_off_ || station.tec_ <= kBusOff) return;
  finding_.report({now, name_, station.name_ + " went bus-off"});
  station.node_->bus_off(now);
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

void CanBus::plan_joining() {
  joining_.cancel();
  if (busy_ || held_dominant_) return;
  for (const CanStation& station : stations_) {
    if (station.idles_to_go_ == 0) continue;
    const Nanoseconds due =
        station.listens_since_ + std::llround(station.idles_to_go_ * kCanIdle * station.bit_ns_);
    if (!joining_.pending() || due < joining_.due()) joining_.at(due);
  }
}

void CanBus::rejoin() {
  const Nanoseconds now = queue_.now();
  for (CanStation& station : stations_) {
    if (station.idles_to_go_ == 0) continue;
    const Nanoseconds due =
        station.listens_since_ + std::llround(station.idles_to_go_ * kCanIdle * station.bit_ns_);
    if (due > now) continue;
    station.idles_to_go_ = station.tec_ = station.rec_ = 0;
    station.bus_off_ = station.held_ = false;
    station.on_ = true;
    station.may_send_ns_ = now;
    station.node_->joined(now);
  }
  plan_joining();
  plan_start(now);
}

void CanBus::hold_dominant(Nanoseconds now) {
  held_dominant_ = true;
  start_.cancel();
  count_idle(now);
  joining_.cancel();
  dominant_sender_ = sender_;
  if (busy_) {
    end_.cancel();
    busy_ = false;
    verdict_ = {CanError::bit_recessive,
                static_cast<int>(static_cast<double>(now - current_.start_ns) / bit_ns_), sender_};
    finish(verdict_.error, now);
  } else {
    for (CanStation& station : stations_) {
      if (connected(station, now)) count_error(station, false, CanError::stuff, false, now);
    }
  }
  dominant_.in(bits_ns(kCanErrorFlag + kDominantRun));
}

// Each further run of eight dominant bits.
void CanBus::stay_dominant() {
  const Nanoseconds now = queue_.now();
  bool moves = false;
  for (CanStation& station : stations_) {
    if (!connected(station, now)) continue;
    const bool sending = &station == dominant_sender_;
    if (!sending && station.rec_ > kPassive) continue;
    moves = true;
    if (!sending) station.rec_ = std::min(station.rec_ + 7, kHighest - 1);  // and one below
    count_error(station, sending, CanError::form, false, now);
  }
  if (moves) dominant_.in(bits_ns(kDominantRun));
}

void CanBus::release(Nanoseconds now) {
  if (!held_dominant_) return;
  held_dominant_ = false;
  dominant_.cancel();
  dominant_sender_ = nullptr;
  free_ns_ = now + bits_ns(kCanErrorDelimiter + kCanIntermission);
  for (CanStation& station : stations_) station.listens_since_ = now;
  plan_joining();
  plan_start(free_ns_);
}

}  // namespace whirl::io
