#include "io_bridges/rack/devices/pod_line_end.hpp"

#include <cmath>
#include <utility>

namespace whirl::rack {
namespace {

std::uint32_t whole(double baud) {
  return static_cast<std::uint32_t>(std::lround(baud));
}

}  // namespace

PodLineEnd::PodLineEnd(io::EventQueue& queue, io::PodEnd line, io::UartPeer& device,
                       std::function<double()> baud, io::PodLinkReader& reader, Ears ears,
                       Nanoseconds gather_ns)
    : queue_(queue),
      line_(line),
      device_(device),
      baud_(std::move(baud)),
      ears_(std::move(ears)),
      gather_ns_(gather_ns),
      gather_(queue_, [this] { flush(); }),
      rate_(whole(baud_())) {
  reader.on_written(line_, [this](const io::PodWritten& w) { written(w); });
  device_.join([this](const io::UartByte& byte, const io::UartFormat& format) {
    said(byte.value, format.baud);
  });
}

void PodLineEnd::tell_rate() {
  ears_.send(io::pack_pod_baud(line_, number_++, rate_));
}

void PodLineEnd::said(std::uint8_t byte, double baud) {
  follow(baud);
  if (ears_.byte) ears_.byte(byte, baud);
  if (gather_ns_ != 0 && !gather_.pending()) gather_.in(gather_ns_);
  bytes_.push_back(byte);
  if (bytes_.size() == io::kPodLineBytes) flush();
}

void PodLineEnd::flush() {
  if (bytes_.empty()) return;
  ears_.send(io::pack_pod_bytes(line_, number_++, 0, bytes_));
  bytes_.clear();
}

// At the rate that the pod's line has: the device's.
void PodLineEnd::written(const io::PodWritten& written) {
  for (const std::uint8_t byte : written.bytes) {
    device_.receive({.value = byte}, {.baud = baud_()}, queue_.now());
  }
  follow(baud_());
}

void PodLineEnd::follow(double baud) {
  if (whole(baud) == rate_) return;
  flush();
  rate_ = whole(baud);
  tell_rate();
  if (ears_.rate) ears_.rate(baud);
}

}  // namespace whirl::rack
