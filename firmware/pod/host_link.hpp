// The host's frames, and the status that goes back: each 10 ms over the UART, each 30 ms over CAN: its flags
// are of the newest 32 samples, so that each is told of.
//
//   Ways     UART and CAN are heard alike; what the pod tells goes where the host spoke last
//   Read     from the main loop, more often than the UART's ring of 256 bytes wraps (0.85 ms)
//   Status   0x81, 56 bytes: PWR_MGMT_1, CONFIG, SMPLRT_DIV, GYRO_CONFIG, ACCEL_CONFIG, INT_ENABLE,
//            INT_PIN_CFG, USER_CTRL; number of the newest sample, of the newest oddity, samples overdue
//            (0, 1), a zero; then as u32 the samples' flags (bit 0: the newest; lost or late), as u16
//            samples lost, late, damaged frames, oddities, overlaps, late re-arms, and as u32 transfers,
//            bursts, samples taken, the longest turn of the main loop in us, the pod's time in us, as u16 pieces
//            of the GPS and frames of the pod's own for which there was no room, the longest wait of a sample for
//            its time in the last whole second, us, and pieces of the radio for which there was no room
#pragma once
#include <cstdint>
#include <span>

#include "firmware/pod/host_frame.hpp"
#include "firmware/pod/sample_clock.hpp"
#include "firmware/pod/sample_watch.hpp"

namespace fw::pod {

class HostLink {
 public:
  void start();
  void poll(std::uint32_t now_us);

 private:
  void on_frame(const Frame& frame, std::uint32_t now_us);
  void on_slow_frame(const Frame& frame);
  static void on_output(const Frame& frame, std::uint32_t now_us);
  void send(FrameWriter& frame);
  void send_written(FrameKind kind, std::uint8_t& number, std::span<const std::uint8_t> bytes,
                    std::uint32_t now_us);
  void send_setpoints();
  void send_status(std::uint32_t now_us);

  FrameReader reader_;
  SampleClock clock_;
  SampleWatch watch_;
  std::uint32_t status_due_us_ = 0, turned_us_ = 0, longest_turn_us_ = 0;
  std::uint8_t status_number_ = 0, setpoint_number_ = 0, gps_number_ = 0, radio_number_ = 0;
  std::uint32_t unsent_ = 0;
  bool over_can_ = false;
};

extern HostLink host_link;

}  // namespace fw::pod
