// The air about a barometer between two messages of the harness, and what the plant's barometer makes of it.
#pragma once
#include <cstdint>
#include <string>

#include "io_bridges/devices/ms5611.hpp"
#include "io_bridges/messages/messages.hpp"
#include "plant/sensors/barometer.hpp"

namespace whirl::rack {

class SensedAir {
 public:
  SensedAir(const plant::BarometerParams& params, std::uint64_t seed, const std::string& name)
      : barometer_(params, seed, name) {}

  void set(const io::BodyMotion& motion);
  io::Ms5611::Truth sense(io::Nanoseconds now);  // in order of time

 private:
  plant::Barometer barometer_;
  plant::Truth truth_;
  double temperature_K_ = io::BodyMotion{}.air_temperature_K;
  io::Nanoseconds sensed_ns_ = 0;
};

}  // namespace whirl::rack
