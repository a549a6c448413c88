#include "plant/airframe/obstacle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace whirl::plant {
namespace {

using Eigen::Vector3d;

constexpr int kRim_points = 24;
constexpr double kLevel = 0.05;  // of a normal: steeper is no surface to stand on

Vector3d in_box(const Obstacle& box, const Vector3d& p_W_m) {
  return Eigen::AngleAxisd(-box.yaw_rad, Vector3d::UnitZ()) * (p_W_m - box.p_W_m);
}

}  // namespace

Obstacle slope(double north_m, double east_m, double towards_rad, double angle_rad) {
  Obstacle o{.kind = Obstacle::Kind::half_space, .p_W_m = {north_m, east_m, 0.0}};
  o.normal_W = {-std::sin(angle_rad) * std::cos(towards_rad),
                -std::sin(angle_rad) * std::sin(towards_rad), -std::cos(angle_rad)};
  return o;
}

Obstacle wall(double distance_m, double towards_rad) {
  const Vector3d towards(std::cos(towards_rad), std::sin(towards_rad), 0.0);
  return {.kind = Obstacle::Kind::half_space, .p_W_m = distance_m * towards, .normal_W = -towards};
}

Obstacle ceiling(double height_m) {
  return {.kind = Obstacle::Kind::half_space,
          .p_W_m = {0.0, 0.0, -height_m},
          .normal_W = Vector3d::UnitZ()};
}

Obstacle box(double north_m, double east_m, double base_m, const Vector3d& size_m, double yaw_rad) {
  return {.kind = Obstacle::Kind::box,
          .p_W_m = {north_m, east_m, -base_m - 0.5 * size_m.z()},
          .half_size_m = 0.5 * size_m,
          .yaw_rad = yaw_rad};
}

double distance_m(const Obstacle& o, const Vector3d& p_W_m) {
  if (o.kind == Obstacle::Kind::half_space) return o.normal_W.dot(p_W_m - o.p_W_m);
  const Vector3d beyond = in_box(o, p_W_m).cwiseAbs() - o.half_size_m;
  return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

bool disc_enters(const Obstacle& o, const Vector3d& hub_W_m, const Vector3d& axis_W,
                 double radius_m) {
  const double hub_m = distance_m(o, hub_W_m);
  if (hub_m > radius_m) return false;
  if (o.kind == Obstacle::Kind::half_space) {
    const double along = o.normal_W.dot(axis_W);
    return hub_m < radius_m * std::sqrt(std::max(0.0, 1.0 - along * along));
  }
  if (hub_m < 0.0) return true;
  const Vector3d first = axis_W.unitOrthogonal(), second = axis_W.cross(first);
  for (int k = 0; k < kRim_points; ++k) {
    const double theta = 2.0 * std::numbers::pi * k / kRim_points;
    const Vector3d out = std::cos(theta) * first + std::sin(theta) * second;
    if (distance_m(o, hub_W_m + radius_m * out) < 0.0) return true;
  }
  return false;
}

double height_above_m(std::span<const Obstacle> obstacles, const Vector3d& p_W_m) {
  double height_m = -p_W_m.z();
  for (const Obstacle& o : obstacles) {
    if (o.kind == Obstacle::Kind::half_space) {
      if (o.normal_W.z() < -kLevel) {
        height_m = std::min(height_m, distance_m(o, p_W_m) / -o.normal_W.z());
      }
      continue;
    }
    const Vector3d local = in_box(o, p_W_m);
    if (std::abs(local.x()) > o.half_size_m.x() || std::abs(local.y()) > o.half_size_m.y())
      continue;
    const double above_m = -local.z() - o.half_size_m.z();
    if (above_m >= 0.0) height_m = std::min(height_m, above_m);
  }
  return height_m;
}

}  // namespace whirl::plant
