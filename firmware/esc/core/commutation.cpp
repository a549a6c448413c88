#include "firmware/esc/core/commutation.hpp"

namespace fw::esc {
namespace {

Ticks share_of(Ticks length, std::uint8_t of_256) {
  return static_cast<Ticks>((static_cast<std::uint32_t>(length) * of_256) >> 8);
}

Ticks since(Ticks now, Ticks then) {
  return static_cast<Ticks>(now - then);
}

}  // namespace

void Commutation::stop() {
  state_ = State::stopped;
  sectors_.fill(0);
  good_ = missed_ = 0;
  ordered_ = false;
}

Commutation::Order Commutation::start(Ticks now) {
  stop();
  state_ = State::starting;
  sector_ = config_.align_sector;
  crossing_known_ = false;
  step_ = 1;  // step 0's field holds the rotor where step 2 ought to begin
  return order(now);
}

Commutation::Order Commutation::order(Ticks at) {
  ordered_ = true;
  step_ = static_cast<std::uint8_t>(step_ == 5 ? 0 : step_ + 1);
  return {true, at};
}

Commutation::Order Commutation::on_commutated(Ticks now) {
  commutated_at_ = now;
  ordered_ = false;
  seen_before_ = false;
  return {};
}

void Commutation::note_sector(Ticks length) {
  sectors_[newest_] = length;
  newest_ = static_cast<std::uint8_t>(newest_ == 5 ? 0 : newest_ + 1);
  // While starting, the rotor gains speed within one sector: follow faster.
  const std::uint32_t weight = state_ == State::running ? 96 : 200;
  const std::uint32_t mixed = (sector_ * (256u - weight) + length * weight) >> 8;
  sector_ = static_cast<Ticks>(mixed < config_.shortest_sector ? config_.shortest_sector : mixed);
}

void Commutation::lose() {
  state_ = State::starting;
  ++bad_detections_;
  good_ = missed_ = 0;
}

Commutation::Order Commutation::crossed(Ticks at) {
  if (crossing_known_) {
    const Ticks length = since(at, crossed_at_);
    const bool odd = length > 2u * sector_ || 2u * length < sector_;
    if (state_ == State::running && odd && ++missed_ >= kInARow / 2) lose();
    if (!odd) missed_ = 0;
    note_sector(length);
    if (good_ < kInARow && ++good_ == kInARow) state_ = State::running;
  } else {
    // The first crossing of a start lies half a sector after its commutation.
    sector_ = static_cast<Ticks>(2 * since(at, commutated_at_));
    if (sector_ < config_.shortest_sector) sector_ = config_.shortest_sector;
  }
  crossing_known_ = true;
  crossed_at_ = at;
  const Ticks half = static_cast<Ticks>(sector_ / 2);
  return order(static_cast<Ticks>(at + half - share_of(sector_, config_.advance_share)));
}

// While a start waits to commutate, the phase may cross back: the rotor has turned half a revolution
// (electrical) since the crossing and is far faster than the guess. Jump to where it is.
Commutation::Order Commutation::overtaken(Ticks now, int side, int bus_counts) {
  if (state_ != State::starting || !crossing_known_ || side <= bus_counts / 64) return {};
  sector_ = static_cast<Ticks>(since(now, crossed_at_) / 3);
  if (sector_ < config_.shortest_sector) sector_ = config_.shortest_sector;
  crossing_known_ = false;
  good_ = 0;
  step_ = static_cast<std::uint8_t>((step_ + 3) % 6);
  return {true, now};
}

Commutation::Order Commutation::on_sample(Ticks now, int floating_counts, int bus_counts) {
  if (state_ == State::stopped) return {};
  // Positive before the crossing, negative after it, whatever the step.
  const auto side_in = [&](std::uint8_t step) {
    const int doubled = 2 * floating_counts - bus_counts;
    return (step & 1) != 0 ? -doubled : doubled;
  };
  if (ordered_) return overtaken(now, side_in(previous_step()), bus_counts);
  const Ticks elapsed = since(now, commutated_at_);
  const Ticks blank = share_of(sector_, config_.blank_share);
  if (elapsed <
      (state_ == State::running || blank < config_.start_blank ? blank : config_.start_blank)) {
    return {};
  }
  // At a rail a diode still carries the old current: that says nothing about the rotor. At low duty
  // this outlasts the blank time, for the current dies slowly while the PWM is off.
  const int rail = bus_counts / 64;
  const bool at_rail = floating_counts <= rail || floating_counts >= bus_counts - rail;
  const int side = at_rail ? 0 : side_in(step_);
  const int clear = state_ == State::running ? 0 : config_.start_clear_counts;
  if (side > clear) {
    seen_before_ = true;
    before_at_ = now;
    before_counts_ = side;
  } else if (seen_before_ && side < -clear) {
    const std::uint32_t gap = since(now, before_at_);
    const auto height = static_cast<std::uint32_t>(before_counts_ - side);
    const auto back = static_cast<Ticks>(gap * static_cast<std::uint32_t>(-side) / height);
    return crossed(static_cast<Ticks>(now - back));
  } else if (side < -config_.start_clear_counts &&
             (state_ == State::starting || elapsed >= sector_ / 2)) {
    // It had crossed before we could look: believe the expected moment, if there is one.
    const auto expected = static_cast<Ticks>(commutated_at_ + sector_ / 2);
    return crossed(state_ == State::running ? expected : now);
  }
  // No crossing where one and a half sectors have passed: go on blindly, but not for ever.
  const Ticks patience = static_cast<Ticks>(sector_ < 0x5000 ? sector_ + sector_ / 2 : sector_);
  if (elapsed < patience) return {};
  ++bad_detections_;
  good_ = 0;
  crossing_known_ = false;
  if (state_ == State::running && ++missed_ >= kInARow) lose();
  return order(now);
}

float Commutation::speed_radps() const {
  if (state_ != State::running) return 0.0f;
  std::uint32_t sum = 0;
  for (const Ticks length : sectors_) {
    if (length == 0) return 0.0f;
    sum += length;
  }
  constexpr float kTwoPi = 6.2831853f;
  return kTwoPi * config_.ticks_per_s / (static_cast<float>(sum) * config_.pole_pairs);
}

}  // namespace fw::esc
