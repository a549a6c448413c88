// The pod: a second STM32F405 that plays an MPU-6000 on SPI, an MS5611, an HMC5883L and four ESCs on I2C, a GPS,
// a radio-control receiver, a telemetry radio and the battery's level to a flight controller, by what the host says.
#include "firmware/hal/clock.hpp"
#include "firmware/pod/battery_out.hpp"
#include "firmware/pod/escs.hpp"
#include "firmware/pod/host_link.hpp"
#include "firmware/pod/imu.hpp"
#include "firmware/pod/played_line.hpp"
#include "firmware/pod/pod_time.hpp"
#include "firmware/pod/ram_vectors.hpp"
#include "firmware/pod/receiver_out.hpp"
#include "firmware/pod/sensors.hpp"

namespace fw::pod {

[[gnu::noinline]] void host_task() {
  host_link.poll(now_us());
}

}  // namespace fw::pod

extern "C" void fw_main() {
  using namespace fw;
  if (hal::start_clocks() != Status::ok) return;  // at 16 MHz no answer would be in time
  pod::move_vectors_to_ram();
  pod::start_time();
  pod::host_link.start();
  pod::start_sensors();
  pod::start_escs();
  pod::gps_out.start();
  pod::radio_out.start();
  pod::battery_out.start();
  pod::sbus_out.start();
  pod::cppm_out.start();
  pod::imu.start();
  for (;;) {
    pod::host_task();
    pod::imu.poll();
    pod::barometer.poll();
    pod::magnetometer.poll();
    pod::gps_out.poll(pod::now_us());
    pod::radio_out.poll(pod::now_us());
    pod::sbus_out.poll(pod::now_us());
  }
}
