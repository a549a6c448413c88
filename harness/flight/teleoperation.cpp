#include "harness/flight/teleoperation.hpp"

#include <cmath>

#include "base/check.hpp"

namespace whirl::flight {
namespace {

constexpr std::int64_t kSticksPeriod_ns = 20'000'000;
constexpr double kPeriod_s = 0.02, kHand_s = 0.1;

}  // namespace

Teleoperation::Teleoperation(const request::Teleoperation& wanted, const Target& from,
                             std::int64_t now_ns)
    : wanted_(wanted),
      begin_ns_(now_ns),
      next_ns_(now_ns),
      asked_height_m_(-from.p_W_m.z()),
      hand_height_m_(-from.p_W_m.z()),
      yaw_rad_(from.yaw_rad) {
  WHIRL_CHECK(!wanted.script.empty());
}

void Teleoperation::ask(const request::Stick& stick) {
  asked_W_mps_.x() = stick.north_mps.value_or(asked_W_mps_.x());
  asked_W_mps_.y() = stick.east_mps.value_or(asked_W_mps_.y());
  asked_height_m_ = stick.height_m.value_or(asked_height_m_);
  asked_yaw_rate_radps_ = stick.yaw_rate_radps.value_or(asked_yaw_rate_radps_);
}

void Teleoperation::read_stick() {
  const double t_s = static_cast<double>(next_ns_ - begin_ns_) * 1e-9;
  for (; next_ < wanted_.script.size(); ++next_) {
    if (wanted_.script[next_].at_s + wanted_.reaction_s > t_s) break;
    ask(wanted_.script[next_]);
  }
  const double blend = -std::expm1(-kPeriod_s / kHand_s);
  hand_W_mps_ += blend * (asked_W_mps_ - hand_W_mps_);
  hand_height_m_ += blend * (asked_height_m_ - hand_height_m_);
  hand_yaw_rate_radps_ += blend * (asked_yaw_rate_radps_ - hand_yaw_rate_radps_);
  yaw_rad_ = std::remainder(yaw_rad_ + hand_yaw_rate_radps_ * kPeriod_s, 2.0 * M_PI);
}

SetPoint Teleoperation::at(std::int64_t t_ns) {
  for (; next_ns_ <= t_ns; next_ns_ += kSticksPeriod_ns) read_stick();
  return {{{0.0, 0.0, -hand_height_m_}, yaw_rad_}, hand_W_mps_};
}

}  // namespace whirl::flight
