// Six-step commutation without sensors: finds the zero crossing of the floating phase in samples that
// were taken while the PWM was on, and says when to commutate next.
//
//   Steps    0 A+B-, 1 A+C-, 2 B+C-, 3 B+A-, 4 C+A-, 5 C+B-; the third phase floats. Its back-EMF falls
//            through half the bus voltage in even steps and rises in odd ones.
//   Time     ticks of a free-running 16-bit timer; differences are modulo 2^16, so a sector may last
//            up to half of its period
//   Law      commutate half a sector after the crossing; samples right after a commutation, while the
//            diodes still carry the old current, are not looked at
//   Source   classic trapezoidal control; speed from crossings [Bangura 2017, sec. 3.3.1.1]
#pragma once
#include <array>
#include <cstdint>

namespace fw::esc {

using Ticks = std::uint16_t;

struct CommutationConfig {
  float ticks_per_s = 2.0e6f;
  std::uint8_t pole_pairs = 7;
  Ticks align_sector = 24'000;     // a forced sector while starting: 12 ms, shrinking
  Ticks shortest_sector = 180;     // 90 us: beyond 13,000 rpm with 7 pole pairs
  Ticks start_blank = 300;         // while starting, sectors are only guessed: 150 us
  int start_clear_counts = 10;     // doubled counts off the middle that noise alone does not reach
  std::uint8_t blank_share = 32;   // of 256: share of a sector that is not looked at
  std::uint8_t advance_share = 8;  // of 256: commutate earlier by this share of a sector
};

class Commutation {
 public:
  enum class State : std::uint8_t { stopped, starting, running };
  struct Order {
    bool commutate = false;  // go to step() at time `at`
    Ticks at = 0;
  };

  constexpr explicit Commutation(const CommutationConfig& config) : config_(config) {}

  void stop();
  // The rotor has been aligned to step 0's field: the first commutation comes at once.
  Order start(Ticks now);
  // A sample of the floating phase, in counts, with the bus in the same scale.
  Order on_sample(Ticks now, int floating_counts, int bus_counts);
  // The ordered time has come and the bridge has been set to step().
  Order on_commutated(Ticks now);

  State state() const { return state_; }
  std::uint8_t step() const { return step_; }
  float speed_radps() const;  // mechanical; 0 unless running
  bool in_sync() const { return state_ == State::running; }
  std::uint32_t bad_detections() const { return bad_detections_; }

 private:
  static constexpr int kInARow = 6;  // crossings that make a start, or their lack a loss

  std::uint8_t previous_step() const { return static_cast<std::uint8_t>((step_ + 5) % 6); }
  Order overtaken(Ticks now, int side, int bus_counts);
  Order crossed(Ticks at);
  void lose();
  void note_sector(Ticks length);
  Order order(Ticks at);

  CommutationConfig config_;
  State state_ = State::stopped;
  std::uint8_t step_ = 0;
  Ticks sector_ = 0;  // expected length
  Ticks commutated_at_ = 0;
  Ticks crossed_at_ = 0;
  Ticks before_at_ = 0;  // last sample on the near side of the crossing
  int before_counts_ = 0;
  bool seen_before_ = false;
  bool ordered_ = false;
  bool crossing_known_ = false;  // of the last sector
  std::uint8_t good_ = 0, missed_ = 0;
  std::array<Ticks, 6> sectors_{};
  std::uint8_t newest_ = 0;
  std::uint32_t bad_detections_ = 0;
};

}  // namespace fw::esc
