// An I2C master that is not the microcontroller: the stand commands the board through it.
#include "io_bridges/rack/devices/table.hpp"
#include "io_bridges/rack/models/i2c_orders.hpp"

namespace whirl::rack {
namespace {

class I2cMasterDevice final : public RackDevice {
 public:
  explicit I2cMasterDevice(DeviceSlot& slot)
      : bus_(slot.bus_number()),
        orders_(slot.rack().events(), slot.i2c(), slot.quantity("params.rate"), bus_,
                slot.rack().happened()) {}

  std::vector<Intake> intakes() const override { return {{io::Kind::i2c_order, bus_}}; }
  void on_message(const io::Reader& message) override {
    orders_.add(message.as<io::I2cOrder>(), message.tail_after(sizeof(io::I2cOrder)),
                message.header().t_ns);
  }

 private:
  std::uint16_t bus_;
  I2cOrders orders_;
};

}  // namespace

DeviceType i2c_master_type() {
  return {"i2c_master",
          "master on I2C, by which a stand commands the board",
          {bus_key("i2c", "the bus").need().own(Sharing::own_in_type),
           quantity_key("params.rate", Dimension::frequency, "kHz", {1e3, 400e3}, "of SCL")
               .with(400e3)},
          make_device<I2cMasterDevice>};
}

}  // namespace whirl::rack
