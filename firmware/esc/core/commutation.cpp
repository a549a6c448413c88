#include "firmware/esc/core/commutation.hpp"

namespace fw::esc {
namespace {

Ticks share_of(Ticks length, std::uint8_t of_256) {
  return static_cast<Ticks>((static_cast<std::uint32_t>(length) * of_256) >> 8);
}

Ticks since(Ticks now, Ticks then) {
  return static_cast<Ticks>(now - then);
}

// `back` sectors before where the next one is written: 1 is the last. Without a division.
std::uint32_t sector_of(const std::array<Ticks, 6>& sectors, unsigned newest, unsigned back) {
  return sectors[newest >= back ? newest - back : newest + 6u - back];
}

}  // namespace

void Commutation::stop() {
  state_ = State::stopped;
  sectors_.fill(0);
  good_ = missed_ = unfit_ = 0;
  ordered_ = braked_ = measured_ = false;
  last_length_ = unbooked_ = 0;
  longer_ = 0;
}

void Commutation::join(Ticks now, std::uint8_t step, Ticks sector) {
  stop();
  state_ = State::running;
  step_ = step;
  sector_ = bounded(sector);
  sectors_.fill(sector_);
  good_ = kInARow;
  commutated_at_ = sampled_at_ = now;
  crossed_at_ = static_cast<Ticks>(now - sector_ / 2);
  waited_ = sector_ / 2u;
  crossing_known_ = true;
  seen_before_ = false;
  highest_counts_ = 0;
}

Commutation::Order Commutation::start(Ticks now) {
  stop();
  const int noise = middles_.noise_counts() * 5 / 8;
  start_clear_counts_ = noise > config_.start_clear_counts ? noise : config_.start_clear_counts;
  state_ = State::starting;
  sampled_at_ = now;
  waited_ = 0;
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
  if (!back_emf_fits() && state_ == State::running && unfit_ >= 2) lose();
  commutated_at_ = now;
  ordered_ = false;
  seen_before_ = false;
  smooth_ = 0;
  return {};
}

Ticks Commutation::bounded(std::uint32_t sector) const {
  return static_cast<Ticks>(sector < config_.shortest_sector ? config_.shortest_sector : sector);
}

void Commutation::lose() {
  ++bad_detections_;
  stop();
}

void Commutation::wait(Ticks now) {
  constexpr std::uint32_t kFor_ever = 1u << 20;
  if (waited_ < kFor_ever) waited_ += since(now, sampled_at_);
  sampled_at_ = now;
}

// Half a sector off its crossing the floating phase lies half the back-EMF off the middle. A third of
// that will do, for the last sample may come early; far more is a rotor that turns faster than told.
bool Commutation::back_emf_fits() {
  const auto seen = static_cast<std::uint32_t>(highest_counts_) * sector_;
  highest_counts_ = 0;
  const bool fits = 3 * seen > config_.flux_count_ticks && 2 * seen < 5 * config_.flux_count_ticks;
  unfit_ = fits ? std::uint8_t{0} : static_cast<std::uint8_t>(unfit_ + 1);
  if (!fits) good_ = 0;
  return fits;
}

// The ordered commutation will not come into this sample, which learning makes a long one.
bool Commutation::commutates_later(Ticks now) const {
  const int due = sector_ / 2 - share_of(sector_, config_.advance_share);
  return since(now, crossed_at_) + kLearning < due;
}

// Of the crossing before the last, which has two neighbours now. The sample after a crossing has time for it.
void Commutation::learn(int bus_counts) {
  const int more = longer_;
  longer_ = 0;
  const int sector = sector_;
  if (more == 0 || 4 * more > sector || -4 * more > sector) return;
  // Half of the difference is a time; in it the phase moves by twice the back-EMF per sector.
  const auto emf_counts =
      static_cast<int>(config_.flux_count_ticks / static_cast<unsigned>(sector));
  middles_.learn(previous_of(previous_step()), more * emf_counts / sector, bus_counts);
}

void Commutation::book() {
  const Ticks length = unbooked_;
  unbooked_ = 0;
  const auto last = [&](unsigned back) { return sector_of(sectors_, newest_, back); };
  const std::uint32_t before = last(2) + last(3);
  braked_ = state_ == State::running && last(3) > 0 && (length + last(1)) * 64u > before * 65u;
  sectors_[newest_] = length;
  newest_ = static_cast<std::uint8_t>(newest_ == 5 ? 0 : newest_ + 1);
}

// The sector between two crossings; false: the rotor is lost.
bool Commutation::measure(Ticks length, bool measured) {
  const bool odd = length > 2u * sector_ || 2u * length < sector_;
  const bool runs = state_ == State::running;
  if (runs && odd && ++missed_ >= kInARow / 2) {
    lose();
    return false;
  }
  if (!odd) missed_ = 0;
  const bool fair = runs && measured && measured_ && !odd;
  longer_ = fair && last_length_ > 0 ? static_cast<int>(length) - last_length_ : 0;
  last_length_ = fair ? length : Ticks{0};
  unbooked_ = length;
  // While starting, the rotor gains speed within one sector: follow faster.
  const std::uint32_t weight = runs ? 96 : 200;
  sector_ = bounded((sector_ * (256u - weight) + length * weight) >> 8);
  if (good_ < kInARow && ++good_ == kInARow) state_ = State::running;
  return true;
}

Commutation::Order Commutation::crossed(Ticks at, bool measured) {
  if (crossing_known_) [[likely]] {
    if (!measure(since(at, crossed_at_), measured)) return {};
  } else {
    // The first crossing of a start lies half a sector after its commutation.
    sector_ = bounded(static_cast<Ticks>(2 * since(at, commutated_at_)));
  }
  crossing_known_ = true;
  measured_ = measured;
  crossed_at_ = at;
  waited_ = since(sampled_at_, at);
  const Ticks half = static_cast<Ticks>(sector_ / 2);
  return order(static_cast<Ticks>(at + half - share_of(sector_, config_.advance_share)));
}

// While a start waits to commutate, the phase may cross back: the rotor has turned half a revolution
// (electrical) since the crossing and is far faster than the guess. Jump to where it is.
Commutation::Order Commutation::overtaken(Ticks now, int side, int bus_counts) {
  if (state_ != State::starting || !crossing_known_ || side <= bus_counts / 64) return {};
  sector_ = bounded(since(now, crossed_at_) / 3u);
  crossing_known_ = false;
  good_ = 0;
  step_ = static_cast<std::uint8_t>((step_ + 3) % 6);
  return {true, now};
}

// Between a crossing and its commutation.
Commutation::Order Commutation::wait_for_commutation(Ticks now, int off, bool at_rail,
                                                     int bus_counts) {
  if ((longer_ != 0 || unbooked_ != 0) && commutates_later(now)) {
    if (longer_ != 0) {
      learn(bus_counts);
    } else {
      book();
    }
  }
  if (!at_rail && -off > highest_counts_) highest_counts_ = -off;
  if (state_ == State::running) [[likely]]
    return {};
  return overtaken(now, off, bus_counts);
}

// No crossing where one and a half sectors have passed: go on blindly, but not for ever, and not if
// there is hardly any back-EMF: then the rotor has been stopped.
Commutation::Order Commutation::miss(Ticks now) {
  ++bad_detections_;
  good_ = 0;
  crossing_known_ = false;
  if (state_ == State::running && (++missed_ >= kInARow || !back_emf_fits())) {
    lose();
    return {};
  }
  return order(now);
}

// A start begins at rest, so from nothing in each sector.
int Commutation::smoothed(int off, bool at_rail) {
  if (at_rail) return 0;
  smooth_ += off - smooth_ / kSmoothing;
  return smooth_ / kSmoothing;
}

// A sample off the blank time; `at` is when the phase crossed its middle, told by two samples if `measured`.
bool Commutation::crosses(Ticks now, int side, Ticks elapsed, Ticks& at, bool& measured) {
  const int clear = state_ == State::running ? 0 : start_clear_counts_;
  if (side > clear) {
    seen_before_ = true;
    before_at_ = now;
    before_counts_ = side;
    return false;
  }
  if (seen_before_ && side < -clear) {
    const std::uint32_t gap = since(now, before_at_);
    const auto height = static_cast<std::uint32_t>(before_counts_ - side);
    at = static_cast<Ticks>(now - gap * static_cast<std::uint32_t>(-side) / height);
    if (state_ == State::starting) at = static_cast<Ticks>(at - kSmoothing_lag);
    measured = true;
    return true;
  }
  const bool late = state_ == State::starting ? crossing_known_ || elapsed > config_.swing
                                              : elapsed >= sector_ / 2;
  if (side < -start_clear_counts_ && late) {
    // It had crossed before we could look: believe the expected moment, if there is one.
    at = state_ == State::running ? static_cast<Ticks>(commutated_at_ + sector_ / 2) : now;
    return true;
  }
  return false;
}

Commutation::Order Commutation::on_sample(Ticks now, int floating_counts, int bus_counts) {
  if (state_ == State::stopped) [[unlikely]]
    return {};
  wait(now);
  // Positive before the crossing, negative after it, whatever the step.
  const std::uint8_t seen = ordered_ ? previous_step() : step_;
  const int doubled = middles_.off(seen, floating_counts, bus_counts);
  const int off = (seen & 1) != 0 ? -doubled : doubled;
  // At a rail a diode still carries the old current: that says nothing about the rotor. At low duty
  // this outlasts the blank time, for the current dies slowly while the PWM is off.
  const int rail = bus_counts >> 6;
  const bool at_rail = floating_counts <= rail || floating_counts >= bus_counts - rail;
  if (ordered_) return wait_for_commutation(now, off, at_rail, bus_counts);
  const Ticks elapsed = since(now, commutated_at_);
  const Ticks blank = share_of(sector_, config_.blank_share);
  if (elapsed <
      (state_ == State::running || blank < config_.start_blank ? blank : config_.start_blank)) {
    if (unbooked_ != 0) book();
    return {};
  }
  const int side = state_ == State::starting ? smoothed(off, at_rail) : at_rail ? 0 : off;
  if (side > highest_counts_ || -side > highest_counts_) highest_counts_ = side > 0 ? side : -side;
  Ticks at = now;
  bool measured = false;
  if (crosses(now, side, elapsed, at, measured)) return crossed(at, measured);
  if (unbooked_ != 0) book();
  const Ticks patience = static_cast<Ticks>(sector_ < 0x5000 ? sector_ + sector_ / 2 : sector_);
  return elapsed < patience ? Order{} : miss(now);
}

Pace Commutation::pace() {
  if (unbooked_ != 0) book();
  return state_ == State::running ? pace_of(sectors_, newest_, waited_) : Pace{};
}

Pace pace_of(const std::array<Ticks, 6>& sectors, std::uint8_t newest, std::uint32_t waited) {
  Pace pace;
  for (const Ticks length : sectors) {
    if (length == 0) return {};
    pace.revolution += length;
  }
  const auto last = [&](unsigned back) { return sector_of(sectors, newest, back); };
  const std::uint32_t two = last(1) + last(2), before = last(3) + last(4);
  pace.slowing = two * 64u > before * 65u || waited * 20u > two * 11u;
  pace.sector = two / 2u;
  pace.four = two + before;
  if (waited > pace.sector) pace.sector = waited;
  if (4u * waited > pace.four) pace.four = 4u * waited;
  return pace;
}

}  // namespace fw::esc
