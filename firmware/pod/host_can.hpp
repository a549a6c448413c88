// The link to the host over CAN2 (PB12, PB13) at 1 Mbit/s: the frames of the UART's link as DroneCAN messages.
//
//   In       whirl.PodSample (20110), three frames: sequence, and a sample of host_frame.hpp.
//            whirl.PodFrame (20111): kind, sequence, payload, of any other kind.
//            whirl.Imu14, whirl.Imu16, which the host's IMU tells a flight controller on CAN, as a sample: their
//            steps of 16 g and 2000 deg/s come as counts of the range that the part is set to
//   Out      whirl.PodSetpoint (20112), one frame: sequence, ESC, valid, value. whirl.PodFrame: the rest
//   Host     the node that spoke first; another one after a second of its silence
//   Quiet    nothing goes out before a host has spoken; then NodeStatus each second, and who asks is answered
//   Time     of the IMU's message in steps of 10 us: so even is its data-ready
//   Error    a gyro step of Imu16 is taken as a count: 0.1 % less than the part's own scale factor (16.4 a deg/s)
#pragma once
#include <cstdint>

#include "firmware/dronecan/node.hpp"
#include "firmware/hal/can_link.hpp"
#include "firmware/pod/can_sample.hpp"
#include "firmware/pod/host_frame.hpp"

namespace fw::pod {

inline constexpr dronecan::Type kPodSample{20110, 0xA6E196084285CE00},
    kPodFrame{20111, 0x9EE88C79F3C2B090}, kPodSetpoint{20112, 0x5FF3AE2E7F29F206};

class HostCan {
 public:
  struct NoParameters;

  void start();
  // True: `out` is whole. Of what came, one after the other.
  bool read(Frame& out, std::uint32_t now_us);
  bool send(FrameWriter& frame);
  void poll(std::uint32_t now_us);
  std::uint32_t damaged() const {
    return sample_.spoiled() + frame_.spoiled() + imu_.spoiled() + hal::can2.counters().lost;
  }

 private:
  bool on_frame(const hal::CanFrame& frame, Frame& out);
  bool is_host(const hal::CanFrame& frame, std::uint32_t now_us);
  void from_imu(unsigned bits, Frame& out);

  dronecan::Reassembly<17> sample_;
  dronecan::Reassembly<2 + kMostPayload> frame_;
  dronecan::Reassembly<14> imu_;
  StampCounter stamps_;
  bool heard_ = false;
  std::uint8_t host_ = 0;
  std::uint32_t heard_us_ = 0, status_due_us_ = 0, uptime_s_ = 0;
  std::uint8_t setpoint_transfer_ = 0, frame_transfer_ = 0;
  std::int16_t temperature_ = 0;  // of the newest sample that told one
};

extern HostCan host_can;

}  // namespace fw::pod
