// The flight image: boots, brings up its buses and runs its tasks, one tick per IMU sample.
//
//   Tick    the end of the IMU's burst, 1 kHz, or the last frame of its message where the sensors are nodes
//           on CAN (SENS_BUS); a hardware timer when the IMU stays away
//   Tasks   run to completion, one after the other, in the order of schedule.hpp; between ticks the
//           core sleeps. Interrupts only move bytes
//   Watch   the watchdog is fed when each task has run since the last time
#include <tuple>

#include "firmware/config/parameter_store.hpp"
#include "firmware/config/vehicle.hpp"
#include "firmware/drivers/hmc5883l.hpp"
#include "firmware/drivers/mpu6000.hpp"
#include "firmware/drivers/ms5611.hpp"
#include "firmware/drivers/sd_card.hpp"
#include "firmware/drivers/ublox_gps.hpp"
#include "firmware/flight/flight.hpp"
#include "firmware/flight/schedule.hpp"
#include "firmware/hal/battery_adc.hpp"
#include "firmware/hal/clock.hpp"
#include "firmware/hal/fault_record.hpp"
#include "firmware/hal/flash.hpp"
#include "firmware/hal/i2c_master.hpp"
#include "firmware/hal/interrupts.hpp"
#include "firmware/hal/pins.hpp"
#include "firmware/hal/spi_master.hpp"
#include "firmware/hal/time_base.hpp"
#include "firmware/hal/uart_link.hpp"
#include "firmware/hal/watchdog.hpp"
#include "firmware/images/boot_text.hpp"
#include "firmware/images/flight_can.hpp"
#include "firmware/images/flight_escs.hpp"
#include "firmware/images/flight_sticks.hpp"
#include "firmware/images/gps_solution.hpp"
#include "firmware/images/imu_checks.hpp"
#include "firmware/link/telemetry.hpp"
#include "firmware/log/flight_log.hpp"

