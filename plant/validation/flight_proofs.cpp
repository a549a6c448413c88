// The lumped drag coefficient as flight data would show it: specific force against air speed.
#include <cmath>

#include "plant/base/frames.hpp"
#include "plant/rotor/rotor.hpp"
#include "plant/validation/validation.hpp"
#include "plant/vehicle.hpp"

namespace whirl::plant {
namespace {

// Body-x specific force over (body-z specific force x speed), level and at hover's rotor speed.
double drag_spm(Vehicle& vehicle, double speed_mps) {
  for (int k = 0; k < 600; ++k) {  // the inflow settles
    vehicle.place({0, 0, -50}, Eigen::Quaterniond::Identity(), {speed_mps, 0, 0}, {0, 0, 0});
    for (int i = 0; i < 4; ++i) vehicle.set_motor_speed(i, 413.6);
    vehicle.step(1e-3);
  }
  const Eigen::Vector3d f = vehicle.state().specific_force_B_mps2;
  return f.x() / (f.z() * speed_mps);
}

// By hand, for the near-ideal blade that carries the same thrust (chord as R/r, straight lift line; the
// integrals behind [Bangura2017, eq. 4.75]): drag of the disc per thrust and speed.
struct ByHand {
  double profile_and_induced_spm = 0.0;
  double free_flapping_spm = 0.0;  // tilt of the thrust if the blades were hinged at the shaft
};

ByHand by_hand(double thrust_N, double induced_mps, double omega_radps) {
  constexpr double kR = 0.127, kTip_chord = 0.0126, kSlope = 5.7, kDrag = 0.03, kDensity = 1.225;
  const double tip_mps = omega_radps * kR;
  const double unit_N = 0.5 * kDensity * kTip_chord * kR * tip_mps * tip_mps;
  const double lambda = induced_mps / tip_mps;
  const double a = 0.5 * thrust_N / unit_N + kSlope * lambda;  // lift slope x angle of the tip
  return {2.0 * unit_N * (kDrag + 0.5 * lambda * a) / (tip_mps * thrust_N),
          2.0 * (4.0 / 3.0 * a / kSlope - lambda) / tip_mps};
}

}  // namespace

std::vector<Proof> flight_proofs(const std::shared_ptr<const Blade>& blade) {
  const VehicleParams params = hp_quad();
  VehicleParams bare = params;
  bare.airframe.rotor_drag_spm = 0.0;
  bare.airframe.drag_area_m2.setZero();
  Vehicle vehicle(params, blade_element_rotors(blade, params.airframe), 1);
  Vehicle rotors_only(bare, blade_element_rotors(blade, bare.airframe), 1);
  for (int i = 0; i < 4; ++i) {
    vehicle.command(i, {0.3, Freewheel::synchronous});
    rotors_only.command(i, {0.3, Freewheel::synchronous});
  }
  Curve whole{"vehicle", {}, {}}, rotor{"blade elements alone", {}, {}};
  double mean = 0.0, rotor_mean = 0.0;
  const double speeds[] = {0.5, 1.0, 2.0, 3.0, 4.0, 5.0};
  for (const double speed : speeds) {
    whole.x.push_back(speed), whole.y.push_back(drag_spm(vehicle, speed));
    rotor.x.push_back(speed), rotor.y.push_back(drag_spm(rotors_only, speed));
    mean += whole.y.back() / std::size(speeds);
    rotor_mean += rotor.y.back() / std::size(speeds);
  }
  RotorConditions hover;
  hover.omega_radps = 413.6;
  const RotorLoads still = Rotor(blade, 1).steady(hover);
  const ByHand hand = by_hand(still.thrust_N, still.induced_velocity_mps, hover.omega_radps);
  return {{.title = "Lumped drag coefficient by air speed",
           .x_label = "speed / m/s",
           .y_label = "c / s/m",
           .source = "Bangura2017, 4.4: 0.04 +- 0.0035 s/m",
           .model = {whole, rotor},
           .reference = {{"thesis", {0.5, 5.0}, {0.04, 0.04}}},
           .figures = {{"mean less 0.04", mean - 0.04, 0.0035, "s/m"},
                       {"of it from the blade elements", rotor_mean, 0.04, "s/m"},
                       {"blade elements less profile and induced drag by hand",
                        rotor_mean - hand.profile_and_induced_spm, 0.004, "s/m"},
                       {"what blades hinged at the shaft would add, by hand",
                        hand.free_flapping_spm, 0.02, "s/m"}},
           .note =
               "Profile and induced drag of the disc explain a seventh of what flights show. Even "
               "blades hinged at the shaft, a1 = 2 mu (4/3 theta - lambda), would leave three "
               "quarters: the rest is the airframe's rotor_drag_spm, measured only as a whole."}};
}

}  // namespace whirl::plant
