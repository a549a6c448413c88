#include "io_bridges/devices/can_wire_faults.hpp"

#include <cmath>

namespace whirl::io {
namespace {

constexpr int kMicrocontroller = -1;

}  // namespace

CanWireFaults::CanWireFaults(EventQueue& queue, FaultBook& book, CanBus& bus, int number,
                             double bit_ns)
    : queue_(queue),
      book_(book),
      bus_(bus),
      number_(number),
      bit_ns_(bit_ns),
      babbler_(bus.join(*this, "babbling node", -2)),
      again_(queue, [this] { bus_.request(babbler_); }) {
  babble_.extended = true;
  babble_.length = 8;
  bus_.set_faults(this);
  book_.on_added([this](const Fault& fault) { schedule(fault); });
}

void CanWireFaults::at(Nanoseconds t, std::function<void()> action) {
  if (t == kNever) return;
  events_.push_back(std::make_unique<Event>(queue_, std::move(action)));
  events_.back()->at(t);
}

void CanWireFaults::schedule(const Fault& fault) {
  if (fault.bus != kAnywhere && fault.bus != number_) return;
  if (fault.kind == FaultKind::can_stuck_dominant) {
    bus_.foresee(fault.start_ns);
    at(fault.start_ns, [this, kind = fault.kind] {
      bus_.hold_dominant(queue_.now());
      book_.apply(kind, number_, kAnywhere, queue_.now());
    });
    at(fault.end_ns, [this] { bus_.release(queue_.now()); });
  } else if (fault.kind == FaultKind::can_babble) {
    at(fault.start_ns, [this, share = fault.value] {
      share_ = share > 0.0 ? share : 1.0;
      bus_.configure(babbler_, bit_ns_);
      bus_.connect(babbler_, 1);
    });
    at(fault.end_ns, [this] { bus_.disconnect(babbler_); });
  }
}

// The microcontroller has no number: a fault of a device is never its own.
const Fault* CanWireFaults::find(FaultKind kind, int number, Nanoseconds now) const {
  const Fault* fault = book_.find(kind, number_, number, now);
  return fault != nullptr && number < 0 && fault->address != kAnywhere ? nullptr : fault;
}

bool CanWireFaults::cut(int number, Nanoseconds now) {
  const Fault* fault = find(FaultKind::can_cut, number, now);
  if (fault == nullptr) return false;
  if (fault->address == kAnywhere && number == kMicrocontroller) return false;
  book_.applied(*fault, now);
  return true;
}

bool CanWireFaults::acknowledged(int sender, Nanoseconds now) {
  const Fault* fault = find(FaultKind::can_no_ack, sender, now);
  if (fault != nullptr) book_.applied(*fault, now);
  return fault == nullptr;
}

bool CanWireFaults::spoiled(int sender, Nanoseconds now) {
  const Fault* fault = find(FaultKind::can_bit_error, sender, now);
  if (fault == nullptr) return false;
  if (fault->value > 0.0 && ++frames_[fault->number] != static_cast<int>(fault->value))
    return false;
  book_.applied(*fault, now);
  return true;
}

bool CanWireFaults::lost(int receiver, Nanoseconds now) {
  const Fault* fault = find(FaultKind::can_lost, receiver, now);
  if (fault != nullptr) book_.applied(*fault, now);
  return fault != nullptr;
}

Nanoseconds CanWireFaults::held(int sender, Nanoseconds now) {
  const Fault* fault = find(FaultKind::can_late, sender, now);
  if (fault == nullptr) return 0;
  book_.applied(*fault, now);
  return std::llround(fault->value * 1e9);
}

const CanFrame* CanWireFaults::offered() {
  if (queue_.now() < silent_until_ns_) return nullptr;
  began_ns_ = queue_.now();
  return &babble_;
}

void CanWireFaults::sent(Nanoseconds now) {
  book_.apply(FaultKind::can_babble, number_, kAnywhere, now);
  const auto took = static_cast<double>(now - began_ns_) + kCanIntermission * bit_ns_;
  silent_until_ns_ = began_ns_ + std::llround(took / share_);
  again_.at(silent_until_ns_);
}

}  // namespace whirl::io
