#include "io_bridges/devices/wire.hpp"

#include <algorithm>

#include "base/check.hpp"

namespace whirl::io {

int Wire::add_driver(std::string name) {
  drives_.push_back(Drive::none);
  names_.push_back(std::move(name));
  return static_cast<int>(drives_.size()) - 1;
}

void Wire::drive(int driver, Drive drive, Nanoseconds now) {
  WHIRL_CHECK(driver >= 0 && driver < static_cast<int>(drives_.size()), driver);
  if (drives_[driver] == drive) return;
  drives_[driver] = drive;
  was_driven_ = was_driven_ || drive == Drive::low || drive == Drive::high;
  resolve(now);
}

void Wire::force(Drive forced, Nanoseconds now) {
  forced_ = forced;
  resolve(now);
}

// Pre: there is one.
const std::string& Wire::driver_with(Drive drive) const {
  const auto it = std::find(drives_.begin(), drives_.end(), drive);
  return names_[static_cast<std::size_t>(it - drives_.begin())];
}

void Wire::resolve(Nanoseconds now) {
  const auto anyone = [this](Drive drive) {
    return std::find(drives_.begin(), drives_.end(), drive) != drives_.end();
  };
  bool level = level_;
  if (forced_ != Drive::none) {
    level = forced_ == Drive::high || forced_ == Drive::pull_high;
  } else if (anyone(Drive::low)) {
    if (anyone(Drive::high)) {
      ++fights_;
      if (fight_) fight_(driver_with(Drive::low), driver_with(Drive::high), now);
    }
    level = false;
  } else if (anyone(Drive::high)) {
    level = true;
  } else if (anyone(Drive::pull_high)) {
    level = true;
  } else if (anyone(Drive::pull_low)) {
    level = false;
  }
  if (level == level_) return;
  level_ = level;
  for (const Watcher& watcher : watchers_) watcher(level, now);
}

}  // namespace whirl::io
