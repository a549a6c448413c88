// The flight image: boots, brings up its buses and runs its tasks, one tick per IMU sample.
//
//   Tick    the end of the IMU's burst, 1 kHz; a hardware timer when the IMU stays away
//   Tasks   run to completion, one after the other, in the order of schedule.hpp; between ticks the
//           core sleeps. Interrupts only move bytes
//   Watch   the watchdog is fed when each task has run since the last time
#include <tuple>

#include "firmware/config/parameter_store.hpp"
#include "firmware/config/vehicle.hpp"
#include "firmware/drivers/cppm_receiver.hpp"
#include "firmware/drivers/esc_bus.hpp"
#include "firmware/drivers/hmc5883l.hpp"
#include "firmware/drivers/mpu6000.hpp"
#include "firmware/drivers/ms5611.hpp"
#include "firmware/flight/flight.hpp"
#include "firmware/flight/schedule.hpp"
#include "firmware/hal/clock.hpp"
#include "firmware/hal/edge_capture.hpp"
#include "firmware/hal/fault_record.hpp"
#include "firmware/hal/flash.hpp"
#include "firmware/hal/i2c_master.hpp"
#include "firmware/hal/interrupts.hpp"
#include "firmware/hal/pins.hpp"
#include "firmware/hal/spi_master.hpp"
#include "firmware/hal/time_base.hpp"
#include "firmware/hal/uart_link.hpp"
#include "firmware/hal/watchdog.hpp"
#include "firmware/link/telemetry.hpp"

