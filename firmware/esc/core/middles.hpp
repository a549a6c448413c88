// Where the floating phase stands without back-EMF, step by step: half the bus on paper, elsewhere by what
// dividers, converter offsets and phases that differ make of it.
//
//   Units    twice the floating phase over the bus, both in counts: 32768 is one, the paper's half
//   At rest  the mean of some samples of each step in pulses too short to turn the rotor (probe())
//   Turning  crossings of a steady rotor are evenly spaced. One that comes early between its neighbours
//            has its middle moved so that it comes later, by an eighth of what is missing. What would move
//            all six alike is taken off again: no spacing tells it, and a rotor that gains speed looks so
//   Noise    the widest range of a step's samples at rest: what a start has to see beyond it
//   Left out windings whose inductance depends on the rotor's angle shift what is found at rest; turning
//            puts that right within some 20 revolutions (electrical)
#pragma once
#include <array>
#include <cstdint>

namespace fw::esc {

class Middles {
 public:
  static constexpr int kSamples = 12;  // of each step, at rest

  // Twice the floating phase's counts off its middle.
  int off(std::uint8_t step, int floating_counts, int bus_counts) const {
    return 2 * floating_counts - ((bus_counts * one_[step]) >> 15);
  }

  void begin_probe() {
    step_ = samples_ = 0;
    floating_sum_ = bus_sum_ = 0;
    noise_counts_ = 0;
  }
  std::uint8_t probed_step() const { return step_; }
  // A sample of probed_step(). True: that was the last one of all.
  bool probe(int floating_counts, int bus_counts) {
    const int doubled = 2 * floating_counts - bus_counts;
    if (samples_ == 0 || doubled < least_) least_ = doubled;
    if (samples_ == 0 || doubled > most_) most_ = doubled;
    floating_sum_ += static_cast<std::uint32_t>(floating_counts);
    bus_sum_ += static_cast<std::uint32_t>(bus_counts);
    if (++samples_ < kSamples) return false;
    if (most_ - least_ > noise_counts_) noise_counts_ = most_ - least_;
    one_[step_] = bounded(bus_sum_ > 0 ? static_cast<int>((floating_sum_ << 16) / bus_sum_) : kOne);
    floating_sum_ = bus_sum_ = 0;
    samples_ = 0;
    return ++step_ == 6;
  }
  // Of doubled counts: the range of kSamples of them is some 3.3 sigma.
  int noise_counts() const { return noise_counts_; }

  // The crossing of `step` came `early_counts` (doubled, of the floating phase) before the even spacing.
  void learn(std::uint8_t step, int early_counts, int bus_counts) {
    if (bus_counts <= 0) return;
    const int share = early_counts * (kOne / kSlowness) / bus_counts;
    // Later is lower where the phase falls (even steps) and higher where it rises.
    move(step, share);
    rest_ += share;
    const int each = rest_ / 6;  // from one after the other, for an interrupt's time is short
    move(next_, -each);
    rest_ -= each;
    next_ = next_ == 5 ? std::uint8_t{0} : static_cast<std::uint8_t>(next_ + 1);
  }

 private:
  static constexpr int kOne = 1 << 15, kMost_off = kOne / 20, kSlowness = 8;

  static std::uint16_t bounded(int one) {
    if (one < kOne - kMost_off) return kOne - kMost_off;
    return static_cast<std::uint16_t>(one > kOne + kMost_off ? kOne + kMost_off : one);
  }
  void move(std::uint8_t step, int later) {
    one_[step] = bounded(one_[step] + ((step & 1) != 0 ? later : -later));
  }

  std::array<std::uint16_t, 6> one_{kOne, kOne, kOne, kOne, kOne, kOne};
  int rest_ = 0;           // of what all six have been moved by alike, still to be taken off
  std::uint8_t next_ = 0;  // whose turn it is
  std::uint8_t step_ = 0;
  int samples_ = 0, least_ = 0, most_ = 0, noise_counts_ = 0;
  std::uint32_t floating_sum_ = 0, bus_sum_ = 0;
};

}  // namespace fw::esc
