// What goes wrong on the bus: who finds it and when, how long it takes, what it counts.
#include <algorithm>
#include <cstdio>

#include "io_bridges/devices/can_bus.hpp"

namespace whirl::io {
namespace {

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

void CanBus::fail(Nanoseconds now) {
  const bool unheard = verdict_.error == CanError::acknowledge && sender_->passive();
  for (CanStation* sender : {sender_, twin_}) {
    if (sender != nullptr && sender->on_) {
      count_error(*sender, true, verdict_.error, false, now);
    }
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
