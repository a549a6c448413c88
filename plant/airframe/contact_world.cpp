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

struct ContactWorld::Parts {
  explicit Parts(const AirframeParams& params);

  MassProperties mass;
  std::vector<std::pair<Vector3d, double>> balls;  // centre in B, radius

  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  btStaticPlaneShape plane{btVector3(0, 0, -1), 0};
  std::vector<std::unique_ptr<btSphereShape>> spheres;
  btCompoundShape hull;
  std::unique_ptr<btRigidBody> ground, body;
};

ContactWorld::Parts::Parts(const AirframeParams& params)
    : mass{params.mass_kg, params.inertia_kgm2} {
  for (const auto& foot : params.contact.gear_B_m) {
    balls.emplace_back(foot, params.contact.foot_radius_m);
  }
  for (const auto& rotor : params.rotors) balls.emplace_back(rotor.p_BP_B_m, kHubRadius_m);
  for (const auto& [centre, radius] : balls) {
    spheres.push_back(std::make_unique<btSphereShape>(radius));
    hull.addChildShape(btTransform(btQuaternion::getIdentity(), bt(centre)), spheres.back().get());
  }
  ground = std::make_unique<btRigidBody>(0.0, nullptr, &plane);
  body = std::make_unique<btRigidBody>(mass.mass_kg, nullptr, &hull, bt(mass.inertia_kgm2));
  for (btRigidBody* each : {ground.get(), body.get()}) each->setFriction(1.0);
  ground->setRestitution(1.0);  // Bullet multiplies the two: the vehicle's figures are the pair's
  body->setRestitution(params.contact.restitution);
  body->setFriction(params.contact.friction);
  body->setDamping(0.0, 0.0);
  body->setContactProcessingThreshold(kTouch_m);
  ground->setContactProcessingThreshold(kTouch_m);
  body->setFlags(0);  // no gyroscopic term of Bullet's: it is in the torque we apply
  body->setActivationState(DISABLE_DEACTIVATION);
  world.setGravity(btVector3(0, 0, 0));  // gravity is in the force we apply
  auto& info = world.getSolverInfo();
  info.m_restitutionVelocityThreshold = 0.1;
  info.m_numIterations = 30;
  info.m_splitImpulsePenetrationThreshold = 0.0;  // depth is mended by position, not by speed
  world.addRigidBody(ground.get());
  world.addRigidBody(body.get());
}

ContactWorld::ContactWorld(const AirframeParams& params)
    : parts_(std::make_unique<Parts>(params)) {}
ContactWorld::ContactWorld(ContactWorld&&) noexcept = default;
ContactWorld& ContactWorld::operator=(ContactWorld&&) noexcept = default;

ContactWorld::~ContactWorld() {
  if (!parts_) return;
  parts_->world.removeRigidBody(parts_->body.get());
  parts_->world.removeRigidBody(parts_->ground.get());
}

bool ContactWorld::in_reach(const BodyState& s, double dt_s) const {
  const Eigen::Matrix3d R_WB = s.q_WB.toRotationMatrix();
  double lowest = -1e300;
  for (const auto& [centre, radius] : parts_->balls) {
    lowest = std::max(lowest, R_WB.row(2).dot(centre) + radius);
  }
  const double fall = s.v_WB_W_mps.norm() + s.w_WB_B_radps.norm();  // feet are within a metre
  return s.p_WB_W_m.z() + lowest + fall * dt_s > -kSlack_m;
}

double ContactWorld::step(BodyState& s, const Forcing& f, double dt_s) {
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

  double impulse = 0.0;
  for (int i = 0; i < p.dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *p.dispatcher.getManifoldByIndexInternal(i);
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      impulse += manifold.getContactPoint(k).getAppliedImpulse();
    }
  }
  if (impulse <= 0.0) return 0.0;
  const btQuaternion turned = p.body->getWorldTransform().getRotation();
  s.q_WB = Eigen::Quaterniond(turned.w(), turned.x(), turned.y(), turned.z()).normalized();
  s.p_WB_W_m = eigen(p.body->getWorldTransform().getOrigin());
  s.v_WB_W_mps = eigen(p.body->getLinearVelocity());
  s.w_WB_B_radps = s.q_WB.conjugate() * eigen(p.body->getAngularVelocity());
  return impulse;
}

}  // namespace whirl::plant
