#include "plant/motor/commutation.hpp"

#include <algorithm>
#include <cmath>

#include "base/angles.hpp"

namespace whirl::plant {
namespace {

// Back-EMF of the third phase against the mean of the other two, as shares of the pair's mean E: when
// it goes out, the most it reaches against the current while open, and how fast it falls from the
// first to the second, per electrical radian.
struct Shape {
  double outgoing, open, loss_prad;
};
constexpr Shape kTrapezoid{0.5, 0.5, 3.0 / kPi};
constexpr Shape kSine{0.25 * kPi / 1.7320508, 0.25 * kPi / 1.7320508, kPi / 4.0};

const Shape& shape_of(const MotorParams& p) {
  return p.back_emf == BackEmf::trapezoidal ? kTrapezoid : kSine;
}

// The outgoing current: L dy/dt = -(2/3)(push - 2 loss t) - R y from I to 0, R y taken at its mean.
struct Tail {
  double time_s = 0.0, charge_C = 0.0, lost_Vs = 0.0;  // lost: integral of loss t y
};

Tail run_down(double I, double push_V, double loss_Vps, double R, double L, double most_s) {
  const double g = 2.0 / 3.0 * push_V + 0.5 * R * I;
  const double room = g * g - 8.0 / 3.0 * loss_Vps * L * I;
  const double rate_V = std::max(g + std::sqrt(std::max(room, 0.0)), 0.1);
  const double t = std::min(2.0 * L * I / rate_V, most_s);
  const double s = loss_Vps * t * t / L;
  return {t, t * (I - t * g / (2.0 * L) + 2.0 / 9.0 * s),
          loss_Vps * t * t * (0.5 * I - t * g / (3.0 * L) + s / 6.0)};
}

// Triangles in the open phase, one per PWM period while its back-EMF is below the threshold: means
// over a sector in which the back-EMF sweeps from 0 to -top (or back), and the mean at -top.
struct Circling {
  double mean_A = 0.0, at_top_A = 0.0, square_A2 = 0.0, braking_W = 0.0;
  double carried_A = 0.0;  // by which the pair's dry current is larger for it
};

Circling circle(const MotorParams& p, const CommutationState& s, double top_V, double swept_V,
                double turn_Vps) {
  const double threshold = s.diode ? 0.5 * p.diode_drop_V : p.diode_drop_V;
  const double h = top_V - threshold;
  if (h <= 0.0 || s.duty >= 1.0) return {};
  const double period = 1.0 / p.pwm_Hz, off = (1.0 - s.duty) * period;
  const double v = 2.0 / 3.0 * h;  // beyond the threshold, where the charge's middle is
  const double back = 2.0 * top_V + p.diode_drop_V;  // what stops the pulsed phase's current
  const double rise = s.diode ? std::min(s.falls_s * back / (back + 2.0 / 3.0 * v), off) : off;
  const double gap = off - rise;
  const double tau = p.inductance_H / s.resistance_ohm;
  const double peak = 4.0 / 3.0 * rise / p.inductance_H * v / (1.0 + 0.5 * rise / tau);
  // The pulsed phase runs dry first: the rest falls slowly through the low side, then on the pulse.
  const double slope = (p.diode_drop_V + top_V - threshold - v) / p.inductance_H;
  const double lasts = std::min(gap, peak / slope);
  const double kept = 1.0 - slope * lasts / std::max(peak, 1e-9);
  const double against = 0.5 * s.bus_V + p.diode_drop_V - threshold;
  const double ends =
      kept * 0.75 * p.inductance_H * peak / std::max({against - v, 0.05 * against, 1e-3});
  const double gap_C = 0.5 * peak * lasts * (1.0 + kept);
  const double mean = (0.5 * peak * (rise + kept * ends) + gap_C) / (v * period);
  const double square =
      peak * peak * (rise + kept * kept * ends + lasts * (1.0 + kept + kept * kept)) / period;
  // What is kept lifts the next pulse too; the pair's own last current is no longer there beside it.
  const double carried = (kept * peak * (period - gap) / (1.0 + 0.5 * (period - gap) / tau) +
                          gap_C - 0.25 * peak * peak * p.inductance_H / back) /
                         (2.0 * period * v);
  const double lag = std::max(0.0, h - 0.4 * period * turn_Vps);
  return {mean * 0.5 * h * h / swept_V, mean * lag, square / (v * v) * h * h * h / 9.0 / swept_V,
          mean * (0.5 * threshold + h / 3.0) * h * h / swept_V, carried * 0.5 * h * h / swept_V};
}

// What one commutation's circumstances come to.
struct Sector {
  Sector(const MotorParams& p, const CommutationState& s);

