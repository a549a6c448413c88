// What a driver wants of an I2C bus: a queue that works in the background.
#pragma once
#include <concepts>

#include "firmware/hal/i2c_job.hpp"
#include "firmware/status.hpp"

namespace fw {

template <typename B>
concept I2cQueue = requires(B bus, const hal::I2cJob& job) {
  { bus.submit(job) } -> std::same_as<Status>;
};

}  // namespace fw
