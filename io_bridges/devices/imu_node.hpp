// A DroneCAN node with an MPU-6000: its program sets the part up and sends each sample on CAN.
//
//   Part     register by register, on an SPI of the node's own, with its faults (mpu6000.hpp)
//   Settings +-2000 deg/s, +-16 g, 188 Hz low-pass, 1 kHz by the part's own clock
//   Sends    as `form` says. Whirl's own: whirl.Imu14 or Imu16 in the body's axes once the burst of 15 bytes is over, behind nothing but
//            set-points (priority 5)
//            uavcan's: ahrs.RawIMU with every n-th sample, the integrals of all n over the time between two data-readies, and
//            no time, which the protocol wants of a clock that the network shares
//   Stamp    data-ready, by the node's clock, which is taken as exact
//   Silence  50 ms without a sample: the part is set up anew, for one that has lost its supply sleeps
//   Left out the program's own run time, the thermometer
#pragma once
#include "io_bridges/devices/dronecan_node.hpp"
#include "io_bridges/devices/mpu6000.hpp"

namespace whirl::io {

class ImuNode {
 public:
  using Triple = std::array<double, 3>;
  struct Setup {
    DroneCanNode::Setup node;
    Mpu6000::Params part;
    enum class Form { imu14, imu16, raw } form = Form::imu14;
    int every = 1;  // of raw: one of so many samples is sent
    std::function<Triple(const Triple&)> to_body;
    std::function<void(Nanoseconds)> on_ready;  // may be null
  };
  ImuNode(EventQueue& queue, CanBus& bus, const Setup& setup, Mpu6000::Sense sense,
          FaultBook* faults, FindingSink findings);

 private:
  void set_up();
  void write(std::uint8_t address, std::uint8_t value);
  void read_burst();
  void add_raw(const Triple& acceleration_mps2, const Triple& rate_radps);
  template <typename Message>
  void publish(const Triple& acceleration_mps2, const Triple& rate_radps);

  EventQueue& queue_;
  Setup setup_;
  DroneCanNode node_;
  Wire interrupt_{"int", false};
  Mpu6000 part_;
  Nanoseconds ready_ns_ = 0, added_ns_ = -1;  // the last sample, and that in the integrals
  Nanoseconds integrated_ns_ = 0;
  int added_ = 0;
  Triple velocity_mps_{}, angle_rad_{};  // integrals since the last message
  bool heard_ = false;                   // since the last look
  Event burst_over_, look_;
};

}  // namespace whirl::io
