#include "plant/airframe/contact_world.hpp"

// Bullet's headers are not clean under our warnings.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Woverloaded-virtual"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <btBulletDynamicsCommon.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <utility>
#include <vector>

#include "plant/base/frames.hpp"

namespace whirl::plant {
namespace {

using Eigen::Vector3d;

constexpr double kSlack_m = 0.005;
constexpr double kHubRadius_m = 0.015;
// Bullet lets a foot that is still above the ground approach only up to it, and that eats the
// bounce: contacts count from here on only.
constexpr double kTouch_m = 5e-5;

btVector3 bt(const Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
Vector3d eigen(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

namespace {

using Ball = std::pair<Vector3d, double>;  // centre in B, radius

std::vector<Ball> balls_of(const AirframeParams& params) {
  std::vector<Ball> balls;
  for (const auto& foot : params.contact.gear_B_m) {
    balls.emplace_back(foot, params.contact.foot_radius_m);
  }
  for (const auto& rotor : params.rotors) balls.emplace_back(rotor.p_BP_B_m, kHubRadius_m);
  return balls;
}

// Bullet's shape of an obstacle, where it is.
struct Fixed {
  explicit Fixed(const Obstacle& obstacle) {
    btTransform pose = btTransform::getIdentity();
    if (obstacle.kind == Obstacle::Kind::half_space) {
      const Vector3d& n = obstacle.normal_W;
      shape = std::make_unique<btStaticPlaneShape>(bt(n), n.dot(obstacle.p_W_m));
    } else {
      shape = std::make_unique<btBoxShape>(bt(obstacle.half_size_m));
      pose = btTransform(btQuaternion(btVector3(0, 0, 1), obstacle.yaw_rad), bt(obstacle.p_W_m));
    }
    body = std::make_unique<btRigidBody>(0.0, nullptr, shape.get());
    body->setWorldTransform(pose);
  }
  std::unique_ptr<btCollisionShape> shape;
  std::unique_ptr<btRigidBody> body;
};

}  // namespace

struct ContactWorld::Parts {
  Parts(const AirframeParams& params, const std::vector<Obstacle>& given);
  void add_fixed(btRigidBody& fixed);

  MassProperties mass;
  std::vector<Ball> balls;
  std::vector<Obstacle> obstacles;

  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  btStaticPlaneShape plane{btVector3(0, 0, -1), 0};
  std::vector<std::unique_ptr<btSphereShape>> spheres;
  btCompoundShape hull;
  std::unique_ptr<btRigidBody> ground, body;
  std::vector<Fixed> fixed;  // of each obstacle
};

// Bullet multiplies the figures of two bodies: the vehicle's are the pair's.
void ContactWorld::Parts::add_fixed(btRigidBody& each) {
  each.setFriction(1.0);
  each.setRestitution(1.0);
  each.setContactProcessingThreshold(kTouch_m);
  world.addRigidBody(&each);
}

ContactWorld::Parts::Parts(const AirframeParams& params, const std::vector<Obstacle>& given)
    : mass{params.mass_kg, params.inertia_kgm2}, balls(balls_of(params)), obstacles(given) {
  for (const auto& [centre, radius] : balls) {
    spheres.push_back(std::make_unique<btSphereShape>(radius));
    hull.addChildShape(btTransform(btQuaternion::getIdentity(), bt(centre)), spheres.back().get());
  }
  ground = std::make_unique<btRigidBody>(0.0, nullptr, &plane);
  body = std::make_unique<btRigidBody>(mass.mass_kg, nullptr, &hull, bt(mass.inertia_kgm2));
  body->setRestitution(params.contact.restitution);
  body->setFriction(params.contact.friction);
  body->setDamping(0.0, 0.0);
  body->setContactProcessingThreshold(kTouch_m);
  body->setFlags(0);  // no gyroscopic term of Bullet's: it is in the torque we apply
  body->setActivationState(DISABLE_DEACTIVATION);
  world.setGravity(btVector3(0, 0, 0));  // gravity is in the force we apply
  auto& info = world.getSolverInfo();
  info.m_restitutionVelocityThreshold = 0.1;
  info.m_numIterations = 30;
  info.m_splitImpulsePenetrationThreshold = 0.0;  // depth is mended by position, not by speed
  add_fixed(*ground);
  world.addRigidBody(body.get());
  for (const Obstacle& obstacle : obstacles) {
    fixed.emplace_back(obstacle);
    add_fixed(*fixed.back().body);
  }
}

ContactWorld::ContactWorld(const AirframeParams& params, const std::vector<Obstacle>& obstacles)
    : parts_(std::make_unique<Parts>(params, obstacles)) {}
ContactWorld::ContactWorld(ContactWorld&&) noexcept = default;
ContactWorld& ContactWorld::operator=(ContactWorld&&) noexcept = default;

ContactWorld::~ContactWorld() {
  if (!parts_) return;
  parts_->world.removeRigidBody(parts_->body.get());
  parts_->world.removeRigidBody(parts_->ground.get());
  for (const Fixed& each : parts_->fixed) parts_->world.removeRigidBody(each.body.get());
}

double clearance_m(const AirframeParams& params, std::span<const Obstacle> obstacles,
                   const Vector3d& p_WB_W_m, const Eigen::Quaterniond& q_WB) {
  double least = 1e300;
  for (const auto& [centre, radius] : balls_of(params)) {
    const Vector3d at_W = p_WB_W_m + q_WB * centre;
    least = std::min(least, -at_W.z() - radius);
    for (const Obstacle& o : obstacles) least = std::min(least, distance_m(o, at_W) - radius);
  }
  return least;
}

bool stands_free(const AirframeParams& params, std::span<const Obstacle> obstacles,
                 const Vector3d& p_WB_W_m, const Eigen::Quaterniond& q_WB, double within_m) {
  if (clearance_m(params, obstacles, p_WB_W_m, q_WB) < -within_m) return false;
  const Obstacle floor = slope(0.0, 0.0, 0.0, 0.0);
  const Vector3d axis_W = q_WB * Vector3d::UnitZ();
  for (const RotorMount& rotor : params.rotors) {
    const Vector3d hub_W_m = p_WB_W_m + q_WB * rotor.p_BP_B_m;
    const auto is_in = [&](const Obstacle& o) {
      return disc_enters(o, hub_W_m, axis_W, rotor.radius_m);
    };
    if (is_in(floor) || std::any_of(obstacles.begin(), obstacles.end(), is_in)) return false;
  }
  return true;
}

bool ContactWorld::in_reach(const BodyState& s, double dt_s) const {
  const Eigen::Matrix3d R_WB = s.q_WB.toRotationMatrix();
  double lowest = -1e300;
  for (const auto& [centre, radius] : parts_->balls) {
    lowest = std::max(lowest, R_WB.row(2).dot(centre) + radius);
  }
  const double fall = s.v_WB_W_mps.norm() + s.w_WB_B_radps.norm();  // feet are within a metre
  if (s.p_WB_W_m.z() + lowest + fall * dt_s > -kSlack_m) return true;
  for (const Obstacle& o : parts_->obstacles) {
    for (const auto& [centre, radius] : parts_->balls) {
      const double gap_m = distance_m(o, s.p_WB_W_m + R_WB * centre) - radius;
      if (gap_m < fall * dt_s + kSlack_m) return true;
    }
  }
  return false;
}

Touch ContactWorld::step(BodyState& s, const Forcing& f, double dt_s) {
  Parts& p = *parts_;
  const Eigen::Quaterniond& q = s.q_WB;
  const btTransform pose(btQuaternion(q.x(), q.y(), q.z(), q.w()), bt(s.p_WB_W_m));
  p.body->setWorldTransform(pose);
  p.body->setInterpolationWorldTransform(pose);
  p.body->setLinearVelocity(bt(s.v_WB_W_mps));
  p.body->setAngularVelocity(bt(q * s.w_WB_B_radps));
  p.body->updateInertiaTensor();
  const Vector3d alpha_B = angular_acceleration_B(s, p.mass, f, dt_s);
  const Vector3d gravity_N(0.0, 0.0, p.mass.mass_kg * kGravity_mps2);
  p.body->clearForces();
  p.body->applyCentralForce(bt(q * f.f_B_N + f.f_W_N + gravity_N));
  p.body->applyTorque(bt(q * p.mass.inertia_kgm2.cwiseProduct(alpha_B)));
  p.world.stepSimulation(dt_s, 0);

  Touch touch;
  for (int i = 0; i < p.dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *p.dispatcher.getManifoldByIndexInternal(i);
    const bool onto_first = manifold.getBody0() == p.body.get();  // the normal is from 1 to 0
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      const btManifoldPoint& point = manifold.getContactPoint(k);
      // The solver passes over a pair that has parted, and leaves there what it last found.
      if (point.getDistance() > manifold.getContactProcessingThreshold()) continue;
      const double up = (onto_first ? -1.0 : 1.0) * point.m_normalWorldOnB.z();
      touch.sum_Ns += point.getAppliedImpulse();
      if (up > 0.5) touch.from_below_Ns += point.getAppliedImpulse();
    }
  }
  if (touch.sum_Ns <= 0.0) return {};
  const btQuaternion turned = p.body->getWorldTransform().getRotation();
  s.q_WB = Eigen::Quaterniond(turned.w(), turned.x(), turned.y(), turned.z()).normalized();
  s.p_WB_W_m = eigen(p.body->getWorldTransform().getOrigin());
  s.v_WB_W_mps = eigen(p.body->getLinearVelocity());
  s.w_WB_B_radps = s.q_WB.conjugate() * eigen(p.body->getAngularVelocity());
  return touch;
}

}  // namespace whirl::plant
