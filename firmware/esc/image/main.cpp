// The image of the motor controller: three interrupts that matter and a control tick of 1 kHz.
//
//   TIM2     commutation, most urgent
//   ADC1_2   20 kHz: floating phase, bus, shunt; finds zero crossings, trips on over-current
//   SysTick  1 kHz: the control core; feeds the watchdog
//   Main     the command line and the stream, otherwise asleep
#include "firmware/esc/core/core.hpp"
#include "firmware/esc/core/pulse_throttle.hpp"
#include "firmware/esc/image/bridge.hpp"
#include "firmware/esc/image/can_node.hpp"
#include "firmware/esc/image/clock.hpp"
#include "firmware/esc/image/commands.hpp"
#include "firmware/esc/image/i2c_slave.hpp"
#include "firmware/esc/image/motor_drive.hpp"
#include "firmware/esc/image/pulse_input.hpp"
#include "firmware/esc/image/registers.hpp"
#include "firmware/esc/image/sampling.hpp"
#include "firmware/esc/image/serial.hpp"
#include "firmware/esc/image/settings.hpp"
#include "firmware/esc/image/stream.hpp"

namespace {

using namespace fw;
using namespace fw::esc;

// Built by fw_main, in place: start-up runs no constructors.
alignas(Core) unsigned char core_memory[sizeof(Core)];
Core* core = nullptr;
Settings stored;
MotorDrive drive;
ZeroCurrent zero;
PulseThrottle pulses;
ThrottleSources sources;
volatile std::uint32_t ticks = 0;  // the main loop looks at it

StreamSample sample(float raw_current_A) {
  const ThrustEstimator& found = core->estimator();
  const ThrustEstimate& solution = found.solution();
  return {.tick = ticks,
          .bus_voltage_V = core->bus_voltage_V(),
          .raw_current_A = raw_current_A,
          .zero_current_A = zero.offset_A(),
          .bus_current_A = core->measured_current_A(),
          .winding_current_A = found.current_A(),
          .duty = core->drive().energised ? core->drive().duty : 0.0f,
          .speed_radps = core->speed_radps(),
          .wanted_speed_radps = core->wanted_speed_radps(),
          .acceleration_radps2 = found.acceleration_radps2(),
          .power_W = found.power_W(),
          .CP = found.CP(),
          .CT = found.CT(),
          .thrust_N = found.thrust_N(),
          .inflow_ratio = solution.ls,
          .solver_status = static_cast<std::uint8_t>(solution.status),
          .iterations = solution.iterations,
          .flags = core->flags(),
          .mode = static_cast<std::uint8_t>(core->mode())};
}

void take_setpoints() {
  using Source = ThrottleSources::Source;
  const auto follow = [](Source from, std::uint16_t v) {
    if (sources.admit(from, core->supervisor().armed())) core->on_setpoint(v);
  };
  std::uint16_t v = 0;
  if (i2c_slave::take_setpoint(v)) follow(Source::i2c, v);
  if (can_node::take_setpoint(core->mode(), v)) follow(Source::can, v);
  Pulse pulse;
  if (pulse_input::read(pulse) && pulses.read(pulse.width_us, pulse.period_us, v)) {
    follow(Source::pulses, v);
  }
  sources.tick();
}

void start_tick() {
  using namespace f103;
  SysTick::SHPR3::replace(0xFFu << 24, kPriorityControl << 28);
  SysTick::LOAD::write(72'000 - 1);
  SysTick::VAL::write(0);
  SysTick::CTRL::write(SysTick::CLKSOURCE | SysTick::TICKINT | SysTick::ENABLE);
}

}  // namespace

namespace fw::esc {

__attribute__((noinline)) void control_task() {
  i2c_slave::supervise();
  take_setpoints();
  Sensed sensed = drive.sense();
  if (drive.tripped()) core->latch(Latched::over_current);
  if (drive.energised()) {
    zero.turns();
  } else if (core->at_rest()) {
    zero.record(sensed.bus_current_A);
    drive.know(core->calibration());
  }
  const float raw_current_A = sensed.bus_current_A;
  const float duty = static_cast<float>(bridge::duty()) / static_cast<float>(bridge::kPeriod);
  sensed.bus_current_A = without_ripple(sensed.bus_current_A - zero.offset_A(), duty);
  const Drive wanted = core->tick(sensed);
  drive.follow(wanted);
  i2c_slave::publish({static_cast<std::int16_t>(1000.0f * core->bus_current_A()),
                      static_cast<std::uint16_t>(core->speed_radps() / kRadps_per_rpm),
                      core->flags()});
  can_node::publish({.voltage_V = core->bus_voltage_V(),
                     .current_A = core->bus_current_A(),
                     .speed_rpm = static_cast<std::int32_t>(core->speed_radps() / kRadps_per_rpm),
                     .flags = core->flags()});
  ticks = ticks + 1;
  if (stream::due()) stream::record(sample(raw_current_A));
}

__attribute__((noinline)) void sampling_task() {
  drive.on_sample();
}

__attribute__((noinline)) void commutation_task() {
  drive.on_commutation();
}

}  // namespace fw::esc

extern "C" void systick_handler() {
  fw::esc::control_task();
  fw::f103::IWDG::KR::write(fw::f103::IWDG::RELOAD);
}
extern "C" void adc1_2_handler() {
  fw::esc::sampling_task();
}
extern "C" void tim2_handler() {
  fw::esc::commutation_task();
}

extern "C" void fw_main() {
  start_clock();
  settings::load(stored);
  core = new (core_memory) Core(stored.calibration);
  bridge::start();
  sampling::start();
  serial::start();
  i2c_slave::start(protocol::address_of(stored.motor_number));
  can_node::start(stored.motor_number);
  pulse_input::start();
  start_watchdog();
  start_tick();
  for (;;) {
    stream::send();
    go_on(ticks, *core, stored);
    const std::string_view line = serial::take_line();
    if (!line.empty()) {
      execute(line, *core, stored);
    } else {
      __asm volatile("wfi");
    }
  }
}