  double R, L, period_s, time_s, emf_V, off, u_V;
  double fade, share;  // exp(-T_s R/L), and the mean of that exponential over the sector
  bool motoring;
  Circling falling, rising;  // towards -top, and away from it after a change of the low side
  double waits_s = 0.0, wait_C = 0.0;  // under diodes the incoming high side waits for its pulse
  double dry_A = 0.0;
};

Sector::Sector(const MotorParams& p, const CommutationState& s)
    : R(s.resistance_ohm),
      L(p.inductance_H),
      period_s(1.0 / p.pwm_Hz),
      time_s(kPi / 3.0 / std::max(p.pole_pairs * s.speed_radps, 1.0)),
      emf_V(p.torque_constant_NmpA * s.speed_radps),
      off(s.diode ? 1.0 - s.duty : 0.0),
      u_V(s.duty * s.bus_V - off * p.diode_drop_V),
      fade(std::exp(-time_s * R / L)),
      share((1.0 - fade) * L / (R * time_s)),
      motoring(s.pair_A >= 0.0) {
  if (!motoring) return;
  const double top = shape_of(p).open * emf_V;
  falling = circle(p, s, top, 2.0 * top, 2.0 * top / time_s);
  // Circling starts anew when the tail has gone, or with a PWM period.
  const double anew_s = s.dry_A > 0.0 ? 0.5 * period_s : L * s.pair_A / std::max(s.bus_V, 0.1);
  const double swept = std::min(1.0, 2.0 * anew_s / time_s);
  if (swept < 1.0) rising = circle(p, s, top * (1.0 - swept), 2.0 * top, 0.0);
  if (s.dry_A > 0.0) dry_A = s.dry_A + 0.5 * (falling.carried_A + rising.carried_A);
  if (!s.diode) return;
  // A phase that has just begun may run dry once more before the next pulse.
  const double again =
      std::min((emf_V + p.diode_drop_V) / std::max(2.0 * s.bus_V - emf_V, 1e-9) * off, s.duty);
  waits_s = std::min(0.5 * off * (off + again) * period_s, 0.5 * time_s);
  const double lasts_s = std::min(s.falls_s, off * period_s);
  const double waiting_A = std::max(s.pair_A, 0.5 * s.ripple_A) - s.ripple_A / 6.0;
  wait_C = waiting_A * 0.5 * lasts_s * lasts_s / period_s;
}

// The mean of i over sectors that start with slope x S + offset, S being where sectors end.
struct Start {
  double slope = 0.5, offset_A = 0.0, lack_A = 0.0;  // lack: missing from the mean
  double at(double S) const { return slope * S + offset_A; }
};

struct Recovery {
  double ends_A = 0.0, settles_A = 0.0, ratio = 0.0;  // S, (u - E) / R, and its slope by the mean
};

Recovery recover(const Sector& k, const Start& low, const Start& high, double mean_A) {
  const double g = 1.0 - k.fade;
  const double slope = 0.5 * (low.slope + high.slope);
  const double offset = 0.5 * (low.offset_A + high.offset_A);
  const double rise = (1.0 - k.fade * slope) / g;
  const double per_S = rise * (1.0 - k.share) + slope * k.share;
  const double rest =
      offset * (k.share - k.fade * (1.0 - k.share) / g) - 0.5 * (low.lack_A + high.lack_A);
  const double S = (mean_A - rest) / per_S;
  return {S, S * rise - offset * k.fade / g, rise / per_S};
}

// The pair: how far the dips pull its mean, and how much it swings. Answers with S.
double dip(const MotorParams& p, const CommutationState& s, const Sector& k, Commutation& out) {
  Start low{.offset_A = -0.75 * k.falling.at_top_A};
  const double floats_V = shape_of(p).outgoing * k.emf_V + 0.5 * p.diode_drop_V;
  Start high{.offset_A = std::min(floats_V * k.waits_s / k.L, 0.5 * std::abs(s.pair_A)),
             .lack_A = 0.5 * k.wait_C / k.time_s};
  Recovery r = recover(k, low, high, s.pair_A);
  bool dries = false;
  for (Start* side : {&low, &high}) {
    const double start = side->at(r.ends_A), spread = 0.25 * s.ripple_A;  // uniform, each side
    if (!s.diode || start >= k.dry_A + spread) continue;
    const double wet = std::max(0.0, (start + spread - k.dry_A) / (2.0 * spread));  // share
    const double beyond_A = wet * wet * spread;
    const double lasts = std::min(s.dry_s / k.time_s, 1.0), slope = wet * side->slope;
    *side = {slope, k.dry_A + beyond_A - slope * r.ends_A,
             side->lack_A + (k.dry_A + beyond_A - start) * lasts};
    dries = true;
  }
  if (dries) r = recover(k, low, high, s.pair_A);
  out.dry_A = std::max(0.0, k.dry_A - 0.5 * (low.lack_A + high.lack_A));
  out.ohm = k.R * (r.ratio - 1.0);
  out.volts = k.R * (r.settles_A - r.ratio * s.pair_A);
  const double from = 0.5 * (low.at(r.ends_A) + high.at(r.ends_A));
  const double apart = 0.5 * (low.at(r.ends_A) - high.at(r.ends_A));
  const double gap = from - r.settles_A, mean = r.settles_A + gap * k.share;
  const double squared = k.share * 0.5 * (1.0 + k.fade);  // mean of the exponential's square
  out.wobble_A2 = r.settles_A * r.settles_A + 2.0 * r.settles_A * gap * k.share +
                  (gap * gap + apart * apart) * squared - mean * mean;
  if (!dries) {  // the ripple makes the dips' depths differ
    out.wobble_A2 += s.ripple_A * s.ripple_A / 48.0 * squared / (1.0 - 0.25 * k.fade * k.fade);
  }
  return r.ends_A;
}

Tail slow_tail(const MotorParams& p, const CommutationState& s, const Sector& k, double I,
               double pushing_V, double loss_Vps) {
  const double after_V = 2.0 * p.diode_drop_V + pushing_V;
  if (k.waits_s <= 0.0) return run_down(I, k.u_V + after_V, loss_Vps, k.R, k.L, k.time_s);
  // What is left when the pulse comes runs down against the whole bus as long as the pulse lasts.
  const double valley_A = std::max(I - 0.5 * s.ripple_A, 0.0);
  const double left_A = std::sqrt(k.off * valley_A * valley_A + s.duty * I * I);
  const double pulsed_s = 1.5 * k.L * left_A / std::max(s.bus_V + after_V, 1e-9);
  const double pulsed = std::min(1.0, s.duty * k.period_s / std::max(pulsed_s, 1e-9));
  Tail tail =
      run_down(left_A, k.u_V + pulsed * (s.bus_V - k.u_V) + after_V, loss_Vps, k.R, k.L, k.time_s);
  tail.lost_Vs += loss_Vps * k.waits_s * (tail.charge_C + 0.5 * k.wait_C);
  tail.charge_C += k.wait_C;
  return tail;
}

}  // namespace

Commutation commutate(const MotorParams& p, const CommutationState& s) {
  Commutation out;
  const Sector k(p, s);
  const double I = std::abs(dip(p, s, k, out));

  const Shape& shape = shape_of(p);
  const double sense = k.motoring ? 1.0 : -1.0;
  const double loss_Vps = sense * shape.loss_prad * k.emf_V * kPi / 3.0 / k.time_s;
  const double pushing_V = sense * 2.0 * shape.outgoing * k.emf_V;
  const double into_bus_V = 2.0 * (s.bus_V + p.diode_drop_V) - k.u_V + pushing_V;
  const Tail fast = run_down(I, into_bus_V, loss_Vps, k.R, k.L, k.time_s);
  const Tail slow = slow_tail(p, s, k, I, pushing_V, loss_Vps);
  const double tails_A = 0.5 * (fast.charge_C + slow.charge_C) / k.time_s;
  const double circling_A = 0.5 * (k.falling.mean_A + k.rising.mean_A);

  out.third_A = tails_A + circling_A;
  out.third_A2 = 2.0 / 3.0 * I * tails_A + 0.5 * (k.falling.square_A2 + k.rising.square_A2);
  // While it flows, the pulsed phase's own diode carries half of it more or less.
  out.diode_A =
      0.5 * ((1.0 + 0.5 * k.off) * fast.charge_C + (1.0 - 0.5 * k.off) * slow.charge_C) / k.time_s +
      (s.diode ? 0.55 : 1.0) * circling_A;
  if (k.emf_V > 0.0) {
    const double lost_W = 0.5 * std::abs(fast.lost_Vs + slow.lost_Vs) / k.time_s;
    const double braked_W = 0.5 * (k.falling.braking_W + k.rising.braking_W);
    out.push_A = (sense * (shape.outgoing * k.emf_V * tails_A - lost_W) - braked_W) / k.emf_V;
  }
  return out;
}

}  // namespace whirl::plant
