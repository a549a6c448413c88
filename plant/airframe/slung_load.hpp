// A point mass on a line below the vehicle. The line pulls and never pushes.
//
//   Frame    W; the line is fixed to the body at attach_B_m
//   Method   Tension from the accelerations of both ends: that which makes the stretch s of a taut line go
//            back as s'' = -2 w s' - w^2 s with w = 100 rad/s (a snatch takes some 20 ms), never
//            below zero. It is held over a step; of the body it knows the forces but no contact's
//   Valid    steps up to 2 ms, lines from 5 cm on
//   Error    pendulum's period to 1e-3, momentum of both to round-off, no swing gains energy
//            (tests/slung_load_test.cpp)
//   Left out the line's mass, drag and stretch; what lies between the ends; the load's own turning
#pragma once
#include "plant/airframe/rigid_body.hpp"

namespace whirl::plant {

struct SlungLoadParams {
  double mass_kg = 0.0;  // above 0
  double line_m = 1.0;
  Eigen::Vector3d attach_B_m = Eigen::Vector3d::Zero();
  double drag_area_m2 = 0.0;  // coefficient x area
};

class SlungLoad {
 public:
  SlungLoad(const SlungLoadParams& params, const MassProperties& body);

  // At rest against the body, straight below it at the line's length, or on the floor.
  void hang(const BodyState& body);
  // Pre: `forcing` has everything but the line. Adds its pull and moves the load on to t + dt.
  void step(const BodyState& body, Forcing& forcing, double density_kgpm3,
            const Eigen::Vector3d& wind_W_mps, double dt_s);

  const Eigen::Vector3d& p_W_m() const { return p_W_m_; }
  const Eigen::Vector3d& v_W_mps() const { return v_W_mps_; }
  double tension_N() const { return tension_N_; }  // of the last step

 private:
  struct End;
  double tension_of(const End& end, const Eigen::Vector3d& a_load_W_mps2) const;
  void rest_on_floor(double dt_s);

  SlungLoadParams params_;
  MassProperties body_;
  Eigen::Vector3d p_W_m_ = Eigen::Vector3d::Zero(), v_W_mps_ = Eigen::Vector3d::Zero();
  double tension_N_ = 0.0;
};

}  // namespace whirl::plant
