// A node by which the harness sends frames on a board's CAN bus: each from its time on, in their order.
#include <deque>

#include "io_bridges/messages/can_message.hpp"
#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

class CanPortDevice final : public RackDevice, private io::CanNode {
 public:
  explicit CanPortDevice(DeviceSlot& slot)
      : bus_number_(slot.bus_number()),
        events_(slot.rack().events()),
        bus_(slot.can()),
        station_(bus_.join(*this, slot.name(), slot.number())),
        due_(events_, [this] { bus_.request(station_); }) {
    bus_.configure(station_, 1e9 / slot.quantity("params.rate"));
    bus_.connect(station_, 1);
  }

  std::vector<Intake> intakes() const override { return {{io::Kind::can_order, bus_number_}}; }
  void on_message(const io::Reader& message) override {
    Waiting& next = waiting_.emplace_back();
    next.t_ns = message.header().t_ns;
    next.frame = io::frame_of(message.as<io::CanMessage>());
    wake();
  }

 private:
  struct Waiting {
    Nanoseconds t_ns = 0;
    io::CanFrame frame;
  };
  void wake() {
    if (!waiting_.empty()) due_.at(waiting_.front().t_ns);
  }
  const io::CanFrame* offered() override {
    const bool is_due = !waiting_.empty() && waiting_.front().t_ns <= events_.now();
    return is_due ? &waiting_.front().frame : nullptr;
  }
  void sent(Nanoseconds /*now*/) override {
    waiting_.pop_front();
    wake();
  }
  void receive(const io::CanFrame& /*frame*/, Nanoseconds /*now*/) override {}  // the log has it
  void bus_off(Nanoseconds /*now*/) override {
    waiting_.clear();
    bus_.connect(station_, io::CanBus::kIdles_after_bus_off);
  }

  std::uint16_t bus_number_;
  io::EventQueue& events_;
  io::CanBus& bus_;
  io::CanStation& station_;
  io::Event due_;
  std::deque<Waiting> waiting_;
};

}  // namespace

DeviceType can_port_type() {
  return {
      "can_port",
      "node on CAN, by which a stand or a bench sends frames",
      {bus_key("can", "the bus").need().own(Sharing::own_in_type),
       quantity_key("params.rate", Dimension::frequency, "kHz", {10e3, 1e6}, "of bits").with(1e6)},
      make_device<CanPortDevice>};
}

}  // namespace whirl::rack
