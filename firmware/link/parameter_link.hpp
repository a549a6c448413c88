// MAVLink's parameter protocol, the vehicle's side: requests in, PARAM_VALUE out, one at a time.
//
//   Source  mavlink.io/en/services/parameter.html; what QGroundControl asks
//   Types   all are MAV_PARAM_TYPE_REAL32, whole numbers too; a PARAM_SET of another type is refused
//   Answers a PARAM_SET by the value that holds then: the old one where the new one was refused; an
//           unknown name or index not at all. Those asked for by name or index go before a list
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "firmware/config/parameters.hpp"
#include "firmware/link/mavlink.hpp"

namespace fw {

class ParameterLink {
 public:
  // Frames of other messages, or for others, are passed over.
  void on_frame(const mavlink::Frame& frame, Parameters& parameters, bool armed);

  bool due() const { return due_index().has_value(); }
  mavlink::Message next(const Parameters& parameters);  // pre: due()

 private:
  std::optional<std::size_t> due_index() const;
  void on_read(const mavlink::Frame& frame);
  void on_set(const mavlink::Frame& frame, Parameters& parameters, bool armed);

  std::array<bool, kParameterCount> asked_{};
  std::size_t listed_ = kParameterCount;  // the next one of a list
};

}  // namespace fw
