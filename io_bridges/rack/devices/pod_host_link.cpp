#include "io_bridges/rack/devices/pod_host_link.hpp"

#include <algorithm>
#include <cmath>

#include "io_bridges/protocols/dronecan/imu_samples.hpp"
#include "io_bridges/protocols/dronecan/pod.hpp"

namespace whirl::rack {
namespace {

constexpr std::uint8_t kUrgent = 6, kUsual = 16, kHostNode = 100;

}  // namespace

std::vector<DeviceKey> pod_link_keys() {
  DeviceKey can = quantity_key("params.can", Dimension::none, "", {0.0, 2.0},
                               "the host's link in the place of its line; 0: none");
  can.kind = KeyKind::whole;
  return {can.with(0.0),
          word_key("params.sample", "counts or imu14 or imu16",
                   "how a sample is told; the last two over CAN only")
              .with(std::string("counts")),
          quantity_key("params.jitter", Dimension::time, "s", {0.0, 0.005},
                       "a sample leaves up to so much late, at random, in its turn")
              .with(0.0)};
}

PodFigures figures_of(const io::PodStatus& status) {
  return {{"pod_lost", status.lost},
          {"pod_late", status.late},
          {"pod_damaged", status.damaged},
          {"pod_oddities", status.oddities},
          {"pod_overlaps", status.overlaps},
          {"pod_late_rearm", status.late_rearm},
          {"pod_transfers", status.transfers},
          {"pod_samples", status.samples},
          {"pod_unsent", status.unsent},
          {"pod_wait_us", status.wait_us},
          {"pod_gps_dropped", status.gps_dropped},
          {"pod_radio_dropped", status.radio_dropped},
          {"pod_turn_us", status.longest_turn_us},
          {"pod_now_us", status.now_us}};
}

PodHostLink::PodHostLink(DeviceSlot& slot, io::PodLinkReader& reader)
    : queue_(slot.rack().events()),
      happened_(slot.rack().happened()),
      reader_(reader),
      jitter_ns_(std::llround(slot.quantity("params.jitter") * 1e9)),
      chance_(slot.rack().seed(), slot.name() + ".jitter"),
      leaves_(queue_, [this] { send_held(); }),
      line_(queue_, {.baud = io::kPodBaud},
            [this](const io::UartByte& byte, const io::UartFormat& format) {
              UartPeer::send(byte, format);
            }) {
  const std::uint16_t can = slot.whole("params.can");
  io::CanBus* bus = can == 0 ? nullptr : slot.rack().can(can);
  if (bus == nullptr) {
    std::ignore = slot.rack().join_uart(kPodHostUart, *this);
    return;
  }
  const std::string sample = slot.text("params.sample");
  if (sample == "imu14") form_ = Form::imu14;
  if (sample == "imu16") form_ = Form::imu16;
  node_.emplace(queue_, *bus,
                io::DroneCanNode::Setup{.name = slot.name(),
                                        .info = "org.whirlstand.pod_host",
                                        .number = slot.number(),
                                        .node_id = kHostNode});
  namespace dc = io::dronecan;
  node_->on<dc::PodFrame>(
      [this](const dc::PodFrame& m, Nanoseconds, Nanoseconds) { reader_.add(m); });
  node_->on<dc::PodSetpoint>(
      [this](const dc::PodSetpoint& m, Nanoseconds, Nanoseconds) { reader_.add(m); });
}

void PodHostLink::send(const std::vector<std::uint8_t>& frame) {
  if (!over_can()) return line_.add(frame);
  node_->send(io::pod_message(frame), kUsual);
}

void PodHostLink::send_sample(std::uint8_t number, const std::array<std::int16_t, 7>& counts) {
  const Nanoseconds now = queue_.now();
  if (jitter_ns_ == 0) return send_now({now, now, number, counts});
  const Nanoseconds held_ns = std::llround(chance_.uniform() * static_cast<double>(jitter_ns_));
  const Nanoseconds before_ns = held_.empty() ? 0 : held_.back().leaves_ns;
  held_.push_back({now, std::max<Nanoseconds>(before_ns, now + held_ns), number, counts});
  if (!leaves_.pending()) leaves_.at(held_.front().leaves_ns);
}

void PodHostLink::send_held() {
  send_now(held_.front());
  held_.pop_front();
  if (!held_.empty()) leaves_.at(held_.front().leaves_ns);
}

void PodHostLink::send_now(const Sample& sample) {
  const auto time_us = static_cast<std::uint16_t>(sample.at_ns / 1000);
  if (!over_can()) return line_.add(io::pack_pod_sample(sample.number, time_us, sample.counts));
  if (form_ == Form::imu14) return send_imu<io::dronecan::Imu14>(sample);
  if (form_ == Form::imu16) return send_imu<io::dronecan::Imu16>(sample);
  node_->send(io::dronecan::PodSample{sample.number, time_us, sample.counts}, kUrgent);
}

std::string PodHostLink::asked(const io::Reader& message) {
  std::string line(message.payload().begin(), message.payload().end());
  line.erase(line.find_last_not_of("\r\n") + 1);
  return line;
}

void PodHostLink::tell(const std::string& name, std::int64_t value) {
  const std::string line = name + " " + std::to_string(value) + "\n";
  happened_.add(io::Kind::uart_received, kPodHostUart, queue_.now(), line.data(),
                static_cast<std::uint32_t>(line.size()));
}

bool PodHostLink::tell(const std::string& name, const PodFigures& figures) {
  for (const auto& [known, value] : figures) {
    if (known != name) continue;
    tell(name, value);
    return true;
  }
  return false;
}

template <typename Imu>
void PodHostLink::send_imu(const Sample& sample) {
  constexpr int kCoarser = std::is_same_v<Imu, io::dronecan::Imu14> ? 4 : 1;
  Imu imu;
  for (unsigned i = 0; i < 3; ++i) {
    imu.rate[i] = static_cast<std::int16_t>(sample.counts[4 + i] / kCoarser);
    imu.acceleration[i] = static_cast<std::int16_t>(sample.counts[i] / kCoarser);
  }
  imu.time = static_cast<std::uint16_t>(sample.at_ns / Imu::kTime_step_ns);
  node_->send(imu, kUrgent);
}

}  // namespace whirl::rack
