// A signal of a peripheral (SPI1_SCK, TIM3_CH2, I2C3_SDA) on its way to a pin.
//
//   The peripheral drives it and watches it; GPIO routes it to every pin whose alternate function
//   selects it (AFRx on F405, AFIO on F103). Unrouted, a drive reaches nothing and the input reads
//   its idle level: firmware that forgot to mux a pin sees what it would see on the part.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "io_bridges/devices/wire.hpp"

namespace whirl::stm32 {

using io::Drive;
using io::Nanoseconds;

class Signal {
 public:
  using Watcher = std::function<void(bool level, Nanoseconds now)>;
  using Outlet = std::function<void(Drive drive, Nanoseconds now)>;

  explicit Signal(std::string name, bool idle = true) : name_(std::move(name)), level_(idle) {}
  Signal(const Signal&) = delete;
  Signal& operator=(const Signal&) = delete;

  // The peripheral's side. Drive::none: the signal is an input (or released).
  void drive(Drive drive, Nanoseconds now) {
    if (drive == drive_) return;
    drive_ = drive;
    for (const Outlet& outlet : outlets_) outlet(drive, now);
  }
  bool level() const { return level_; }      // of the pin, as the peripheral sees it
  bool routed() const { return pins_ > 0; }  // some pin is muxed to it
  void watch(Watcher watcher) { watchers_.push_back(std::move(watcher)); }  // input edges
  // A peripheral that computes its edges (timers) does so only while a pin carries them.
  void on_route(std::function<void()> rerouted) { rerouted_ = std::move(rerouted); }
  const std::string& name() const { return name_; }

  // GPIO's side. An outlet is one pin that may carry the signal; it is told every drive and asks
  // its own mode whether it passes it on.
  void add_outlet(Outlet outlet) { outlets_.push_back(std::move(outlet)); }
  void route(int change) {  // +1, -1: a pin was muxed to it, or away
    pins_ += change;
    if (rerouted_) rerouted_();
  }
  Drive driven() const { return drive_; }
  void sense(bool level, Nanoseconds now) {
    if (level == level_) return;
    level_ = level;
    for (const Watcher& watcher : watchers_) watcher(level, now);
  }

 private:
  std::string name_;
  std::vector<Watcher> watchers_;
  std::vector<Outlet> outlets_;
  std::function<void()> rerouted_;
  Drive drive_ = Drive::none;
  int pins_ = 0;
  bool level_;
};

}  // namespace whirl::stm32
