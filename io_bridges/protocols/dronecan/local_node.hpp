// A node of ours on a DroneCAN bus: tells its status, answers what every node is asked, and speaks messages.
//
//   Turn    frames in by on_frame(); what it has to send by itself by poll(), once a step; all frames out by the sink
//   Status  NodeStatus each second. GetNodeInfo requests are answered
//   Ids     another node under our id is counted (assembler().counts().own_id)
#pragma once
#include <functional>
#include <string>

#include "io_bridges/protocols/dronecan/assembler.hpp"
#include "io_bridges/protocols/dronecan/fields.hpp"
#include "io_bridges/protocols/dronecan/node.hpp"
#include "io_bridges/protocols/dronecan/node_watch.hpp"
#include "io_bridges/protocols/dronecan/types.hpp"

namespace whirl::io::dronecan {

class LocalNode {
 public:
  using FrameSink = std::function<void(const CanFrame&)>;

  LocalNode(std::uint8_t id, std::string name, FrameSink send);

  std::uint8_t id() const { return id_; }
  void poll(std::int64_t now_ns);
  // Null, or a transfer for whoever owns the node, valid until the next call; GetNodeInfo requests are answered here.
  const Transfer* on_frame(const CanFrame& frame, std::int64_t now_ns);

  template <typename Message>
  void broadcast(const Message& message, std::uint8_t priority) {
    const Payload payload = encode(message);
    send({.type_id = Message::kType.id, .priority = priority}, Message::kType, payload);
  }
  template <typename Request>
  void request(const Request& message, std::uint8_t to) {
    const Payload payload = encode(message);
    send({.kind = Kind::request, .type_id = Request::kType.id, .destination = to}, Request::kType,
         payload);
  }
  // What decodes; otherwise it is counted as malformed.
  template <typename Message>
  std::optional<Message> read(const Transfer& transfer) {
    if (transfer.header.kind != Message::kType.kind ||
        transfer.header.type_id != Message::kType.id) {
      return std::nullopt;
    }
    auto message = decode<Message>(transfer.payload);
    if (!message) ++assembler_.counts().malformed;
    return message;
  }

  NodeStatus& status() { return status_; }
  const NodeWatch& watch() const { return watch_; }
  const TransferCounts& counts() const { return assembler_.counts(); }

 private:
  void send(Header header, const DataType& type, const Payload& payload);
  void answer(const Header& request, std::int64_t now_ns);
  std::uint32_t uptime_s(std::int64_t now_ns) const;

  std::uint8_t id_;
  std::string name_;
  FrameSink send_;
  Assembler assembler_;
  TransferIds ids_;
  NodeWatch watch_;
  NodeStatus status_;
  std::optional<std::int64_t> begun_ns_;
  std::int64_t next_status_ns_ = 0;
};

}  // namespace whirl::io::dronecan
