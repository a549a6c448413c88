// Six-step commutation without sensors: finds the zero crossing of the floating phase in samples that
// were taken while the PWM was on, and says when to commutate next.
//
//   Steps    0 A+B-, 1 A+C-, 2 B+C-, 3 B+A-, 4 C+A-, 5 C+B-; the third phase floats. Its back-EMF falls
//            through half the bus voltage in even steps and rises in odd ones.
//   Time     ticks of a free-running 16-bit timer; differences are modulo 2^16, so a sector may last
//            up to half of its period
//   Law      commutate half a sector after the crossing; samples right after a commutation, while the
//            diodes still carry the old current, are not looked at
//   Lost     crossings that do not come, or whose back-EMF is too small for the speed they tell of (a
//            rotor that stands shows noise around the middle): it stops
//   Source   classic trapezoidal control; speed from crossings [Bangura 2017, sec. 3.3.1.1]
#pragma once
#include <array>
#include <cstdint>

#include "firmware/esc/core/middles.hpp"

namespace fw::esc {

using Ticks = std::uint16_t;

struct CommutationConfig {
  float ticks_per_s = 2.0e6f;
  std::uint8_t pole_pairs = 7;
  Ticks align_sector = 24'000;  // a forced sector while starting: 12 ms, shrinking
  Ticks shortest_sector = 180;  // 90 us: beyond 13,000 rpm with 7 pole pairs
  Ticks start_blank = 300;      // while starting, sectors are only guessed: 150 us
  Ticks swing = 6000;  // so long a rotor that still swings from its alignment may turn back: 3 ms
  int start_clear_counts = 10;     // doubled, off the middle; or 5/8 of the noise's range, if more
  std::uint8_t blank_share = 32;   // of 256: share of a sector that is not looked at
  std::uint8_t advance_share = 8;  // of 256: commutate earlier by this share of a sector
  // Line-to-line back-EMF in counts times a sector's ticks: the same at every speed. 0.01005 V s over
  // a sixth of one of 7 turns, at 6.177 mV per count.
  std::uint32_t flux_count_ticks = 486'700;

  constexpr float one_radps() const {  // mechanical, of a sector that takes one tick
    constexpr float kSixth = 1.0471976f;
    return kSixth * ticks_per_s / static_cast<float>(pole_pairs);
  }
};
inline constexpr float kFlux_per_Kt = 486'700.0f / 0.01005f;

// What the crossings say of the speed, in ticks.
struct Pace {
  std::uint32_t revolution = 0;  // the last six sectors; 0: not running
  std::uint32_t sector = 0;  // mean of the last two, or of the next one so far if that is longer
  std::uint32_t four =
      0;  // the last four sectors, or the next one so far if a sector of them is shorter
  bool slowing = false;  // the last two took longer than the two before, by more than noise
  // one_radps: CommutationConfig::one_radps().
  static float radps(std::uint32_t ticks, float sectors, float one_radps) {
    return ticks == 0 ? 0.0f : sectors * one_radps / static_cast<float>(ticks);
  }
};

// Of the last six sectors, sectors[newest] to be written next, and of the time since the last crossing.
Pace pace_of(const std::array<Ticks, 6>& sectors, std::uint8_t newest, std::uint32_t waited);

class Commutation {
 public:
  enum class State : std::uint8_t { stopped, starting, running };
  struct Order {
    bool commutate = false;  // go to step() at time `at`
    Ticks at = 0;
  };

  constexpr explicit Commutation(const CommutationConfig& config)
      : config_(config),
        one_radps_(config.one_radps()),
        start_clear_counts_(config.start_clear_counts) {}

