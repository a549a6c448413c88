// One rotor: shaft speed and the air's motion in, force, moment and shaft torque out.
//
//   Frame   P at the hub, axes parallel to the body's (forward, right, down): thrust acts along -z_P.
//   Units   SI; rotor speed is rad/s in the rotor's own sense (its spin sign). Negative: the air turns
//           it backward, trailing edges first, by what the polars say of that (polar.hpp: a flat plate).
//   Valid   |advance ratio| <= 0.3; descent through the vortex-ring state by an empirical closure
//           (validity says so), its mean only (what fluctuates: vortex_ring.hpp). Outside: finite, bounded, flagged, not to be believed.
//   Source  20 rings x 12 azimuths, averaged over a revolution. Each ring balances blade thrust and
//           momentum (ring_balance.hpp) with the apparent mass of [PittPeters]; over the rings lies
//           one gradient of inflow with that theory's first-harmonic gains and time constant.
//           Flapping is quasi-steady, for stiff blades.
//   Error   other programs and wind tunnels: plant/validation/rotor_proofs.hpp. Signs, symmetries and
//           closed forms: tests/.
//   Left out  gyroscopic moment of the spinning mass (the airframe's equation has it), blade
//           passing vibration, interference between rotors (a bound: wake_bound.hpp),
//           compressibility.
//   Edgewise  of the in-plane force at the hub the blades give 0.006 of the 0.04 s/m that a quad of
//           such propellers shows in flight (tests/oblique_test.cpp); what lacks is no theory of
//           ours but the vehicle's `rotor_drag_spm`. Hub moments are the blades' alone, unmeasured.
#pragma once
#include <Eigen/Core>
#include <limits>
#include <memory>

#include "plant/rotor/blade.hpp"

namespace whirl::plant {

struct RotorConditions {
  double omega_radps = 0.0;                                // in the rotor's own sense
  Eigen::Vector3d v_AP_P_mps = Eigen::Vector3d::Zero();    // hub against the surrounding air
  Eigen::Vector3d w_WP_P_radps = Eigen::Vector3d::Zero();  // body rates
  double density_kgpm3 = 1.225;
  double viscosity_Pas = 1.81e-5;
  double height_m = std::numeric_limits<double>::infinity();  // hub above ground
};

struct RotorValidity {
  bool vortex_ring = false;           // the empirical closure carries the answer
  bool beyond_advance_ratio = false;  // |mu| > 0.3
  bool stalled = false;        // more than a third of the disc (by dynamic pressure) is past stall
  bool not_converged = false;  // steady() gave up within its limit of iterations
  bool backward = false;       // turned against its sense
  bool out_of_range = false;   // conditions were clamped to a physical range first
  bool ok() const {
    return !(vortex_ring || beyond_advance_ratio || stalled || not_converged || backward ||
             out_of_range);
  }
};

struct RotorLoads {
  Eigen::Vector3d f_P_N = Eigen::Vector3d::Zero();     // on the airframe, acting at the hub
  Eigen::Vector3d tau_P_Nm = Eigen::Vector3d::Zero();  // hub moments and aerodynamic reaction
  double thrust_N = 0.0;                               // -f_P.z
  double shaft_torque_Nm = 0.0;       // what the motor must overcome; negative when windmilling
  double shaft_power_W = 0.0;         // torque x speed
  double induced_velocity_mps = 0.0;  // thrust-weighted mean over the disc
  Eigen::Vector3d flap_rad = Eigen::Vector3d::Zero();  // cone; disc tilted back; disc tilted left
  double figure_of_merit = 0.0;  // ideal hover power of this thrust / shaft power; 0 if none
  RotorValidity validity;
};

class Rotor {
 public:
  // spin_sign +1: counter-clockwise seen from above, so its reaction on the airframe is about +z_P.
  Rotor(std::shared_ptr<const Blade> blade, int spin_sign);
  ~Rotor();
  Rotor(Rotor&&) noexcept;
  Rotor& operator=(Rotor&&) noexcept;

  // The loads under these conditions with the inflow as it stands; then the inflow and the flapping
  // move on by dt_s. Allocates nothing.
  RotorLoads step(const RotorConditions& conditions, double dt_s);

  // Where step() settles under constant conditions; leaves the inflow of this rotor as it is.
  RotorLoads steady(const RotorConditions& conditions) const;

  const Blade& blade() const { return *blade_; }
  int spin_sign() const { return spin_sign_; }

 private:
  struct State;  // rotor.cpp
  std::shared_ptr<const Blade> blade_;
  int spin_sign_;
  std::unique_ptr<State> state_;
};

}  // namespace whirl::plant
