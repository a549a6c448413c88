#include "io_bridges/qemu/board/device_rack.hpp"

#include <map>
#include <set>

#include "io_bridges/board_description/analog_device.hpp"
#include "io_bridges/board_description/bus_kind.hpp"
#include "io_bridges/devices/can_wire_faults.hpp"
#include "io_bridges/devices/wire_faults.hpp"
#include "io_bridges/qemu/board/board_pins.hpp"
#include "io_bridges/qemu/board/empty_can.hpp"
#include "io_bridges/qemu/board/far_ends.hpp"
#include "io_bridges/qemu/board/spi_log.hpp"
#include "io_bridges/qemu/stm32/bxcan.hpp"
#include "io_bridges/rack/can_log.hpp"
#include "io_bridges/rack/check_board.hpp"
#include "io_bridges/rack/fault_order.hpp"
#include "io_bridges/rack/takers.hpp"

namespace whirl::board {

using io::Kind;

// The rack as its devices see it: the chip's pins and buses, with faults and logs.
class DeviceRack::Wiring final : public rack::Rack {
 public:
  explicit Wiring(Site site) : site_(std::move(site)) {
    rack::tell_applied(faults_, site_.happened);
  }

  Result<Done> build(const BoardDescription& board);
  Result<Done> follow(const WireEnd& end) { return far_.follow(end); }
  bool on_message(const io::Reader& message);
  void report(io::Nanoseconds now) {
    for (const auto& device : devices_) device->report(now);
  }
  void run_ends(io::Nanoseconds now);

  io::EventQueue& events() override { return site_.events; }
  io::FaultBook& faults() override { return faults_; }
  io::Batch& happened() override { return site_.happened; }
  io::FindingSink finding() override { return site_.finding; }
  std::uint64_t seed() const override { return site_.seed; }
  std::string file_to_leave(const std::string& device) const override {
    if (site_.folder.empty()) return "";
    return site_.folder + "/" + device + (site_.node.empty() ? "" : "_" + site_.node) + ".img";
  }
  io::Wire* pin(const std::string& name) override;
  bool set_analog(const std::string& pin, std::function<double(io::Nanoseconds)> volts) override {
    analog_.push_back(pin);
    return site_.chip.set_analog(pin, std::move(volts));
  }
  bool on_dac(int channel, std::function<void(double volts)> told) override {
    return site_.chip.on_dac(channel, std::move(told));
  }
  io::I2cBus* i2c(int number) override;
  io::CanBus* can(int number) override;
  bool join_spi(int bus, io::Wire& chip_select, io::SpiTarget& target, const BoardDevice& device,
                int number) override;
  bool join_uart(int number, io::UartPeer& peer) override {
    return join_uart(number, peer, io::UartWireFaults::Spoils::towards_mcu);
  }
  io::SpiSlave* spi_slave(int number) override { return site_.chip.spi_slave(number); }

 private:
  Result<Done> check(const BoardDescription& board) const;
  Result<Done> check_pins(const BoardDevice& device) const;
  std::string bus_of(const std::string& pin) const;
  Result<Done> add(const BoardDescription& board, int number);
  bool join_uart(int number, io::UartPeer& peer, io::UartWireFaults::Spoils spoils);
  const WireEnd* far_end(const BoardDevice& device) const;
  io::SpiBus* spi(int number);
  void report_fights(io::Wire& wire, const std::string& name);
  void report_once(io::Nanoseconds now, const std::string& where, const std::string& what);