namespace fw {

constinit Faults faults;
constinit Health health;

namespace {

constinit Mpu6000<hal::SpiMaster> imu(hal::spi1);
constinit EscBus<hal::I2cMaster<hal::EscI2c>> escs(hal::i2c3);
constinit Ms5611<hal::I2cMaster<hal::SensorI2c>> barometer(hal::i2c2);
constinit Hmc5883l<hal::I2cMaster<hal::SensorI2c>> magnetometer(hal::i2c2);
constinit ParameterStore<hal::ParameterSectors> store(hal::parameter_sectors);
constinit CppmReceiver receiver;
volatile bool sticks_came = false;
volatile std::uint32_t ticks_due = 0;
volatile bool sample_ready = false;

enum Ran : std::uint8_t {
  kImu = 1,
  kAttitude = 2,
  kPosition = 4,
  kEsc = 8,
  kTelemetry = 16,
  kSensors = 32,
  kAll = 63
};

Flight& flight() {  // built at the first call: Eigen's vectors have no constant initialisers
  static Flight instance;
  return instance;
}

Telemetry& telemetry() {
  static Telemetry instance(flight());
  return instance;
}

}  // namespace

void imu_data_ready() {
  if (!imu.data_ready(hal::now_us())) ticks_due = ticks_due + 1;
}

void imu_transfer_done() {
  if (!imu.transfer_done()) return;
  sample_ready = true;
  ticks_due = ticks_due + 1;
}

void fallback_tick() {
  if (imu.running()) ++faults.imu_samples_lost;
  ticks_due = ticks_due + 1;
}

void receiver_edge(std::uint32_t edge_us) {
  if (receiver.edge(edge_us)) sticks_came = true;
}

void esc_job_done(const hal::I2cJob& job, Status status) {
  escs.job_done(job, status);
}

void sensor_job_done(const hal::I2cJob& job, Status status) {
  if (job.address == barometer.kAddress) barometer.job_done(job, status);
  if (job.address == magnetometer.kAddress) magnetometer.job_done(job, status);
}

// From the sensor's axes to the body's.
static Vector3 mounted(const float (&of_sensor)[3], const config::Mounting& m) {
  return {m.sign[0] * of_sensor[m.axis[0]], m.sign[1] * of_sensor[m.axis[1]],
          m.sign[2] * of_sensor[m.axis[2]]};
}

__attribute__((noinline)) void imu_task() {
  constexpr std::uint32_t kFrozen_samples = 50;
  static constinit ImuBurst last;
  static constinit std::uint32_t same = 0;
  if (!imu.running()) std::ignore = imu.setup_tick();
  if (!sample_ready) return flight().on_imu_missing();
  sample_ready = false;
  const ImuBurst burst = imu.burst();
  same = burst == last ? same + 1 : 0;
  last = burst;
  if (same == kFrozen_samples) ++faults.imu_frozen;
  flight().set_imu_frozen(same >= kFrozen_samples);
  if (burst.rate_saturated()) {
    ++faults.imu_saturated;
    return flight().on_imu_missing();
  }
  const ImuReading r = burst.decode();
  flight().on_imu({mounted(r.acceleration_mps2, config::kImuMounting),
                   mounted(r.rate_radps, config::kImuMounting), r.temperature_degC});
  faults.imu_reconfigured = imu.reconfigured();
}

// A frame is ended by the gap after it: until then the one before stays whole.
static void read_sticks() {
  if (!sticks_came) return;
  const hal::InterruptLock lock;
  sticks_came = false;
  const CppmFrame frame = receiver.frame();
  flight().on_rc(frame);
}

__attribute__((noinline)) void attitude_task() {
  read_sticks();
  flight().attitude_step();
}

// What came since the last time goes to the filters, then the sensors are asked anew.
__attribute__((noinline)) void sensor_task() {
  BaroSample pressure;
  MagSample field;
  barometer.step();
  magnetometer.step();
  if (barometer.take(pressure)) flight().on_pressure(pressure.pressure_Pa);
  if (magnetometer.take(field)) flight().on_field(mounted(field.field_uT, config::kMagMounting));
  faults.baro_failures = barometer.failures();
  faults.mag_failures = magnetometer.failures();
  faults.sensor_reconfigured = barometer.restarts() + magnetometer.reconfigured();
}

__attribute__((noinline)) void position_task() {
  flight().position_step();
}

__attribute__((noinline)) void esc_task(std::uint32_t tick) {
  for (unsigned motor = 0; motor < 4; ++motor) {
    if (escs.take_answered(motor)) flight().on_esc_answered(motor);
    esc::protocol::Status status;
    if (escs.take_status(motor, status)) flight().on_esc_status(motor, status);
  }
  if (schedule::setpoints(tick)) std::ignore = escs.write(flight().send_setpoints());
  const int motor = schedule::status_read(tick);
  if (motor >= 0) std::ignore = escs.request_status(static_cast<unsigned>(motor));
  faults.esc_no_answer = escs.failures();
  faults.esc_bad_status = escs.bad_status();
  faults.i2c_recoveries = hal::i2c3.counters().recoveries;
  faults.i2c_timeouts = hal::i2c3.counters().timeouts;
}

// By the crystal: ticks come from the IMU's oscillator, which may be a percent off.
static std::uint32_t uptime_ms() {
  static constinit std::uint32_t ms = 0, counted_us = 0;
  const std::uint32_t passed_ms = (hal::now_us() - counted_us) / 1000u;
  ms += passed_ms;
  counted_us += passed_ms * 1000u;
  return ms;
}

__attribute__((noinline)) void telemetry_task() {
  std::array<std::uint8_t, 64> bytes;
  const std::size_t n = hal::radio.read(bytes);
  telemetry().receive({bytes.data(), n});
  faults.link_bad_frames = telemetry().bad_frames();
  const std::span<const std::uint8_t> frame = telemetry().next(uptime_ms(), faults, health);
  if (!frame.empty() && hal::radio.send(frame) != Status::ok) ++faults.link_overruns;
}

// The core stalls for each word of flash: never while the motors may turn.
__attribute__((noinline)) void store_task() {
  if (flight().state() == FlightState::disarmed) store.step(flight().parameters());
  health.parameters_unsaved = store.gave_up(flight().parameters());
}

namespace {

// Runs what is due in this tick. The attitude task comes before the set-points that use it.
std::uint8_t run_tick(std::uint32_t tick) {
  std::uint8_t ran = kImu;
  imu_task();
  if (schedule::attitude(tick)) {
    attitude_task();
    ran |= kAttitude;
  }
  if (schedule::setpoints(tick) || schedule::status_read(tick) >= 0) {
    esc_task(tick);
    ran |= kEsc;
  }
  if (schedule::position(tick)) {
    position_task();
    ran |= kPosition;
  }
  if (schedule::sensors(tick)) {
    sensor_task();
    ran |= kSensors;
  }
  if (schedule::telemetry(tick)) {
    telemetry_task();
    ran |= kTelemetry;
  }
  store_task();
  return ran;
}

// Sleeps until a tick is due; returns the time slept.
std::uint32_t wait_for_tick() {
  const std::uint32_t from_us = hal::now_us();
  for (;;) {
    const hal::InterruptLock lock;
    if (ticks_due > 0) {
      if (ticks_due > 1) ++faults.deadline_missed;
      ticks_due = 0;
      return hal::now_us() - from_us;
    }
    hal::wait_for_interrupt();
  }
}

void show_state() {
  hal::LedBlue::set(flight().state() == FlightState::disarmed);
  hal::LedAmber::set(!flight().emergency() && flight().state() != FlightState::failsafe);
}

[[noreturn]] void run() {
  std::uint8_t ran = 0;
  std::uint32_t slept_us = 0;
  for (std::uint32_t tick = 0;; ++tick) {
    slept_us += wait_for_tick();
    ran |= run_tick(tick);
    if (ran == kAll) {
      hal::feed_watchdog();
      ran = 0;
    }
    if (tick % 1000 == 999) {
      health.load_permille =
          static_cast<std::uint16_t>(1000u - std::min<std::uint32_t>(slept_us / 1000u, 1000u));
      slept_us = 0;
      show_state();
    }
  }
}

const char* boot_text() {
  const hal::ResetCause cause = hal::take_reset_cause();
  if (fw_fault_record.magic == FaultRecord::kMagic) {
    fw_fault_record.magic = ~FaultRecord::kMagic;  // told once; the registers stay
    return "boot after a fault, see fw_fault_record";
  }
  switch (cause) {
    case hal::ResetCause::power:
      return "boot: power";
    case hal::ResetCause::pin:
      return "boot: reset pin";
    case hal::ResetCause::software:
      return "boot: software reset";
    case hal::ResetCause::watchdog:
      return "boot: watchdog";
    case hal::ResetCause::low_power:
      return "boot: low-power reset";
  }
  return "boot";
}

void start_leds() {
  hal::LedAmber::output(false, true);
  hal::LedBlue::output(false, true);
}

// Without the crystal no baud rate and no period is right. The ESCs never see a set-point, so the
// motors never arm; the amber LED says that something is wrong.
[[noreturn]] void stay_on_ground() {
  hw::RCC::AHB1ENR::set(hw::RCC::GPIOBEN);
  hal::LedAmber::output(false, false);
  for (;;) hal::wait_for_interrupt();
}

}  // namespace

}  // namespace fw

extern "C" void fw_main() {
  using namespace fw;
  health.boot_text = boot_text();
  if (hal::start_clocks() != Status::ok) stay_on_ground();
  store.load(flight().parameters());  // may erase: before the watchdog and the ticks
  hal::start_time_base();
  hal::spi1.init();  // switches on the clocks of all ports in use
  start_leds();
  hal::i2c3.init();
  hal::i2c2.init();
  hal::radio.init();
  hal::start_edge_capture();
  hal::start_watchdog();
  run();
}
