#include "io_bridges/devices/dronecan_node.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::io {
namespace {

constexpr std::size_t kMost_waiting = 64;
constexpr std::uint8_t kStatusPriority = 24;  // low
constexpr Nanoseconds kStatusPeriod_ns = 1'000'000'000, kPhase_ns = 7'000'000;

}  // namespace

DroneCanNode::DroneCanNode(EventQueue& queue, CanBus& bus, Setup setup)
    : queue_(queue),
      bus_(bus),
      setup_(std::move(setup)),
      station_(bus.join(*this, setup_.name, setup_.number)),
      status_due_(queue, [this] { publish_status(); }),
      assembler_(
          [this](dronecan::Kind kind, std::uint16_t id) -> const dronecan::DataType* {
            for (const dronecan::DataType* type : types_) {
              if (type->kind == kind && type->id == id) return type;
            }
            return nullptr;
          },
          setup_.node_id) {
  bus_.configure(station_, 1e9 / setup_.rate_Hz);
  bus_.connect(station_, 1);
  status_due_.in(kPhase_ns * setup_.node_id);
  types_.push_back(&dronecan::GetNodeInfoRequest::kType);
  handlers_.push_back([this](const dronecan::Transfer& t) {
    if (t.header.kind == dronecan::Kind::request && t.header.type_id == 1) answer(t);
  });
}

void DroneCanNode::post(dronecan::Header header, std::uint64_t signature,
                        std::span<const std::uint8_t> payload) {
  if (header.kind != dronecan::Kind::response) {
    header.transfer_id = ids_.next(header.kind, header.type_id, header.destination);
  }
  const std::vector<CanFrame> frames = dronecan::frames_of(header, signature, payload);
  if (waiting_.size() + frames.size() > kMost_waiting || station_.is_bus_off()) {
    ++dropped_;
    return;
  }
  // What is on the wire stays the first.
  auto place = waiting_.begin() + (on_wire_ ? 1 : 0);
  while (place != waiting_.end() && place->id <= frames.front().id) ++place;
  waiting_.insert(place, frames.begin(), frames.end());
  bus_.request(station_);
}

void DroneCanNode::sent(Nanoseconds /*now*/) {
  on_wire_ = false;
  waiting_.pop_front();
}

void DroneCanNode::failed(CanError /*error*/, bool sending, Nanoseconds /*now*/) {
  if (sending) off_wire();
}

// The first waits again: behind what became due meanwhile and is more urgent.
void DroneCanNode::off_wire() {
  on_wire_ = false;
  if (waiting_.empty()) return;
  auto place = waiting_.begin();
  while (place + 1 != waiting_.end() && (place + 1)->id < waiting_.front().id) ++place;
  std::rotate(waiting_.begin(), waiting_.begin() + 1, place + 1);
}

void DroneCanNode::bus_off(Nanoseconds /*now*/) {
  waiting_.clear();
  bus_.connect(station_, CanBus::kIdles_after_bus_off);
}

void DroneCanNode::receive(const CanFrame& frame, Nanoseconds now) {
  const dronecan::Transfer* transfer = assembler_.take(frame, now);
  if (transfer == nullptr) return;
  const int bits = can_frame_bits(frame) - kCanIntermission;
  last_begun_ns_ = now - std::llround(bits * 1e9 / setup_.rate_Hz);
  for (const auto& handler : handlers_) handler(*transfer);
}

dronecan::NodeStatus DroneCanNode::status() const {
  dronecan::NodeStatus status;
  status.uptime_s = static_cast<std::uint32_t>(queue_.now() / 1'000'000'000);
  status.health = health_;
  return status;
}

void DroneCanNode::publish_status() {
  send(status(), kStatusPriority);
  status_due_.in(kStatusPeriod_ns);
}

void DroneCanNode::answer(const dronecan::Transfer& request) {
  dronecan::GetNodeInfoResponse info;
  info.status = status();
  info.unique_id[0] = setup_.node_id;
  info.set_name(setup_.info);
  const dronecan::Payload payload = dronecan::encode(info);
  dronecan::Header header = request.header;
  header.kind = dronecan::Kind::response;
  header.source = setup_.node_id;
  header.destination = request.header.source;
  post(header, dronecan::GetNodeInfoResponse::kType.signature, payload.bytes());
}

}  // namespace whirl::io
