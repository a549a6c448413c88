#include "harness/flight/parameter_requests.hpp"

#include "harness/flight/vehicle_system.hpp"

namespace whirl::flight {
void ParameterRequests::add(const std::string& name, std::optional<float> value) {
  requests_.push_back({name, value});
  last_result_ = kWaiting;
  last_value_ = std::nan("");
}

std::optional<io::MavlinkFrame> ParameterRequests::step(std::int64_t t_ns,
                                                        io::MavlinkSender& sender) {
  if (requests_.empty() || t_ns < requests_.front().next_ns) return std::nullopt;
  Request& first = requests_.front();
  if (first.tries == kTries) {
    last_result_ = kUnanswered;
    requests_.pop_front();
    return std::nullopt;
  }
  ++first.tries;
  first.next_ns = t_ns + kRetry_ns;
  if (!first.value) {
    io::ParamRequestRead message;
    message.target_system = message.target_component = kVehicle;
    message.param_id = io::to_param_id(first.name);
    return io::pack(message, sender);
  }
  io::ParamSet message;
  message.param_value = *first.value;
  message.target_system = message.target_component = kVehicle;
  message.param_id = io::to_param_id(first.name);
  return io::pack(message, sender);
}

void ParameterRequests::on_value(const io::ParamValue& answer) {
  if (requests_.empty()) return;
  const Request& first = requests_.front();
  if (first.tries == 0 || io::param_name(answer.param_id) != first.name) return;
  const bool taken = !first.value || *first.value == answer.param_value;
  last_result_ = taken ? kTakenOver : kRefused;
  last_value_ = answer.param_value;
  requests_.pop_front();
}

}  // namespace whirl::flight
