#include "io_bridges/rack/devices/pod_gps.hpp"

#include <cmath>
#include <utility>

namespace whirl::rack {
namespace {

std::uint32_t whole(double baud) {
  return static_cast<std::uint32_t>(std::lround(baud));
}

}  // namespace

PodGps::PodGps(io::EventQueue& queue, io::Ublox& receiver, io::PodLinkReader& reader, Ears ears)
    : queue_(queue), receiver_(receiver), ears_(std::move(ears)), rate_(whole(receiver.baud())) {
  reader.on_gps_written([this](const io::PodGpsWritten& w) { written(w); });
  receiver_.join([this](const io::UartByte& byte, const io::UartFormat& format) {
    said(byte.value, format.baud);
  });
}

void PodGps::tell_rate() {
  ears_.send(io::pack_pod_gps_baud(number_++, rate_));
}

void PodGps::said(std::uint8_t byte, double baud) {
  follow(baud);
  if (ears_.byte) ears_.byte(byte, baud);
  bytes_.push_back(byte);
  if (bytes_.size() == io::kPodGpsBytes) flush();
}

void PodGps::flush() {
  if (bytes_.empty()) return;
  ears_.send(io::pack_pod_gps(number_++, 0, bytes_));
  bytes_.clear();
}

// At the rate that the pod's line has: the receiver's.
void PodGps::written(const io::PodGpsWritten& written) {
  for (const std::uint8_t byte : written.bytes) {
    receiver_.receive({.value = byte}, {.baud = receiver_.baud()}, queue_.now());
  }
  follow(receiver_.baud());
}

void PodGps::follow(double baud) {
  if (whole(baud) == rate_) return;
  flush();
  rate_ = whole(baud);
  tell_rate();
  if (ears_.rate) ears_.rate(baud);
}

}  // namespace whirl::rack
