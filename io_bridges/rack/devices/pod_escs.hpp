// The four ESCs that a pod plays, as its host has them: what each was told goes to the harness, its state to the pod.
//
//   Told    esc_setpoint of motor 1 to 4 (0x29 to 0x2C), when the pod's word of it has come: some 0.1 ms after the STOP.
//           start_ns is that time too, for the pod does not say when the write began
//   State   each 20 ms, one ESC after the other; none before the harness has told of it
#pragma once
#include <array>
#include <functional>
#include <vector>

#include "io_bridges/protocols/dronecan/pod_link.hpp"
#include "io_bridges/rack/device_type.hpp"

namespace whirl::rack {

class PodEscs {
 public:
  static constexpr std::uint16_t kEscs = 4;
  using Sink = std::function<void(std::vector<std::uint8_t> frame)>;  // as pod_link.hpp packs it

  PodEscs(Rack& rack, Sink to_pod);

  static std::vector<Intake> intakes();
  void on_message(const io::Reader& message);  // pre: esc_state, of one of intakes()
  void told(const io::PodSetpoint& setpoint);
  std::uint64_t setpoints() const { return setpoints_; }
  std::uint64_t refused() const { return refused_; }  // of these, that were no valid write

 private:
  void tell_next();

  Rack& rack_;
  Sink to_pod_;
  std::array<std::optional<io::EscState>, kEscs> states_;
  std::size_t next_ = 0;
  std::uint8_t number_ = 0;
  std::uint64_t setpoints_ = 0, refused_ = 0;
  io::Event due_;
};

}  // namespace whirl::rack
