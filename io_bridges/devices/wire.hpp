// One electrical node with several drivers: chip selects, interrupt lines, SDA, SCL, LEDs.
//
//   Level     strong drives beat pulls; a strong low beats a strong high, and that is a fight: it is
//             counted, and reported with the names of two that take part; with nobody driving, the
//             last resolved level stays
//   Watchers  are told each change of the resolved level, with its time, in the order of joining
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "io_bridges/devices/event_queue.hpp"

namespace whirl::io {

enum class Drive : std::uint8_t { none, pull_low, pull_high, low, high };

class Wire {
 public:
  using Watcher = std::function<void(bool level, Nanoseconds now)>;

  explicit Wire(std::string name, bool level = true) : name_(std::move(name)), level_(level) {}
  Wire(const Wire&) = delete;
  Wire& operator=(const Wire&) = delete;

  int add_driver(std::string name = "a driver");  // returns the handle for drive()
  void drive(int driver, Drive drive, Nanoseconds now);
  void watch(Watcher watcher) { watchers_.push_back(std::move(watcher)); }

  bool level() const { return level_; }
  const std::string& name() const { return name_; }
  std::uint64_t fights() const { return fights_; }
  bool was_driven() const { return was_driven_; }  // strongly, by anybody, so far

  using Fight =
      std::function<void(const std::string& low, const std::string& high, Nanoseconds now)>;
  void on_fight(Fight fight) { fight_ = std::move(fight); }

  // A fault on the wire itself: holds it whatever the drivers say; Drive::none lets go.
  void force(Drive forced, Nanoseconds now);

 private:
  void resolve(Nanoseconds now);

  const std::string& driver_with(Drive drive) const;

  std::string name_;
  std::vector<Drive> drives_;
  std::vector<std::string> names_;  // of the drivers
  Fight fight_;
  bool was_driven_ = false;
  std::vector<Watcher> watchers_;
  Drive forced_ = Drive::none;
  bool level_;
  std::uint64_t fights_ = 0;
};

}  // namespace whirl::io
