// The ground station's side of MAVLink's parameter protocol: what is asked of the vehicle, one request
// after the other, each repeated until the PARAM_VALUE of its name comes.
//
//   Source  mavlink.io/en/services/parameter.html: whether a value was taken over shows in the answer
#pragma once
#include <cmath>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "io_bridges/protocols/mavlink_messages.hpp"

namespace whirl::flight {

class ParameterRequests {
 public:
  static constexpr std::int64_t kRetry_ns = 300'000'000;
  static constexpr int kTries = 20;
  static constexpr int kTakenOver = 0, kRefused = 2, kWaiting = -1, kUnanswered = -2;

  // Without a value it is only read.
  void add(const std::string& name, std::optional<float> value);
  // The frame that is due at t_ns.
  std::optional<io::MavlinkFrame> step(std::int64_t t_ns, io::MavlinkSender& sender);
  void on_value(const io::ParamValue& answer);

  bool pending() const { return !requests_.empty(); }
  // Of the last answer since a request was given, or kWaiting or kUnanswered.
  int last_result() const { return last_result_; }
  double last_value() const { return last_value_; }  // NaN: none since

 private:
  struct Request {
    std::string name;
    std::optional<float> value;
    std::int64_t next_ns = 0;
    int tries = 0;
  };
  std::deque<Request> requests_;
  int last_result_ = kWaiting;
  double last_value_ = std::nan("");
};

}  // namespace whirl::flight
