// A rack without a chip: pins and buses that a test drives by hand.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "io_bridges/devices/spi_bus.hpp"
#include "io_bridges/devices/wire_faults.hpp"
#include "io_bridges/rack/check_board.hpp"
#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {

class BenchRack final : public Rack {
 public:
  using Bytes = std::vector<std::uint8_t>;

  explicit BenchRack(std::uint64_t seed = 1) : seed_(seed) {}

  // Null where the board check or the device's own refuses it: see error.
  RackDevice* add(const BoardDevice& device) {
    if (const auto wrong = check_device(device, number_, device_types())) {
      error = wrong->key + ": " + wrong->what;
      return nullptr;
    }
    const DeviceType& type = *find_type(device_types(), device.type);
    DeviceSlot slot(*this, "bench", device, type, number_++);
    devices_.push_back(type.make(slot));
    if (slot.error()) error = slot.error()->what;
    return slot.error() ? nullptr : devices_.back().get();
  }
  void send(const io::BodyMotion& motion) { send(io::Kind::body_motion, motion); }
  template <typename T>
  void send(io::Kind kind, const T& message) {
    io::Batch batch;
    batch.add(kind, 0, queue.now(), message);
    io::Reader reader(batch.bytes());
    if (!reader.next()) return;
    for (const auto& device : devices_) {
      for (const Intake& intake : device->intakes()) {
        if (intake.kind == kind) device->on_message(reader);
      }
    }
  }
  void run_ms(double ms) { queue.run_until(queue.now() + static_cast<Nanoseconds>(ms * 1e6)); }

  Bytes i2c_transfer(std::uint8_t address, const Bytes& write, int length) {
    const Nanoseconds now = queue.now();
    i2c_bus.start(now);
    if (!i2c_bus.address(address, false, now)) write_refused = true;
    for (const std::uint8_t byte : write) i2c_bus.write(byte, now);
    if (length > 0) {
      i2c_bus.start(now);
      i2c_bus.address(address, true, now);
    }
    Bytes bytes;
    for (int i = 0; i < length; ++i) bytes.push_back(i2c_bus.read(i + 1 < length, now));
    i2c_bus.stop(now);
    return bytes;
  }
  Bytes spi_transfer(const std::string& chip_select, Bytes bytes) {
    io::Wire& wire = *pin(chip_select);
    wire.force(io::Drive::low, queue.now());
    for (std::uint8_t& byte : bytes) byte = spi_bus.transfer(byte, 1'000'000, 0, queue.now());
    wire.force(io::Drive::none, queue.now());
    return bytes;
  }

  io::EventQueue& events() override { return queue; }
  io::FaultBook& faults() override { return book; }
  io::Batch& happened() override { return posted; }
  io::FindingSink finding() override {
    return [this](const io::Finding& f) { findings.push_back(f.where + ": " + f.what); };
  }
  std::uint64_t seed() const override { return seed_; }
  std::string file_to_leave(const std::string& device) const override {
    return folder.empty() ? "" : folder + "/" + device + ".img";
  }
  io::Wire* pin(const std::string& name) override {
    auto& wire = pins_[name];
    if (!wire) {
      wire = std::make_unique<io::Wire>(name);
      wire->drive(wire->add_driver(), io::Drive::pull_high, 0);
    }
    return wire.get();
  }
  bool set_analog(const std::string& pin, std::function<double(Nanoseconds)> volts) override {
    if (!pin.starts_with("PC")) return false;
    analog[pin] = std::move(volts);
    return true;
  }
  io::I2cBus* i2c(int number) override { return number == 1 ? &i2c_bus : nullptr; }
  io::CanBus* can(int number) override { return number == 1 ? &can_bus : nullptr; }
  bool join_spi(int bus, io::Wire& chip_select, io::SpiTarget& target, const BoardDevice&,
                int) override {
    if (bus == 1) spi_bus.add(target, chip_select);
    return bus == 1;
  }
  bool join_uart(int number, io::UartPeer& peer) override {
    peer.join([this](const io::UartByte& byte, const io::UartFormat& format) {
      uart_bytes.push_back(byte.value);
      uart_format = format;
    });
    uart = &peer;
    return number == 6;
  }

  io::EventQueue queue;
  io::FaultBook book;
  io::Batch posted;
  io::I2cBus i2c_bus{"I2C1"};
  io::SpiBus spi_bus{"SPI1"};
  io::CanBus can_bus{queue, "CAN1"};
  io::UartPeer* uart = nullptr;  // USART6
  Bytes uart_bytes;              // from it
  io::UartFormat uart_format;
  std::vector<std::string> findings;
  std::map<std::string, std::function<double(Nanoseconds)>> analog;
  std::string folder;  // where devices leave their files
  std::string error;
  bool write_refused = false;

 private:
  std::uint64_t seed_;
  int number_ = 0;
  std::map<std::string, std::unique_ptr<io::Wire>> pins_;
  std::vector<std::unique_ptr<RackDevice>> devices_;
};

}  // namespace whirl::rack
