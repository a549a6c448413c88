#include "io_bridges/devices/supply_faults.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::io {
namespace {

constexpr FaultKind kKinds[] = {FaultKind::memory_removed, FaultKind::sensor_brown_out,
                                FaultKind::memory_cut};

}  // namespace

SupplyFaults::SupplyFaults(EventQueue& queue, FaultBook* book, int bus, int device, Action off,
                           Action on)
    : queue_(queue),
      book_(book),
      bus_(bus),
      device_(device),
      off_(std::move(off)),
      on_(std::move(on)),
      cut_(queue, [this] { lose(queue_.now()); }) {
  if (book_ != nullptr) book_->on_added([this](const Fault& added) { watch(added); });
}

void SupplyFaults::at(Nanoseconds when, std::function<void()> action) {
  edges_.push_back(std::make_unique<Event>(queue_, std::move(action)));
  edges_.back()->at(when);
}

void SupplyFaults::watch(const Fault& added) {
  const FaultKind kind = added.kind;
  if (std::find(std::begin(kKinds), std::end(kKinds), kind) == std::end(kKinds)) return;
  if (kind != FaultKind::memory_cut) {
    at(added.start_ns, [this, kind] {
      const Nanoseconds now = queue_.now();
      if (apply(book_, kind, bus_, device_, now) != nullptr) lose(now);
    });
  }
  if (added.end_ns != kNever) at(added.end_ns, [this] { supply_may_return(); });
}

void SupplyFaults::supply_may_return() {
  const Nanoseconds now = queue_.now();
  cut_.cancel();
  for (const FaultKind kind : kKinds) {
    if (book_->find(kind, bus_, device_, now) != nullptr) return;
  }
  if (!lost_) return;
  lost_ = false;
  on_(now);
}

void SupplyFaults::lose(Nanoseconds now) {
  lost_ = true;
  off_(now);
}

void SupplyFaults::write_begins(Nanoseconds now, Nanoseconds write_ns) {
  const Fault* cut = apply(book_, FaultKind::memory_cut, bus_, device_, now);
  if (cut == nullptr) return;
  const double share = std::clamp(cut->value, 0.0, 1.0);
  cut_.at(now + std::llround(share * static_cast<double>(write_ns - 1)));
}

}  // namespace whirl::io
