// The flight image: boots, brings up its buses and runs its tasks, one tick per IMU sample.
#include "firmware/drivers/mpu6000.hpp"
#include "firmware/hal/clock.hpp"
#include "firmware/hal/i2c_master.hpp"
#include "firmware/hal/interrupts.hpp"
#include "firmware/hal/pins.hpp"
#include "firmware/hal/spi_master.hpp"
#include "firmware/hal/time_base.hpp"
#include "firmware/hal/uart_link.hpp"
#include "firmware/hal/watchdog.hpp"

namespace fw {

constinit Mpu6000<hal::SpiMaster> imu(hal::spi1);
constinit Faults faults;
constinit ImuReading reading{};

namespace {
volatile bool tick_due = false;
}

void imu_data_ready() {
  if (!imu.data_ready(hal::now_us())) tick_due = true;
}
void imu_transfer_done() {
  if (imu.transfer_done()) tick_due = true;
}
void fallback_tick() {
  if (imu.running()) ++faults.imu_samples_lost;
  tick_due = true;
}
void i2c_job_done(const hal::I2cJob&, Status status) {
  if (status != Status::ok) ++faults.esc_no_answer;
}

__attribute__((noinline)) void imu_task() {
  if (!imu.running()) std::ignore = imu.setup_tick();
  reading = imu.burst().decode();
}

namespace {
void wait_for_tick() {
  for (;;) {
    const hal::InterruptLock lock;
    if (tick_due) {
      tick_due = false;
      return;
    }
    hal::wait_for_interrupt();
  }
}
}  // namespace

}  // namespace fw

extern "C" void fw_main() {
  using namespace fw;
  std::ignore = hal::start_clocks();
  hal::start_time_base();
  hal::spi1.init();
  hal::i2c3.init();
  hal::radio.init();
  hal::start_watchdog();
  for (;;) {
    wait_for_tick();
    imu_task();
    hal::feed_watchdog();
  }
}
