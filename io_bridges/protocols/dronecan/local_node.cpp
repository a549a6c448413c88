#include "io_bridges/protocols/dronecan/local_node.hpp"

namespace whirl::io::dronecan {
namespace {

constexpr std::uint8_t kStatus_priority = 24;

}  // namespace

LocalNode::LocalNode(std::uint8_t id, std::string name, FrameSink send)
    : id_(id), name_(std::move(name)), send_(std::move(send)), assembler_(known_type, id) {}

std::uint32_t LocalNode::uptime_s(std::int64_t now_ns) const {
  return static_cast<std::uint32_t>((now_ns - *begun_ns_) / 1'000'000'000);
}

void LocalNode::poll(std::int64_t now_ns) {
  if (!begun_ns_) begun_ns_ = next_status_ns_ = now_ns;
  if (now_ns < next_status_ns_) return;
  next_status_ns_ += NodeStatus::kLongest_period_ns;
  if (next_status_ns_ <= now_ns) next_status_ns_ = now_ns + NodeStatus::kLongest_period_ns;
  status_.uptime_s = uptime_s(now_ns);
  broadcast(status_, kStatus_priority);
}

const Transfer* LocalNode::on_frame(const CanFrame& frame, std::int64_t now_ns) {
  watch_.on_frame(frame, now_ns);
  const Transfer* transfer = assembler_.take(frame, now_ns);
  if (transfer == nullptr) return nullptr;
  if (transfer->header.kind == Kind::request &&
      transfer->header.type_id == GetNodeInfoRequest::kType.id) {
    answer(transfer->header, now_ns);
    return nullptr;
  }
  return transfer;
}

void LocalNode::answer(const Header& request, std::int64_t now_ns) {
  GetNodeInfoResponse info;
  info.status = status_;
  info.status.uptime_s = begun_ns_ ? uptime_s(now_ns) : 0;
  info.set_name(name_);
  const Payload payload = encode(info);
  const Header header{.kind = Kind::response,
                      .type_id = request.type_id,
                      .priority = request.priority,
                      .source = id_,
                      .destination = request.source,
                      .transfer_id = request.transfer_id};
  TransferFrames frames(header, GetNodeInfoResponse::kType.signature, payload.bytes());
  for (CanFrame frame; frames.next(frame);) send_(frame);
}

void LocalNode::send(Header header, const DataType& type, const Payload& payload) {
  header.source = id_;
  header.transfer_id = ids_.next(header.kind, header.type_id, header.destination);
  TransferFrames frames(header, type.signature, payload.bytes());
  for (CanFrame frame; frames.next(frame);) send_(frame);
}

}  // namespace whirl::io::dronecan
