// What a board can carry: a type of device, the interface of one on the rack, and what the rack
// offers to it. A new type is one file in devices/ and one line of devices/table.hpp.
//
//   Life    make() builds the device from its slot: reads its keys, joins pins and buses. It may fail
//           half way: the slot keeps the first failure, and hands out wires that lead nowhere
//   Errors  bad_input, with the board's and the device's name
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "io_bridges/board_description/bus_name.hpp"
#include "io_bridges/devices/bus.hpp"
#include "io_bridges/devices/can_bus.hpp"
#include "io_bridges/devices/faults.hpp"
#include "io_bridges/devices/i2c_bus.hpp"
#include "io_bridges/devices/spi_slave.hpp"
#include "io_bridges/devices/wire.hpp"
#include "io_bridges/messages/messages.hpp"
#include "io_bridges/rack/device_key.hpp"

namespace whirl::rack {

using io::Nanoseconds;

// Messages from the harness that a device takes. Without a port it takes all of that kind, and so
// may others; a port belongs to one device.
struct Intake {
  io::Kind kind{};
  std::optional<std::uint16_t> port = {};
};

class RackDevice {
 public:
  virtual ~RackDevice() = default;
  virtual std::vector<Intake> intakes() const { return {}; }
  virtual void on_message(const io::Reader& /*message*/) {}
  // At a boundary, before what happened is posted.
  virtual void report(Nanoseconds /*now*/) {}
};

// What the rack offers. Null and false: the part has no such thing.
class Rack {
 public:
  virtual ~Rack() = default;
  virtual io::EventQueue& events() = 0;
  virtual io::FaultBook& faults() = 0;
  virtual io::Batch& happened() = 0;  // messages to the harness, in order of time
  virtual io::FindingSink finding() = 0;
  virtual std::uint64_t seed() const = 0;
  // The path of a file that the device leaves in the run's folder; empty: this run leaves none.
  virtual std::string file_to_leave(const std::string& device) const = 0;

  virtual io::Wire* pin(const std::string& name) = 0;
  virtual bool set_analog(const std::string& pin, std::function<double(Nanoseconds)> volts) = 0;
  // Told at each change of what the DAC's channel puts out.
  virtual bool on_dac(int /*channel*/, std::function<void(double volts)> /*told*/) { return false; }
  virtual io::I2cBus* i2c(int number) = 0;
  virtual io::CanBus* can(int number) = 0;  // with the faults of its wire and its log
  // With the faults of its wires and its log.
  virtual bool join_spi(int bus, io::Wire& chip_select, io::SpiTarget& target,
                        const BoardDevice& device, int number) = 0;
  virtual bool join_uart(int number, io::UartPeer& peer) = 0;
  // The microcontroller's SPI as the slave of a device that is a master.
  virtual io::SpiSlave* spi_slave(int /*number*/) { return nullptr; }
};

struct DeviceType;

// A device's place on the board while it is made.
class DeviceSlot {
 public:
  DeviceSlot(Rack& rack, const std::string& board, const BoardDevice& device,
             const DeviceType& type, int number);

  const std::string& name() const { return device_.name; }
  std::uint16_t number() const { return number_; }  // in the board's list
  std::uint16_t bus_number() const {
    return static_cast<std::uint16_t>(whirl::bus_number(device_.bus).value_or(0));
  }
  const std::string& place() const { return place_; }
  Rack& rack() { return rack_; }

  // Keys, or their defaults. Pre: the type has that key, of that kind.
  bool given(const std::string& path) const;
  double quantity(const std::string& path) const;
  std::uint16_t whole(const std::string& path) const;
  bool flag(const std::string& path) const;
  std::string text(const std::string& path) const;
  std::vector<double> triple(const std::string& path) const;
  std::vector<std::string> axes(const std::string& path) const;

  // Wiring. A bus is that of the key `bus`, a chip select the pin of the key `cs`.
  io::Wire& pin(const std::string& path) { return wire(text(path)); }
  io::Wire& wire(const std::string& pin);
  io::I2cBus& i2c();
  io::CanBus& can();
  void join_i2c(io::I2cTarget& target) { i2c().add(target); }
  void join_spi(io::SpiTarget& target);
  void join_uart(io::UartPeer& peer);
  io::SpiSlave& spi_slave();
  void set_analog(const std::string& pin, std::function<double(Nanoseconds)> volts);

  // True where the result is a failure, which is kept.
  bool failed(const Result<Done>& result);
  const std::optional<Error>& error() const { return error_; }

 private:
  void fail(const std::string& what);
  const DeviceKey& key(const std::string& path) const;
  template <typename T>
  T value(const std::string& path) const;

  Rack& rack_;
  const BoardDevice& device_;
  const DeviceType& type_;
  std::uint16_t number_;
  std::string place_;
  std::optional<Error> error_;
  io::Wire nowhere_{"nowhere"};
  io::I2cBus no_bus_{"nowhere"};
  std::unique_ptr<io::CanBus> no_can_;
  struct NoSlave final : io::SpiSlave {
    Nanoseconds shift_out(Nanoseconds) override { return kNothing; }
    std::uint8_t sampled(std::uint8_t, int, Nanoseconds) override { return 0xFF; }
    int mode() const override { return 0; }
  } no_slave_;
};

struct DeviceType {
  std::string name;   // "mpu6000"
  std::string about;  // what it is, in a line
  std::vector<DeviceKey> keys;
  std::unique_ptr<RackDevice> (*make)(DeviceSlot& slot) = nullptr;
  std::vector<std::string> pins = {};  // that it is soldered to whatever the board file says
  // What it senses, by number (io::Fault::axis): a fault of the plan names one, `axis = "gyro_x"`.
  std::vector<std::string> senses = {};

  const DeviceKey* find(const std::string& path) const;
  std::string key_list() const;  // "bus, cs, int"
};

using DeviceTypes = std::vector<DeviceType>;

const DeviceType* find_type(const DeviceTypes& types, const std::string& name);
std::string type_list(const DeviceTypes& types);  // "mpu6000, esc_i2c, ..."

template <typename Device>
std::unique_ptr<RackDevice> make_device(DeviceSlot& slot) {
  return std::make_unique<Device>(slot);
}

}  // namespace whirl::rack
