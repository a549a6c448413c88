#include "firmware/esc/image/motor_drive.hpp"

#include "firmware/esc/image/bridge.hpp"
#include "firmware/esc/image/sampling.hpp"
#include "firmware/hal/interrupts.hpp"

namespace fw::esc {
namespace {

constexpr std::uint16_t kAlign_ms = 143;
// 5 us in 100: no more than 4 A that last 10 us, a hundredth of a rad/s to either side.
constexpr std::uint32_t kProbe_duty = bridge::kPeriod / 10;
// More, for a rotor that the air turns backward. With 100 ms one start in thirteen between 20 and 200 rad/s
// is lost and takes 0.88 s (test_plans/esc/backward.lua's stand), with 200 none; with none, six.
constexpr std::uint16_t kBrake_ms = 200;
constexpr std::uint16_t kStarting_ms = 300;  // a start that has not caught on by then is begun anew

static_assert(WindingGuard::kPeriod == bridge::kPeriod);
static_assert(WindingGuard::kShortest == bridge::kShortest_on);

}  // namespace

void MotorDrive::go_off() {
  bridge::off();
  bridge::acknowledge_interrupt();  // none that is due may meet the next start
  commutation_.stop();
  phase_ = Phase::off;
  sampling::watch_floating(2);
}

// With all switches off no current can build up, whatever the rotor does.
void MotorDrive::go_catching() {
  go_off();
  phase_ = Phase::catching;
  catching_.start(bridge::now());
  sampling::watch_phases();
}

void MotorDrive::look_for_rotor() {
  const sampling::Phases phases = sampling::take_phases();
  record(zero_counts_ / 64, phases.bus);
  const hal::InterruptLock lock;
  const Ticks now = bridge::now();
  switch (catching_.on_sample(now, phases.a, phases.b, phases.c)) {
    case Catching::Found::nothing_yet:
      return;
    case Catching::Found::backward:
    case Catching::Found::standing:
      phase_ = Phase::aligning;
      phase_ms_ = 0;
      align_ms_ = catching_.backward() ? kAlign_ms + kBrake_ms : kAlign_ms;
      bridge::apply(0);
      sampling::watch_floating(bridge::floating_phase(0));
      break;
    case Catching::Found::turning: {
      phase_ = Phase::turning;
      phase_ms_ = 0;
      commutation_.join(now, catching_.step(), catching_.sector());
      // As much voltage as the rotor gives: no current until the core has its say.
      const std::uint32_t emf_counts = commutation_.config().flux_count_ticks /
                                       (catching_.sector() > 0 ? catching_.sector() : 1u);
      wanted_duty_ = bridge::kPeriod * emf_counts / static_cast<std::uint32_t>(phases.bus + 1);
      bridge::set_duty(wanted_duty_);
      bridge::apply(commutation_.step());
      sampling::watch_floating(bridge::floating_phase(commutation_.step()));
      break;
    }
  }
  guard_.restart();
}

void MotorDrive::go_probing() {
  phase_ = Phase::probing;
  pulsed_ = false;
  bridge::let_go();
  bridge::set_duty(kProbe_duty);
  commutation_.middles().begin_probe();
}

void MotorDrive::probe() {
  const sampling::Sample sample = sampling::read();
  record(sample.shunt, sample.bus);
  const hal::InterruptLock lock;
  if (phase_ != Phase::probing) return;
  Middles& middles = commutation_.middles();
  const bool done = pulsed_ && middles.probe(sample.floating, sample.bus);
  bridge::let_go();
  pulsed_ = !pulsed_;
  if (!done) {
    if (!pulsed_) return;
    bridge::apply(middles.probed_step());
    sampling::select_floating(bridge::floating_phase(middles.probed_step()));
    return;
  }
  phase_ = Phase::turning;
  phase_ms_ = 0;
  bridge::set_duty(wanted_duty_);
  bridge::interrupt_at(commutation_.start(bridge::now()).at);
}

void MotorDrive::record(int shunt_counts, int bus_counts) {
  shunt_sum_ += static_cast<std::uint32_t>(shunt_counts);
  bus_sum_ += static_cast<std::uint32_t>(bus_counts);
  ++samples_;
}

void MotorDrive::on_sample() {
  if (phase_ == Phase::catching) [[unlikely]]
    return look_for_rotor();
  if (phase_ == Phase::probing) [[unlikely]]
    return probe();
  const sampling::Sample sample = sampling::read();
  record(sample.shunt, sample.bus);
  if (phase_ == Phase::off) [[unlikely]] {
    zero_counts_ += (64 * sample.shunt - zero_counts_) / 64;
    return;
  }
  watch_current(sample.shunt - (zero_counts_ >> 6), sample.bus);
  if (phase_ == Phase::turning) [[likely]]
    commutate_by(sample.floating, sample.bus);
}

void MotorDrive::watch_current(int shunt_counts, int bus_counts) {
  guard_.update(shunt_counts, bridge::duty());
  if (guard_.tripped()) [[unlikely]] {
    const hal::InterruptLock lock;
    go_off();
    tripped_ = true;
    return;
  }
  const std::uint32_t allowed = guard_.allowed(wanted_duty_, bus_counts, commutation_.braked());
  // A pulse too short to be sampled would hide the zero crossings; the shortest one drives nothing.
  bridge::set_duty(allowed > bridge::kShortest_on ? allowed : bridge::kShortest_on);
}

void MotorDrive::commutate_by(int floating_counts, int bus_counts) {
  // A commutation in here would lie after `now`: the sector would seem over, and a step be skipped.
  const hal::InterruptLock lock;
  const Commutation::Order order =
      commutation_.on_sample(bridge::now(), floating_counts, bus_counts);
  if (order.commutate) bridge::interrupt_at(order.at);
  if (commutation_.state() == Commutation::State::stopped) [[unlikely]]
    go_catching();
}

void MotorDrive::on_commutation() {
  bridge::acknowledge_interrupt();
  if (phase_ != Phase::turning) return;
  const std::uint8_t step = commutation_.step();
  bridge::apply(step);
  sampling::select_floating(bridge::floating_phase(step));
  commutation_.on_commutated(bridge::now());
  if (commutation_.state() == Commutation::State::stopped) go_catching();
}

void MotorDrive::know(const Calibration& calibration) {
  guard_.configure(calibration.motor_within_limits().max_current_A, calibration.sense.gain);
  commutation_.know(calibration.motor.Kt_NmpA);
}

void MotorDrive::follow(const Drive& wanted) {
  const hal::InterruptLock lock;
  if (!wanted.energised) {
    if (phase_ != Phase::off) go_off();
    return;
  }
  wanted_duty_ = bridge::counts_of(wanted.duty);
  switch (phase_) {
    case Phase::off:
      return go_catching();
    case Phase::aligning:
      if (++phase_ms_ >= align_ms_) go_probing();
      return;
    case Phase::turning:
      if (commutation_.in_sync()) {
        phase_ms_ = 0;
      } else if (++phase_ms_ > kStarting_ms) {
        go_catching();
      }
      return;
    case Phase::catching:
    case Phase::probing:
      return;
  }
}

Sensed MotorDrive::sense() {
  std::uint32_t shunt = 0, bus = 0, n = 0;
  Pace pace;
  {
    const hal::InterruptLock lock;
    shunt = shunt_sum_;
    bus = bus_sum_;
    n = samples_;
    shunt_sum_ = bus_sum_ = samples_ = 0;
    guard_.tick();
    pace = commutation_.pace();
  }
  const float one_radps = commutation_.one_radps();
  const float revolution_radps = Pace::radps(pace.revolution, 6.0f, one_radps);
  const float per_sample = n > 0 ? 1.0f / static_cast<float>(n) : 0.0f;
  return {.bus_voltage_V = static_cast<float>(bus) * per_sample * kVolts_per_count,
          .bus_current_A = static_cast<float>(shunt) * per_sample * kAmperes_per_count,
          .speed_radps = speed_.update(revolution_radps, pace.revolution > 0),
          .in_sync = pace.revolution > 0,
          .slowing = pace.slowing,
          .latest_radps = Pace::radps(pace.sector, 1.0f, one_radps),
          .recent_radps = Pace::radps(pace.four, 4.0f, one_radps)};
}

bool MotorDrive::tripped() {
  const bool was = tripped_;
  tripped_ = false;
  return was;
}

}  // namespace fw::esc