namespace fw {

constinit Faults faults;
constinit Health health;

namespace {

constinit Mpu6000<hal::ImuLink> imu(hal::imu_link);
constinit Ms5611<hal::I2cMaster<hal::SensorI2c>> barometer(hal::i2c2);
constinit Hmc5883l<hal::I2cMaster<hal::SensorI2c>> magnetometer(hal::i2c2);
constinit UbloxGps<hal::UartLink<hal::GpsUart>> gps(hal::gps_uart);
constinit ParameterStore<hal::ParameterSectors> store(hal::parameter_sectors);
using Card = SdCard<hal::SpiMaster<hal::CardBus>>;
constinit Card card(hal::spi3);
// 16 MiB hold ten minutes, more than a battery does; what is not used is given back.
constinit std::array<std::uint8_t, 16384> log_ring{};
constinit LogVolume<Card> volume(card, log_ring,
                                 {.file_bytes = 16u << 20, .least_bytes = 1u << 20});
volatile std::uint32_t ticks_due = 0;
volatile bool sample_ready = false;
volatile bool sensors_on_can = false;
volatile std::uint32_t data_ready_us = 0;
constinit TickTimes times;  // the worst since they were logged

enum Ran : std::uint8_t {
  kImu = 1,
  kAttitude = 2,
  kPosition = 4,
  kEsc = 8,
  kTelemetry = 16,
  kSensors = 32,
  kLog = 64,
  kGps = 128,
  kAll = 255
};

Flight& flight() {  // built at the first call: Eigen's vectors have no constant initialisers
  static Flight instance;
  return instance;
}

Telemetry& telemetry() {
  static Telemetry instance(flight());
  return instance;
}

FlightLog<LogVolume<Card>>& flight_log() {
  static FlightLog<LogVolume<Card>> instance(volume, flight());
  return instance;
}

}  // namespace

void imu_data_ready() {
  if (sensors_on_can) return;
  hal::restart_tick_guard();
  const std::uint32_t now_us = hal::now_us();
  data_ready_us = now_us;
  if (!imu.data_ready(now_us)) ticks_due = ticks_due + 1;
}

void imu_transfer_done() {
  if (!imu.transfer_done()) return;
  sample_ready = true;
  ticks_due = ticks_due + 1;
}

// A node that sends twice as often shall not make time run twice as fast.
void can_frame_came(const hal::CanFrame& frame) {
  constexpr std::uint32_t kLeast_us = 500;
  if (!sensors_on_can || !can_sensors().is_imu_end(frame)) return;
  const std::uint32_t now_us = hal::now_us();
  if (now_us - data_ready_us < kLeast_us) return;
  hal::restart_tick_guard();
  data_ready_us = now_us;
  ticks_due = ticks_due + 1;
}

// On CAN the samples' own stamps tell which are lost.
void fallback_tick() {
  if (!sensors_on_can && imu.running()) ++faults.imu_samples_lost;
  ticks_due = ticks_due + 1;
}

void sensor_job_done(const hal::I2cJob& job, Status status) {
  if (job.address == barometer.kAddress) barometer.job_done(job, status);
  if (job.address == magnetometer.kAddress) magnetometer.job_done(job, status);
}

template <typename Raw>
static bool is_usable(const Raw& raw) {
  flight().set_imu_frozen(is_frozen(raw, faults));
  if (!raw.rate_saturated()) return true;
  ++faults.imu_saturated;
  flight().on_imu_missing();
  return false;
}

static void can_imu_task() {
  const CanSensors& sensors = can_sensors();
  faults.imu_samples_lost = sensors.imu_lost() + sensors.imu_bad();
  const std::optional<CanImuSample> sample = can_sensors().take_imu();
  if (!sample) return flight().on_imu_missing();
  if (!is_usable(*sample)) return;
  constexpr float kMps2_per_step = 16.0f * config::kGravity_mps2 / 32768.0f;
  constexpr float kRadps_per_step = 2000.0f / 32768.0f * 0.017453292520f;
  const auto vector = [](const std::array<std::int16_t, 3>& steps, float of_one) {
    return Vector3(of_one * steps[0], of_one * steps[1], of_one * steps[2]);
  };
  flight().on_imu({vector(sample->acceleration, kMps2_per_step),
                   vector(sample->rate, kRadps_per_step), sensors.temperature_degC()});
}

__attribute__((noinline)) void imu_task() {
  sensors_on_can = flight().parameters().is_on(Parameter::sensor_bus) && start_can(flight());
  if (sensors_on_can) return can_imu_task();
  std::ignore = imu.setup_tick();
  if (!sample_ready) return flight().on_imu_missing();
  sample_ready = false;
  const ImuBurst burst = imu.burst();
  if (!is_usable(burst)) return;
  const ImuReading r = burst.decode();
  flight().on_imu({mounted(r.acceleration_mps2, config::kImuMounting),
                   mounted(r.rate_radps, config::kImuMounting), r.temperature_degC});
  faults.imu_reconfigured = imu.reconfigured();
}

__attribute__((noinline)) void attitude_task() {
  read_sticks(flight());
  flight().attitude_step();
}

static void can_sensor_task() {
  CanSensors& sensors = can_sensors();
  if (const auto pressure_Pa = sensors.take_pressure_Pa()) flight().on_pressure(*pressure_Pa);
  if (const auto field_uT = sensors.take_field_uT()) {
    flight().on_field({(*field_uT)[0], (*field_uT)[1], (*field_uT)[2]});
  }
  if (const auto voltage_V = sensors.voltage_V(hal::now_us())) flight().on_battery(*voltage_V);
  faults.baro_failures = sensors.air_bad();
  faults.mag_failures = sensors.field_bad();
}

// What came since the last time goes to the filters, then the sensors are asked anew.
__attribute__((noinline)) void sensor_task() {
  if (sensors_on_can) return can_sensor_task();
  BaroSample pressure;
  MagSample field;
  barometer.step();
  magnetometer.step();
  if (barometer.take(pressure)) flight().on_pressure(pressure.pressure_Pa);
  if (magnetometer.take(field)) flight().on_field(mounted(field.field_uT, config::kMagMounting));
  if (const auto voltage_V = hal::battery_adc.next_V()) flight().on_battery(*voltage_V);
  faults.baro_failures = barometer.failures();
  faults.mag_failures = magnetometer.failures();
  faults.sensor_reconfigured = barometer.restarts() + magnetometer.reconfigured() + gps.restored();
}

static void can_gps_task() {
  if (const auto fix = can_sensors().take_fix()) flight().on_gps(solution_of(*fix));
  faults.gps_bad_frames = can_sensors().fix_bad();
}

__attribute__((noinline)) void gps_task() {
  if (sensors_on_can) return can_gps_task();
  std::array<std::uint8_t, 64> bytes;
  const std::uint32_t now_us = hal::now_us();
  const std::size_t n = hal::gps_uart.read(bytes);
  for (std::size_t i = 0; i < n; ++i) gps.push(bytes[i], now_us);
  gps.tick(now_us);
  GpsFix fix;
  if (gps.take(fix)) flight().on_gps(solution_of(fix));
  faults.gps_searches = gps.searches();
  faults.gps_bad_frames = gps.bad_frames();
}

__attribute__((noinline)) void position_task() {
  flight().position_step();
}

// By the crystal: ticks come from the IMU's oscillator, which may be a percent off.
static std::uint32_t uptime_ms() {
  static constinit std::uint32_t ms = 0, counted_us = 0;
  const std::uint32_t passed_ms = (hal::now_us() - counted_us) / 1000u;
  ms += passed_ms;
  counted_us += passed_ms * 1000u;
  return ms;
}

__attribute__((noinline)) void esc_task(std::uint32_t tick) {
  if (serve_escs(flight(), faults, tick)) {
    TickTimes::keep_worst(times.setpoint_us, hal::now_us() - data_ready_us);
  }
}

__attribute__((noinline)) void telemetry_task() {
  std::array<std::uint8_t, 64> bytes;
  const std::size_t n = hal::radio.read(bytes);
  telemetry().receive({bytes.data(), n});
  faults.link_bad_frames = telemetry().bad_frames();
  const std::span<const std::uint8_t> frame = telemetry().next(uptime_ms(), faults, health);
  if (!frame.empty() && hal::radio.send(frame) != Status::ok) ++faults.link_overruns;
}

// What the ground is told of the log; null: all is well.
static const char* log_trouble() {
  if (!card.ready()) return "log: no SD card";
  if (volume.state() == LogState::refused) return "log: no FAT32 volume, or no room on it";
  return flight_log().dropouts() > 0 ? "log: the SD card is too slow, samples are lost" : nullptr;
}

// The log first: what it appends can go to the card in the same tick.
__attribute__((noinline)) void log_task(std::uint32_t tick, std::uint32_t now_us) {
  flight_log().step(tick, now_us, health.load_permille, faults.deadline_missed, times);
  volume.tick(now_us);
  card.tick(now_us);
  health.log_trouble = log_trouble();
}

// The core stalls for each word of flash: never while the motors may turn.
__attribute__((noinline)) void store_task() {
  if (flight().state() == FlightState::disarmed && !flight().falling())
    store.step(flight().parameters());
  health.parameters_unsaved = store.gave_up(flight().parameters());
}

namespace {

// Runs what is due in this tick. The attitude task comes before the set-points that use it.
std::uint8_t run_tick(std::uint32_t tick, std::uint32_t now_us) {
  std::uint8_t ran = kImu;
  can_tick(flight(), tick, now_us, uptime_ms() / 1000u);
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
  if (schedule::gps(tick)) {
    gps_task();
    ran |= kGps;
  }
  if (schedule::telemetry(tick)) {
    telemetry_task();
    ran |= kTelemetry;
  }
  store_task();
  log_task(tick, now_us);
  return ran | kLog;
}

// Sleeps until a tick is due; returns when that was.
std::uint32_t wait_for_tick() {
  for (;;) {
    const hal::InterruptLock lock;
    if (ticks_due > 0) {
      if (ticks_due > 1) ++faults.deadline_missed;
      ticks_due = 0;
      return hal::now_us();
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
  std::uint32_t slept_us = 0, ended_us = hal::now_us();
  for (std::uint32_t tick = 0;; ++tick) {
    const std::uint32_t now_us = wait_for_tick();
    slept_us += now_us - ended_us;
    TickTimes::keep_worst(times.start_us, now_us - data_ready_us);
    ran |= run_tick(tick, now_us);
    ended_us = hal::now_us();
    TickTimes::keep_worst(times.tick_us, ended_us - now_us);
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
  hal::imu_link.init();  // switches on the clocks of all ports in use
  start_leds();
  hal::i2c3.init();
  hal::i2c2.init();
  hal::spi3.init();
  hal::battery_adc.init();
  hal::radio.init(57'600);
  hal::gps_uart.init(57'600);  // the driver searches from there
  start_sticks();
  hal::start_watchdog();
  run();
}
