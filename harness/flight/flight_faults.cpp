// The faults that are the flight's own: its supply, its cameras, its native controllers.
#include <algorithm>
#include <string>
#include <vector>

#include "harness/flight/flight_world.hpp"

namespace whirl::flight {
namespace {

constexpr const char *kEsc_stopped = "esc_stopped", *kSupply_dip = "supply_dip",
                     *kWinding_short = "winding_short", *kCapture_frozen = "capture_frozen",
                     *kCapture_moved = "capture_moved", *kCapture_turned = "capture_turned";

}  // namespace

Result<bool> FlightWorld::take_fault(const FaultSpec& fault) {
  if (fault.kind == kEsc_stopped || fault.kind == kWinding_short) {
    if (auto good = must_be_of_a_controller(fault); !good) return good.error();
  } else if (fault.kind == kSupply_dip && far_ && motor_of(fault) != 0) {
    if (auto good = must_be_a_lead(fault); !good) return good.error();
  } else if (fault.kind == kSupply_dip) {
    if (auto good = must_be_of_all(fault); !good) return good.error();
    const double start_s = static_cast<double>(fault.start_ns) * 1e-9;
    vehicle_.dip_supply(fault.value, start_s, static_cast<double>(fault.end_ns) * 1e-9 - start_s);
  } else if (fault.kind == "capture_lost" || fault.kind == kCapture_frozen) {
    if (auto good = must_be_of_all(fault); !good) return good.error();
  } else if (fault.kind == kCapture_moved || fault.kind == kCapture_turned) {
    if (auto good = must_be_of_all(fault); !good) return good.error();
    if (fault.value == 0.0) {
      return Error{ErrorKind::bad_input, "", fault.kind + " without a value changes nothing",
                   fault.kind == kCapture_moved ? "value = \"1.5 m\"" : "value = \"90 deg\""};
    }
  } else {
    return false;
  }
  faults_.add(fault);
  return true;
}

Result<Done> FlightWorld::must_be_of_a_controller(const FaultSpec& fault) const {
  if (far_) {
    return Error{ErrorKind::bad_input, "", "the controllers of this vehicle are boards",
                 "a fault of that board: reset_pin, code_hangs; or of its wire"};
  }
  const int motor = motor_of(fault), motors = static_cast<int>(controllers_.size());
  if (motor < 1 || motor > motors) {
    return Error{ErrorKind::bad_input, "", fault.kind + " needs one of the vehicle's motors",
                 "motor = 1 to " + std::to_string(motors) + ", or the device that is its ESC"};
  }
  if (fault.kind != kWinding_short || fault.value > 0.0) return Done{};
  return Error{ErrorKind::bad_input, "", "winding_short takes amperes of the bus",
               "value = \"30 A\""};
}

Result<Done> FlightWorld::must_be_a_lead(const FaultSpec& fault) const {
  const int motors = static_cast<int>(airframe_.rotors.size());
  if (motor_of(fault) > motors) {
    return Error{ErrorKind::bad_input, "", "supply_dip of a motor that the vehicle has not",
                 "motor = 1 to " + std::to_string(motors) + ", or the device that is its ESC"};
  }
  if (fault.value > 0.0) return Done{};
  return Error{ErrorKind::bad_input, "", "supply_dip of one motor takes volts of its supply",
               "value = \"3 V\""};
}

// What the cameras' computer sends for a pose. The stamp of time goes on.
CapturedPose FlightWorld::spoiled(CapturedPose pose, std::int64_t t_ns) {
  if (const auto& last = station_.last_pose(); last && faults_.any(kCapture_frozen, t_ns)) {
    pose.p_WB_W_m = last->p_WB_W_m;
    pose.roll_pitch_yaw_rad = last->roll_pitch_yaw_rad;
  }
  faults_.apply(kCapture_moved, t_ns,
                [&pose](const FaultSpec& fault) { pose.p_WB_W_m.x() += fault.value; });
  faults_.apply(kCapture_turned, t_ns,
                [&pose](const FaultSpec& fault) { pose.roll_pitch_yaw_rad.z() += fault.value; });
  return pose;
}

// What the lead of each motor's controller loses, from this boundary to the next.
void FlightWorld::dip_leads(std::int64_t t_ns) {
  std::vector<double> below_V(airframe_.rotors.size(), 0.0);
  faults_.apply(kSupply_dip, t_ns, [&below_V](const FaultSpec& fault) {
    const int motor = motor_of(fault);
    if (motor > 0) below_V[static_cast<std::size_t>(motor) - 1] += fault.value;
  });
  for (std::size_t i = 0; i < below_V.size(); ++i) far_->set_dip(i, below_V[i]);
}

void FlightWorld::apply_faults(std::int64_t t_ns) {
  faults_.apply(kEsc_stopped, t_ns, [this](const FaultSpec& fault) {
    controllers_[static_cast<std::size_t>(motor_of(fault)) - 1]->cut();
  });
  std::fill(shorts_A_.begin(), shorts_A_.end(), 0.0);
  faults_.apply(kWinding_short, t_ns, [this](const FaultSpec& fault) {
    shorts_A_[static_cast<std::size_t>(motor_of(fault)) - 1] += fault.value;
  });
  // The vehicle itself lowers its supply; here is only kept that it did.
  faults_.apply(kSupply_dip, t_ns, [](const FaultSpec&) {});
}

}  // namespace whirl::flight
