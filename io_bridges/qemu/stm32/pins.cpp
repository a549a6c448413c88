#include "io_bridges/qemu/stm32/pins.hpp"

#include <algorithm>

namespace whirl::stm32 {

Pin::Pin(std::string name, Watcher watcher) : own_(std::move(name)), watcher_(std::move(watcher)) {
  attach(own_);
}

void Pin::attach(io::Wire& wire) {
  wire_ = &wire;
  driver_ = wire.add_driver("the microcontroller");
  wire.watch([this, at = &wire](bool level, Nanoseconds now) {
    if (at != wire_) return;  // left behind when the pin joined another net
    for (Signal* signal : setting_.signals) {
      if (signal != nullptr) signal->sense(level, now);
    }
    watcher_(level, now);
  });
}

void Pin::join(io::Wire& net, Nanoseconds now) {
  if (wire_ == &net) return;
  const bool before = wire_->level();
  wire_->drive(driver_, Drive::none, now);
  attach(net);
  if (net.level() != before) watcher_(net.level(), now);
}

Drive Pin::wanted() const {
  switch (setting_.mode) {
    case PinMode::analog:
      return Drive::none;
    case PinMode::input:
      return setting_.pull;
    case PinMode::output: {
      if (!setting_.output) return Drive::low;
      return setting_.open_drain ? setting_.pull : Drive::high;
    }
    case PinMode::alternate: {
      for (const Signal* signal : setting_.signals) {
        if (signal == nullptr || signal->driven() == Drive::none) continue;
        const bool off = setting_.open_drain && signal->driven() == Drive::high;
        return off ? setting_.pull : signal->driven();
      }
      return setting_.pull;
    }
  }
  return Drive::none;
}

void Pin::drive(Nanoseconds now) {
  wire_->drive(driver_, wanted(), now);
}

void Pin::set_output(bool level, Nanoseconds now) {
  setting_.output = level;
  if (setting_.mode == PinMode::output) drive(now);
}

void Pin::set(const PinSetting& setting, Nanoseconds now) {
  if (setting == setting_) return;
  const PinSetting before = setting_;
  setting_ = setting;
  for (Signal* signal : before.signals) {
    if (signal != nullptr) signal->route(-1);
  }
  drive(now);
  for (Signal* signal : setting.signals) {
    if (signal == nullptr) continue;
    signal->route(+1);
    signal->sense(level(), now);
  }
}

std::array<Pin*, 16> PinBank::make_port(char port, PortWatcher watcher) {
  std::array<Pin*, 16> made{};
  for (int n = 0; n < 16; ++n) {
    const std::string name = std::string("P") + port + std::to_string(n);
    auto pin = std::make_unique<Pin>(
        name, [watcher, n](bool level, Nanoseconds now) { watcher(n, level, now); });
    made[static_cast<std::size_t>(n)] = pin.get();
    pins_[name] = std::move(pin);
  }
  return made;
}

Pin* PinBank::find(std::string_view name) {
  const auto it = pins_.find(name);
  return it == pins_.end() ? nullptr : it->second.get();
}

Signal& PinBank::signal(const std::string& name) {
  auto& slot = signals_[name];
  if (!slot) slot = std::make_unique<Signal>(name);
  return *slot;
}

Signal* PinBank::find_signal(const std::string& name) {
  const auto it = signals_.find(name);
  return it == signals_.end() ? nullptr : it->second.get();
}

void PinBank::connect(Pin& pin, Signal& signal) {
  signal.add_outlet([&pin, &signal](Drive, Nanoseconds now) {
    const PinSetting& s = pin.setting();
    const bool carried = std::find(s.signals.begin(), s.signals.end(), &signal) != s.signals.end();
    if (s.mode == PinMode::alternate && carried) pin.drive(now);
  });
}

io::Wire* PinBank::net(const Signal* signal) const {
  const auto it = nets_.find(signal);
  return it == nets_.end() ? nullptr : it->second;
}

}  // namespace whirl::stm32
