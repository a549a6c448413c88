// A host's end of the link to a pod, over the pod's UART at 3 Mbaud or its CAN at 1 Mbit/s.
//
//   Jitter   a sample leaves up to params.jitter late, evenly distributed, in its turn: what an adapter on USB and a
//            busy host make of it
#pragma once
#include <deque>
#include <optional>
#include <vector>

#include "base/random.hpp"
#include "io_bridges/board_description/pod_host.hpp"
#include "io_bridges/devices/dronecan_node.hpp"
#include "io_bridges/devices/uart_transmitter.hpp"
#include "io_bridges/protocols/dronecan/pod_link.hpp"
#include "io_bridges/rack/device_type.hpp"

namespace whirl::rack {

std::vector<DeviceKey> pod_link_keys();  // params.can, .sample, .jitter

using PodFigures = std::vector<std::pair<std::string, std::int64_t>>;
PodFigures figures_of(const io::PodStatus& status);  // pod_lost, pod_late, ...

class PodHostLink final : io::UartPeer {
 public:
  // What the pod tells goes to `reader`, which must live as long.
  PodHostLink(DeviceSlot& slot, io::PodLinkReader& reader);

  bool over_can() const { return node_.has_value(); }
  static std::uint16_t uart() { return kPodHostUart; }  // of the link; its messages ask for figures
  void send(const std::vector<std::uint8_t>& frame);    // as pod_link.hpp packs it
  // As Imu14 or Imu16 for a part that is set to 16 g and 2000 deg/s: the temperature is lost.
  void send_sample(std::uint8_t number, const std::array<std::int16_t, 7>& counts);

  // Who judges asks for a figure by its name, a line on uart(), and is answered there.
  static std::string asked(const io::Reader& message);
  void tell(const std::string& name, std::int64_t value);
  // False: it is none of them, and nothing was told.
  bool tell(const std::string& name, const PodFigures& figures);

 private:
  void receive(const io::UartByte& byte, const io::UartFormat&, Nanoseconds) override {
    reader_.add(byte.value);
  }

  struct Sample {
    Nanoseconds at_ns = 0, leaves_ns = 0;
    std::uint8_t number = 0;
    std::array<std::int16_t, 7> counts{};
  };
  void send_held();
  void send_now(const Sample& sample);
  template <typename Imu>
  void send_imu(const Sample& sample);

  io::EventQueue& queue_;
  io::Batch& happened_;
  io::PodLinkReader& reader_;
  enum class Form : std::uint8_t { counts, imu14, imu16 } form_ = Form::counts;
  Nanoseconds jitter_ns_;
  RandomStream chance_;
  std::deque<Sample> held_;
  io::Event leaves_;
  io::UartTransmitter line_;
  std::optional<io::DroneCanNode> node_;
};

}  // namespace whirl::rack