  void stop();
  void know(float Kt_NmpA) {
    config_.flux_count_ticks = static_cast<std::uint32_t>(kFlux_per_Kt * Kt_NmpA);
  }
  // The rotor has been aligned to step 0's field: the first commutation comes at once.
  Order start(Ticks now);
  // The rotor turns, and `step` is right from now on (catching.hpp).
  void join(Ticks now, std::uint8_t step, Ticks sector);
  // A sample of the floating phase, in counts, with the bus in the same scale.
  Order on_sample(Ticks now, int floating_counts, int bus_counts);
  // The ordered time has come and the bridge has been set to step().
  Order on_commutated(Ticks now);

  Middles& middles() { return middles_; }
  State state() const { return state_; }
  std::uint8_t step() const { return step_; }
  Pace pace();
  float speed_radps() {  // mechanical, of the last revolution (electrical); 0 unless running
    const Pace p = pace();
    return Pace::radps(p.revolution, 6.0f, one_radps_);
  }
  float one_radps() const { return one_radps_; }  // of a sector that takes one tick
  // Pace::slowing as of the last crossing, for those who come by more often.
  bool braked() const { return braked_; }
  const CommutationConfig& config() const { return config_; }
  bool in_sync() const { return state_ == State::running; }
  std::uint32_t bad_detections() const { return bad_detections_; }

 private:
  static constexpr int kInARow = 6;  // crossings that make a start, or their lack a loss
  // While starting, samples pass a mean of the last few: its noise is 2.6 times less, and it comes 150 us late.
  static constexpr int kSmoothing = 4;
  static constexpr Ticks kSmoothing_lag = 300;
  static constexpr int kLearning = 30;  // ticks that a sample which learns takes, and some: 15 us

  static std::uint8_t previous_of(std::uint8_t step) {
    return static_cast<std::uint8_t>(step == 0 ? 5 : step - 1);
  }
  std::uint8_t previous_step() const { return previous_of(step_); }
  Order overtaken(Ticks now, int side, int bus_counts);
  Order crossed(Ticks at, bool measured);
  int smoothed(int off, bool at_rail);
  bool crosses(Ticks now, int side, Ticks elapsed, Ticks& at, bool& measured);
  bool commutates_later(Ticks now) const;
  __attribute__((noinline)) void learn(int bus_counts);  // not on every sample's way
  void lose();
  bool measure(Ticks length, bool measured);
  __attribute__((noinline)) void book();
  Ticks bounded(std::uint32_t sector) const;
  Order wait_for_commutation(Ticks now, int off, bool at_rail, int bus_counts);
  __attribute__((noinline)) Order miss(Ticks now);
  void wait(Ticks now);
  bool back_emf_fits();
  Order order(Ticks at);

  CommutationConfig config_;
  float one_radps_;
  State state_ = State::stopped;
  std::uint8_t step_ = 0;
  Ticks sector_ = 0;  // expected length
  Ticks commutated_at_ = 0;
  Ticks crossed_at_ = 0;
  Ticks before_at_ = 0;  // last sample on the near side of the crossing
  int before_counts_ = 0;
  int smooth_ = 0;  // while starting: kSmoothing times the mean of the last few off the middle
  bool seen_before_ = false;
  bool ordered_ = false;
  bool braked_ = false;
  bool crossing_known_ = false;  // of the last sector
  std::uint8_t good_ = 0, missed_ = 0, unfit_ = 0;
  Ticks sampled_at_ = 0;
  std::uint32_t waited_ = 0;    // since the last crossing; does not wrap
  int highest_counts_ = 0;      // of the floating phase off the middle, doubled, in this sector
  int start_clear_counts_ = 0;  // of the latest start
  Ticks last_length_ = 0;  // of the sector before, between two measured crossings; 0: it was not
  int longer_ = 0;         // the last sector than the one before, both so measured; 0: learnt
  bool measured_ = false;  // the last crossing was
  Ticks unbooked_ = 0;     // the last sector, until book(); 0: it has been
  std::array<Ticks, 6> sectors_{};
  std::uint8_t newest_ = 0;
  std::uint32_t bad_detections_ = 0;
  Middles middles_;
};

}  // namespace fw::esc
