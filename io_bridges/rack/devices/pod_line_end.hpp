// A device on a serial line behind a pod's host: what it says the pod says on its line, at the device's rate; what the pod
// hears there comes to it.
#pragma once
#include <functional>
#include <vector>

#include "io_bridges/devices/bus.hpp"
#include "io_bridges/rack/devices/pod_host_link.hpp"

namespace whirl::rack {

class PodLineEnd {
 public:
  // What a line whose bytes may go together waits for.
  static constexpr Nanoseconds kGather_ns = 1'000'000;

  // What is for the pod goes to `send`, packed; each byte and each change of its rate are told besides.
  struct Ears {
    std::function<void(const std::vector<std::uint8_t>&)> send;
    std::function<void(std::uint8_t byte, double baud)> byte = nullptr;
    std::function<void(double baud)> rate = nullptr;
  };
  // baud: the device's own, now. Both must live as long. gather_ns: what it says goes that long after its first byte, as a
  // host does, or once a piece is full; 0: or when flush() says so.
  PodLineEnd(io::EventQueue& queue, io::PodEnd line, io::UartPeer& device,
             std::function<double()> baud, io::PodLinkReader& reader, Ears ears,
             Nanoseconds gather_ns = 0);

  void tell_rate();
  void flush();

 private:
  void said(std::uint8_t byte, double baud);
  void written(const io::PodWritten& written);
  void follow(double baud);

  io::EventQueue& queue_;
  io::PodEnd line_;
  io::UartPeer& device_;
  std::function<double()> baud_;
  Ears ears_;
  Nanoseconds gather_ns_;
  io::Event gather_;
  std::uint8_t number_ = 0;
  std::uint32_t rate_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace whirl::rack
