// A DroneCAN node of the world on a board's CAN bus: sends and receives whole transfers, tells its
// NodeStatus once a second and who it is when asked.
//
//   Sends    by identifier, and among equals in order. At most 64 frames wait: a transfer that finds no
//            room is dropped and counted
//   Bus-off  what waits is dropped, and it rejoins by itself
//   Phase    of NodeStatus: by its node id, so that not all of a bus speak at once
#pragma once
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "io_bridges/devices/can_bus.hpp"
#include "io_bridges/protocols/dronecan/assembler.hpp"
#include "io_bridges/protocols/dronecan/fields.hpp"
#include "io_bridges/protocols/dronecan/node.hpp"

namespace whirl::io {

class DroneCanNode : private CanNode {
 public:
  struct Setup {
    std::string name;  // of the device
    std::string info;  // what GetNodeInfo answers
    int number = 0;    // on the board
    std::uint8_t node_id = 0;
    double rate_Hz = 1e6;
  };
  DroneCanNode(EventQueue& queue, CanBus& bus, Setup setup);

  template <typename Message>
  void send(const Message& message, std::uint8_t priority) {
    const dronecan::Payload payload = dronecan::encode(message);
    post({dronecan::Kind::message, Message::kType.id, priority, setup_.node_id, 0, 0},
         Message::kType.signature, payload.bytes());
  }
  // `begun`: the first bit of the transfer's last frame; it is whole at now.
  template <typename Message>
  void on(std::function<void(const Message&, Nanoseconds begun, Nanoseconds now)> handler) {
    types_.push_back(&Message::kType);
    handlers_.push_back([this, handler = std::move(handler)](const dronecan::Transfer& t) {
      if (t.header.type_id != Message::kType.id || t.header.kind != Message::kType.kind) return;
      if (const auto m = dronecan::decode<Message>(t.payload)) {
        handler(*m, last_begun_ns_, t.last_ns);
      } else {
        ++assembler_.counts().malformed;
      }
    });
  }
  void set_health(std::uint8_t health) { health_ = health; }
  const dronecan::TransferCounts& counts() const { return assembler_.counts(); }
  std::uint64_t dropped() const { return dropped_; }

 private:
  const CanFrame* offered() override { return waiting_.empty() ? nullptr : &waiting_.front(); }
  void begun(Nanoseconds /*now*/) override { on_wire_ = true; }
  void sent(Nanoseconds now) override;
  void lost_arbitration(Nanoseconds /*now*/) override { off_wire(); }
  void failed(CanError error, bool sending, Nanoseconds now) override;
  void receive(const CanFrame& frame, Nanoseconds now) override;
  void bus_off(Nanoseconds now) override;
  void off_wire();

  void post(dronecan::Header header, std::uint64_t signature,
            std::span<const std::uint8_t> payload);
  dronecan::NodeStatus status() const;
  void publish_status();
  void answer(const dronecan::Transfer& request);

  EventQueue& queue_;
  CanBus& bus_;
  Setup setup_;
  CanStation& station_;
  Event status_due_;
  std::deque<CanFrame> waiting_;
  bool on_wire_ = false;  // the first of them
  std::vector<const dronecan::DataType*> types_;
  std::vector<std::function<void(const dronecan::Transfer&)>> handlers_;
  dronecan::Assembler assembler_;
  dronecan::TransferIds ids_;
  std::uint8_t health_ = dronecan::NodeStatus::ok;
  std::uint64_t dropped_ = 0;
  Nanoseconds last_begun_ns_ = 0;
};

}  // namespace whirl::io