  Site site_;
  io::OnceFindings once_{site_.finding};
  io::FaultBook faults_;
  std::map<const io::Wire*, std::string> names_;  // of devices by their chip select
  std::vector<BoardPin> named_pins_;              // with neither resistor nor bus
  std::vector<std::string> analog_;               // pins that a device puts a voltage on
  Ear ear_;  // of the device that is being made, where another board takes its place
  std::set<int> i2c_soldered_;  // to the pins that the board names
  std::map<int, std::unique_ptr<io::I2cWireFaults>> i2c_buses_;
  std::map<int, std::unique_ptr<io::CanWireFaults>> can_buses_;
  std::map<int, io::SpiBus*> spi_buses_;
  std::map<const io::Wire*, std::unique_ptr<SpiLog>> spi_logs_;
  std::vector<std::unique_ptr<io::SpiWireFaults>> spi_faults_;
  std::map<int, std::unique_ptr<io::UartWireFaults>> uart_faults_;
  std::vector<std::unique_ptr<rack::RackDevice>> devices_;
  FarEnds far_{*this, site_.wires, [this](int number, io::UartPeer& peer) {
                 return join_uart(number, peer, io::UartWireFaults::Spoils::both_ways);
               }};
  rack::Takers takers_;
};

Result<Done> DeviceRack::Wiring::build(const BoardDescription& board) {
  if (auto good = check(board); !good) return good.error();
  auto soldered = join_pins(board.pins, site_.chip, board.name);
  if (!soldered) return soldered.error();
  i2c_soldered_ = std::move(soldered.value());
  for (const BoardPin& pin : board.pins) {
    if (pin.pull.empty() && pin.bus.empty()) named_pins_.push_back(pin);
  }
  log_edges(board.pins, site_.chip, site_.happened);
  for (std::size_t i = 0; i < board.devices.size(); ++i) {
    if (auto added = add(board, static_cast<int>(i)); !added) return added.error();
  }
  for (const BoardDevice& device : board.devices) {
    if (auto good = check_pins(device); !good) return good.error();
  }
  const auto used = [this](int bus) { return i2c_buses_.count(bus) != 0; };
  watch_empty_buses(used, site_.chip, site_.finding);
  const auto can_used = [this](int bus) { return can_buses_.count(bus) != 0; };
  watch_empty_can(can_used, site_.chip, site_.finding);
  return Done{};
}

// "i2c3" where the pin is a line of that bus; empty: it is none.
std::string DeviceRack::Wiring::bus_of(const std::string& pin) const {
  const io::Wire* wire = site_.chip.pin(pin);
  for (const auto& [number, faults] : i2c_buses_) {
    io::I2cBus* bus = site_.chip.i2c(number);
    if (wire == &bus->scl() || wire == &bus->sda()) return "i2c" + std::to_string(number);
  }
  return "";
}

// Only the part knows which pins a bus has that the board file does not name.
Result<Done> DeviceRack::Wiring::check_pins(const BoardDevice& device) const {
  for (const rack::DeviceKey& key : rack::find_type(site_.types, device.type)->keys) {
    const auto value = device.value(key.path);
    const auto* pin = value ? std::get_if<std::string>(&*value) : nullptr;
    if (key.kind != rack::KeyKind::pin || pin == nullptr || bus_of(*pin).empty()) continue;
    return Error{ErrorKind::bad_input, device.place + ": " + device.name + "." + key.path,
                 *pin + " is a line of " + bus_of(*pin), ""};
  }
  return Done{};
}

Result<Done> DeviceRack::Wiring::check(const BoardDescription& board) const {
  std::optional<rack::BoardComplaint> wrong;
  for (std::size_t i = 0; i < board.devices.size() && !wrong; ++i) {
    wrong = rack::check_device(board.devices[i], static_cast<int>(i), site_.types);
  }
  if (!wrong) wrong = rack::check_sharing(board, site_.types);
  if (!wrong) return Done{};
  const BoardDevice& device = board.devices[static_cast<std::size_t>(wrong->device)];
  const std::string place = (device.place.empty() ? board.name : device.place) + ": " + device.name;
  const bool of_type = wrong->key == "type" || wrong->key.empty();
  return Error{ErrorKind::bad_input, of_type ? place : place + "." + wrong->key, wrong->what,
               wrong->cure};
}

Result<Done> DeviceRack::Wiring::add(const BoardDescription& board, int number) {
  const BoardDevice& device = board.devices[static_cast<std::size_t>(number)];
  const rack::DeviceType* type = rack::find_type(site_.types, device.type);
  WHIRL_CHECK(type != nullptr, device.type);
  const WireEnd* far = far_end(device);
  // A part that senses has nothing to tell where another board stands in its place; nor has one on a UART or an analog pin.
  const bool mute = !type->senses.empty() || is_uart(device.bus) || puts_a_level(device);
  if (far != nullptr && mute) return far_.lead(device, number, *far, {});
  rack::DeviceSlot slot(*this, board.name, device, *type, number);
  if (far != nullptr) {
    ear_ = {std::make_unique<io::I2cBus>(device.name),
            std::make_unique<CanEar>(site_.events, device.name)};
  }
  auto made = type->make(slot);
  Ear ear = std::exchange(ear_, {});
  if (slot.error()) return *slot.error();
  WHIRL_CHECK(made != nullptr, device.type);
  if (far != nullptr) {
    if (const auto led = far_.lead(device, number, *far, std::move(ear)); !led) return led.error();
  }
  devices_.push_back(std::move(made));
  return takers_.add(*devices_.back(), slot.place());
}

const WireEnd* DeviceRack::Wiring::far_end(const BoardDevice& device) const {
  for (const WireEnd& end : site_.ends) {
    if (end.device == device.name) return &end;
  }
  return nullptr;
}

void DeviceRack::Wiring::report_once(io::Nanoseconds now, const std::string& where,
                                     const std::string& what) {
  once_.report({now, where, what});
}

void DeviceRack::Wiring::report_fights(io::Wire& wire, const std::string& name) {
  wire.on_fight([this, name](const std::string& low, const std::string& high, io::Nanoseconds now) {
    report_once(now, name, low + " drives it low, " + high + " drives it high");
  });
}

io::Wire* DeviceRack::Wiring::pin(const std::string& name) {
  io::Wire* wire = site_.chip.pin(name);
  if (wire != nullptr) report_fights(*wire, name);
  return wire;
}

void DeviceRack::Wiring::run_ends(io::Nanoseconds now) {
  for (const BoardPin& pin : named_pins_) {
    if (site_.chip.pin(pin.pin)->was_driven() || !bus_of(pin.pin).empty()) continue;
    report_once(now, pin.pin, "the board names it '" + pin.name + "', but nothing ever drove it");
  }
  for (const std::string& pin : analog_) {
    const io::Wire* wire = site_.chip.pin(pin);
    if (wire == nullptr || !wire->was_driven()) continue;
    report_once(now, pin, "a device puts a voltage on it, and something drove it: both cannot be");
  }
}

io::I2cBus* DeviceRack::Wiring::i2c(int number) {
  if (ear_.i2c != nullptr) return ear_.i2c.get();
  io::I2cBus* bus = site_.chip.i2c(number);
  if (bus == nullptr || i2c_buses_.count(number) != 0) return bus;
  if (i2c_soldered_.count(number) == 0) site_.chip.solder_i2c(number, "", "");
  report_fights(bus->scl(), "i2c" + std::to_string(number) + ".scl");
  report_fights(bus->sda(), "i2c" + std::to_string(number) + ".sda");
  i2c_buses_[number] = std::make_unique<io::I2cWireFaults>(site_.events, faults_, *bus, number);
  bus->on_transaction([this, number](const io::I2cTransaction& t) {
    io::BusTransaction head;
    head.start_ns = t.start_ns;
    head.address = t.address;
    head.read = t.read ? 1 : 0;
    head.acked = t.address_acked && t.all_acked ? 1 : 0;
    head.length = static_cast<std::uint32_t>(t.bytes.size());
    std::vector<std::uint32_t> passed_ns;
    for (const io::Nanoseconds at : t.passed_ns) passed_ns.push_back(io::passed_ns(t.start_ns, at));
    io::add_transaction(Kind::i2c_transaction, static_cast<std::uint16_t>(number), t.stop_ns, head,
                        t.bytes, passed_ns, site_.happened);
  });
  return bus;
}

io::CanBus* DeviceRack::Wiring::can(int number) {
  if (ear_.can != nullptr) return &ear_.can->bus();
  stm32::BxCan* block = site_.chip.can(number);
  if (block == nullptr) return nullptr;
  io::CanBus& bus = block->bus();
  if (can_buses_.count(number) != 0) return &bus;
  constexpr double kBabbling_bit_ns = 1000.0;
  can_buses_[number] =
      std::make_unique<io::CanWireFaults>(site_.events, faults_, bus, number, kBabbling_bit_ns);
  rack::log_can(bus, number, site_.happened);
  return &bus;
}

io::SpiBus* DeviceRack::Wiring::spi(int number) {
  io::SpiBus* bus = site_.chip.spi(number);
  if (bus == nullptr || spi_buses_.count(number) != 0) return bus;
  spi_buses_[number] = bus;
  bus->on_clash([this, number](const io::Wire& first, const io::Wire& second, io::Nanoseconds now) {
    report_once(now, "spi" + std::to_string(number),
                names_[&first] + " and " + names_[&second] + " are selected at once");
  });
  bus->on_byte([this](const io::Wire* chip_select, std::uint8_t mosi, std::uint8_t miso,
                      io::Nanoseconds now) {
    const auto log = spi_logs_.find(chip_select);
    if (log != spi_logs_.end()) log->second->byte(mosi, miso, now);
  });
  return bus;
}

bool DeviceRack::Wiring::join_spi(int number, io::Wire& chip_select, io::SpiTarget& target,
                                  const BoardDevice& device, int device_number) {
  io::SpiBus* bus = spi(number);
  if (bus == nullptr) return false;
  names_[&chip_select] = device.name;
  spi_faults_.push_back(
      std::make_unique<io::SpiWireFaults>(faults_, target, number, device_number));
  bus->add(*spi_faults_.back(), chip_select);
  spi_logs_[&chip_select] =
      std::make_unique<SpiLog>(site_.happened, number, device_number, chip_select);
  return true;
}

bool DeviceRack::Wiring::join_uart(int number, io::UartPeer& peer,
                                   io::UartWireFaults::Spoils spoils) {
  if (uart_faults_.count(number) != 0) return false;
  auto& faults = uart_faults_[number];
  faults =
      std::make_unique<io::UartWireFaults>(site_.events, faults_, peer, number, site_.seed, spoils);
  return site_.chip.join_uart(number, *faults);
}

bool DeviceRack::Wiring::on_message(const io::Reader& message) {
  const io::Header& head = message.header();
  if (head.kind == Kind::fault) {
    faults_.add(rack::fault_of(message));
    return true;
  }
  if (takers_.give(message)) return true;
  if (head.kind == Kind::rc_channels) {
    report_once(head.t_ns, "transmitter", "sticks are sent, but no receiver is on the board");
  }
  return false;
}

DeviceRack::DeviceRack(Site site) : wiring_(std::make_unique<Wiring>(std::move(site))) {}

DeviceRack::~DeviceRack() = default;

Result<Done> DeviceRack::build(const BoardDescription& board) {
  return wiring_->build(board);
}

bool DeviceRack::on_message(const io::Reader& message) {
  return wiring_->on_message(message);
}

void DeviceRack::report(io::Nanoseconds now) {
  wiring_->report(now);
}

Result<Done> DeviceRack::follow(const WireEnd& end) {
  return wiring_->follow(end);
}

void DeviceRack::run_ends(io::Nanoseconds now) {
  wiring_->run_ends(now);
}

}  // namespace whirl::board
