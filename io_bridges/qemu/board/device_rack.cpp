#include "io_bridges/qemu/board/device_rack.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "io_bridges/devices/esc_i2c.hpp"
#include "io_bridges/devices/mavlink_link.hpp"
#include "io_bridges/devices/mpu6000.hpp"
#include "io_bridges/devices/pulse_source.hpp"
#include "io_bridges/devices/serial_port.hpp"
#include "io_bridges/devices/wire_faults.hpp"
#include "io_bridges/qemu/board/board_pins.hpp"
#include "io_bridges/qemu/board/device_values.hpp"
#include "io_bridges/qemu/board/i2c_orders.hpp"
#include "io_bridges/qemu/board/inertial_sensor.hpp"
#include "io_bridges/qemu/board/power_stage.hpp"
#include "io_bridges/qemu/board/spi_log.hpp"

namespace whirl::board {
namespace {

using io::Kind;

std::uint16_t port(int number) {
  return static_cast<std::uint16_t>(number);
}

}  // namespace

struct DeviceRack::Parts {
  explicit Parts(Site given) : site(std::move(given)) {}

  Result<Done> add(const BoardDevice& device, int number);
  Result<Done> add_mpu6000(const BoardDevice& device, int number);
  Result<Done> add_esc(const BoardDevice& device);
  Result<Done> add_radio(const BoardDevice& device);
  auto told(Kind kind, int uart) {
    return [this, kind, uart](std::span<const std::uint8_t> bytes, io::Nanoseconds t_ns) {
      site.happened.add(kind, port(uart), t_ns, bytes.data(), std::uint32_t(bytes.size()));
    };
  }
  Result<Done> add_serial(const BoardDevice& device);
  Result<Done> add_i2c_master(const BoardDevice& device);
  Result<Done> add_power_stage(const BoardDevice& device);
  Result<Done> add_pulse_source(const BoardDevice& device);
  Result<Done> add_volts(const BoardDevice& device);
  Result<Done> add_jumper(const BoardDevice& device);
  io::I2cBus* i2c(int number);
  io::SpiBus* spi(int number);
  io::Wire* pin(const std::string& name) { return name.empty() ? nullptr : site.chip.pin(name); }
  Error wrong(const BoardDevice& device, const std::string& what) const {
    return {ErrorKind::bad_input, board + ": " + device.name, what, ""};
  }

  Site site;
  std::string board;
  io::FaultBook faults;
  std::set<std::pair<int, int>> addresses;  // bus, address
  std::set<int> i2c_soldered;               // to the pins that the board names
  std::map<int, std::unique_ptr<io::I2cWireFaults>> i2c_buses;
  std::map<int, io::SpiBus*> spi_buses;
  std::map<const io::Wire*, std::unique_ptr<SpiLog>> spi_logs;
  std::vector<std::unique_ptr<io::SpiWireFaults>> spi_faults;
  std::vector<std::unique_ptr<io::UartWireFaults>> uart_faults;
  std::vector<std::unique_ptr<InertialSensor>> inertial;
  std::vector<std::unique_ptr<io::Mpu6000>> mpus;
  std::map<int, std::unique_ptr<io::EscI2c>> escs;         // by motor
  std::map<int, std::unique_ptr<io::MavlinkLink>> radios;  // by UART
  std::map<int, std::unique_ptr<io::SerialPort>> serials;  // by UART
  std::map<int, std::unique_ptr<I2cOrders>> masters;       // by bus
  std::map<int, std::unique_ptr<PowerStage>> stages;       // by motor
  std::map<int, std::unique_ptr<io::PulseSource>> pulses;  // by motor
};

DeviceRack::DeviceRack(Site site) : parts_(std::make_unique<Parts>(std::move(site))) {
  io::Batch& happened = parts_->site.happened;
  parts_->faults.on_applied([&happened](std::uint32_t number, io::Nanoseconds now) {
    happened.add(Kind::fault_applied, port(static_cast<int>(number)), now, nullptr, 0);
  });
}

DeviceRack::~DeviceRack() = default;

Result<Done> DeviceRack::build(const BoardDescription& board) {
  parts_->board = board.name;
  auto soldered = join_pins(board.pins, parts_->site.chip, board.name);
  if (!soldered) return soldered.error();
  parts_->i2c_soldered = std::move(soldered.value());
  int number = 0;
  for (const BoardDevice& device : board.devices) {
    const auto added = parts_->add(device, number++);
    if (!added) return added.error();
  }
  const auto used = [this](int bus) { return parts_->i2c_buses.count(bus) != 0; };
  watch_empty_buses(used, parts_->site.chip, parts_->site.finding);
  return Done{};
}

Result<Done> DeviceRack::Parts::add(const BoardDevice& device, int number) {
  if (device.type == "mpu6000") return add_mpu6000(device, number);
  if (device.type == "esc_i2c") return add_esc(device);
  if (device.type == "mavlink_link") return add_radio(device);
  if (device.type == "serial") return add_serial(device);
  if (device.type == "i2c_master") return add_i2c_master(device);
  if (device.type == "power_stage") return add_power_stage(device);
  if (device.type == "pulse_source") return add_pulse_source(device);
  if (device.type == "volts") return add_volts(device);
  if (device.type == "jumper") return add_jumper(device);
  return wrong(device,
               "unknown type '" + device.type +
                   "'; use mpu6000, esc_i2c, mavlink_link, serial, i2c_master, power_stage, "
                   "pulse_source, volts or jumper");
}

io::I2cBus* DeviceRack::Parts::i2c(int number) {
  io::I2cBus* bus = site.chip.i2c(number);
  if (bus == nullptr || i2c_buses.count(number) != 0) return bus;
  if (i2c_soldered.count(number) == 0) site.chip.solder_i2c(number, "", "");
  i2c_buses[number] = std::make_unique<io::I2cWireFaults>(site.events, faults, *bus, number);
  bus->on_transaction([this, number](const io::I2cTransaction& t) {
    io::BusTransaction head;
    head.start_ns = t.start_ns;
    head.address = t.address;
    head.read = t.read ? 1 : 0;
    head.acked = t.address_acked && t.all_acked ? 1 : 0;
    head.length = static_cast<std::uint32_t>(t.bytes.size());
    site.happened.add(Kind::i2c_transaction, port(number), t.stop_ns, head, t.bytes.data(),
                      head.length);
  });
  return bus;
}

io::SpiBus* DeviceRack::Parts::spi(int number) {
  io::SpiBus* bus = site.chip.spi(number);
  if (bus == nullptr || spi_buses.count(number) != 0) return bus;
  spi_buses[number] = bus;
  bus->on_byte(
      [this](const io::Wire* chip_select, std::uint8_t mosi, std::uint8_t miso, io::Nanoseconds) {
        const auto log = spi_logs.find(chip_select);
        if (log != spi_logs.end()) log->second->byte(mosi, miso);
      });
  return bus;
}

Result<Done> DeviceRack::Parts::add_mpu6000(const BoardDevice& device, int number) {
  const BusName name = split(device.bus);
  io::SpiBus* bus = name.kind == "spi" ? spi(name.number) : nullptr;
  if (bus == nullptr) return wrong(device, "the part has no bus '" + device.bus + "' for it");
  io::Wire* select = pin(text(device, "cs"));
  if (select == nullptr)
    return wrong(device, "the part has no pin '" + text(device, "cs") + "' for cs");
  io::Wire* interrupt = pin(text(device, "int"));
  if (interrupt == nullptr && !text(device, "int").empty()) {
    return wrong(device, "the part has no pin '" + text(device, "int") + "' for int");
  }
  auto physics = imu_params(params_of(device), board + ": " + device.name);
  if (!physics) return physics.error();
  inertial.push_back(std::make_unique<InertialSensor>(physics.value(), site.seed, device.name));
  InertialSensor& felt = *inertial.back();
  io::Mpu6000::Params params;
  params.name = device.name;
  params.bus = name.number;
  params.device = number;
  mpus.push_back(std::make_unique<io::Mpu6000>(
      site.events, params, [&felt](io::Nanoseconds now) { return felt.feel(now); }, interrupt,
      &faults, site.finding));
  spi_faults.push_back(
      std::make_unique<io::SpiWireFaults>(faults, *mpus.back(), name.number, number));
  bus->add(*spi_faults.back(), *select);
  spi_logs[select] = std::make_unique<SpiLog>(site.happened, name.number, number, *select);
  if (interrupt != nullptr) {
    interrupt->watch([this, number](bool level, io::Nanoseconds now) {
      if (level) site.happened.add(Kind::data_ready, port(number), now, nullptr, 0);
    });
  }
  return Done{};
}

Result<Done> DeviceRack::Parts::add_esc(const BoardDevice& device) {
  const BusName name = split(device.bus);
  io::I2cBus* bus = name.kind == "i2c" ? i2c(name.number) : nullptr;
  if (bus == nullptr) return wrong(device, "the part has no bus '" + device.bus + "' for it");
  if (device.address < 0x08 || device.address > 0x77) return wrong(device, "needs an I2C address");
  if (device.motor < 1 || escs.count(device.motor) != 0) {
    return wrong(device, "needs a motor number of its own");
  }
  if (!addresses.insert({name.number, device.address}).second) {
    return wrong(device, "another device has its address on " + device.bus);
  }
  auto esc = std::make_unique<io::EscI2c>(static_cast<std::uint8_t>(device.address));
  esc->on_setpoint([this, motor = device.motor](const io::EscI2c::Write& write) {
    io::EscSetpoint setpoint;
    setpoint.value = write.v;
    setpoint.valid = write.valid ? 1 : 0;
    setpoint.start_ns = write.start_ns;
    site.happened.add(Kind::esc_setpoint, port(motor), write.stop_ns, setpoint);
  });
  bus->add(*esc);
  escs[device.motor] = std::move(esc);
  return Done{};
}

Result<Done> DeviceRack::Parts::add_radio(const BoardDevice& device) {
  const BusName name = split(device.bus);
  io::MavlinkLink::Params params;
  const auto given = params_of(device);
  params.seed = site.seed;
  for (const char* loss : {"uplink_loss", "downlink_loss"}) {
    const auto share = given.find(loss);
    if (share == given.end() || (share->second >= 0.0 && share->second <= 1.0)) continue;
    return wrong(device, std::string(loss) + " is not between 0 and 100 %");
  }
  if (const double baud = baud_of(device); baud > 0.0) params.baud = baud;
  for (const auto& [key, value] : given) {
    if (key == "uplink_loss")
      params.uplink_loss = value;
    else if (key == "downlink_loss")
      params.downlink_loss = value;
    else if (key == "air_bytes_per_s")
      params.air_bytes_per_s = value;
    else if (key == "buffer")
      params.buffer_ns = static_cast<io::Nanoseconds>(value * 1e9);
    else
      return wrong(device, "unknown parameter '" + key + "'");
  }
  auto radio = std::make_unique<io::MavlinkLink>(site.events, params, site.finding);
  radio->on_frame(told(Kind::uart_received, name.number));
  radio->on_delivered(told(Kind::uart_delivered, name.number));
  uart_faults.push_back(
      std::make_unique<io::UartWireFaults>(site.events, faults, *radio, name.number, site.seed));
  if ((name.kind != "usart" && name.kind != "uart") || radios.count(name.number) != 0 ||
      !site.chip.join_uart(name.number, *uart_faults.back())) {
    return wrong(device, "the part has no bus '" + device.bus + "' for it");
  }
  radios[name.number] = std::move(radio);
  return Done{};
}

Result<Done> DeviceRack::Parts::add_serial(const BoardDevice& device) {
  const BusName name = split(device.bus);
  if (baud_of(device) <= 0.0) return wrong(device, "needs a baud rate");
  auto serial =
      std::make_unique<io::SerialPort>(site.events, device.name, baud_of(device), site.finding);
  serial->on_message(told(Kind::uart_received, name.number));
  uart_faults.push_back(
      std::make_unique<io::UartWireFaults>(site.events, faults, *serial, name.number, site.seed));
  if ((name.kind != "usart" && name.kind != "uart") || radios.count(name.number) != 0 ||
      serials.count(name.number) != 0 || !site.chip.join_uart(name.number, *uart_faults.back())) {
    return wrong(device, "the part has no bus '" + device.bus + "' for it");
  }
  serials[name.number] = std::move(serial);
  return Done{};
}

Result<Done> DeviceRack::Parts::add_i2c_master(const BoardDevice& device) {
  const BusName name = split(device.bus);
  io::I2cBus* bus = name.kind == "i2c" ? i2c(name.number) : nullptr;
  if (bus == nullptr || masters.count(name.number) != 0) {
    return wrong(device, "the part has no bus '" + device.bus + "' for it");
  }
  double rate_Hz = 400e3;
  for (const auto& [key, value] : params_of(device)) {
    if (key != "rate") return wrong(device, "unknown parameter '" + key + "'");
    rate_Hz = value;
  }
  if (!(rate_Hz >= 1e3 && rate_Hz <= 400e3)) return wrong(device, "rate must be 1 to 400 kHz");
  masters[name.number] =
      std::make_unique<I2cOrders>(site.events, *bus, rate_Hz, port(name.number), site.happened);
  return Done{};
}

Result<Done> DeviceRack::Parts::add_power_stage(const BoardDevice& device) {
  if (device.motor < 1 || !stages.empty()) {
    return wrong(device, "needs a motor number; a board has one power stage");
  }
  const auto params = power_stage_params(params_of(device), board + ": " + device.name);
  if (!params) return params.error();
  auto stage = std::make_unique<PowerStage>(params.value(), site.seed, device.name);
  if (!stage->join(site.chip)) {
    return wrong(device, "the part lacks a pin that the power stage is wired to");
  }
  stage->on_shoot_through(
      [this, name = device.name](int leg, io::Nanoseconds start_ns, io::Nanoseconds end_ns) {
        site.happened.add(Kind::shoot_through, port(leg), end_ns, io::ShootThrough{start_ns});
        site.finding({end_ns, name,
                      "shoot-through: both switches of leg " + std::string(1, "abc"[leg]) +
                          " were on for " + std::to_string(end_ns - start_ns) + " ns"});
      });
  stage->on_backwards([this, name = device.name](io::Nanoseconds now) {
    site.finding({now, name,
                  "the motor turns backwards, without any load of the air: swap two of its wires "
                  "(swap_wires) or the firmware's direction"});
  });
  stages[device.motor] = std::move(stage);
  return Done{};
}

Result<Done> DeviceRack::Parts::add_pulse_source(const BoardDevice& device) {
  io::Wire* wire = pin(device.bus);
  if (wire == nullptr) return wrong(device, "the part has no pin '" + device.bus + "'");
  if (device.motor < 1 || pulses.count(device.motor) != 0) {
    return wrong(device, "needs a motor number of its own");
  }
  pulses[device.motor] = std::make_unique<io::PulseSource>(site.events, *wire);
  return Done{};
}

Result<Done> DeviceRack::Parts::add_volts(const BoardDevice& device) {
  if (params_of(device).count("volts") == 0) return wrong(device, "needs params.volts");
  const double level_V = params_of(device).at("volts");
  if (!site.chip.set_analog(device.bus, [level_V](io::Nanoseconds) { return level_V; })) {
    return wrong(device, "the part has no analog pin '" + device.bus + "'");
  }
  return Done{};
}

Result<Done> DeviceRack::Parts::add_jumper(const BoardDevice& device) {
  io::Wire* from = pin(text(device, "cs"));
  io::Wire* to = pin(text(device, "int"));
  if (from == nullptr || to == nullptr) return wrong(device, "the part lacks one of its two pins");
  const int driver = to->add_driver();
  from->watch([to, driver](bool level, io::Nanoseconds now) {
    to->drive(driver, level ? io::Drive::high : io::Drive::low, now);
  });
  return Done{};
}

bool DeviceRack::take(const io::Reader& message) {
  const io::Header& head = message.header();
  switch (head.kind) {
    case Kind::body_motion:
      for (auto& sensor : parts_->inertial) {
        sensor->set_motion(message.as<io::BodyMotion>(), head.t_ns);
      }
      return true;
    case Kind::esc_state: {
      const auto esc = parts_->escs.find(head.port);
      if (esc == parts_->escs.end()) return true;
      const auto state = message.as<io::EscState>();
      esc->second->set_status({state.bus_current_A, state.speed_rpm, state.flags});
      return true;
    }
    case Kind::uart_frame: {
      const auto radio = parts_->radios.find(head.port);
      if (radio != parts_->radios.end()) radio->second->send_frame(message.payload(), head.t_ns);
      const auto serial = parts_->serials.find(head.port);
      if (serial == parts_->serials.end()) return true;
      serial->second->send_bytes(message.payload(), head.t_ns);
      return true;
    }
    case Kind::shaft_load: {
      const auto stage = parts_->stages.find(head.port);
      if (stage == parts_->stages.end()) return true;
      stage->second->set_load(message.as<io::ShaftLoad>(), head.t_ns);
      return true;
    }
    case Kind::i2c_order: {
      const auto master = parts_->masters.find(head.port);
      if (master != parts_->masters.end()) {
        master->second->add(message.as<io::I2cOrder>(), message.tail_after(sizeof(io::I2cOrder)),
                            head.t_ns);
      }
      return true;
    }
    case Kind::pulse_train: {
      const auto source = parts_->pulses.find(head.port);
      if (source == parts_->pulses.end()) return true;
      const auto t = message.as<io::PulseTrain>();
      source->second->set({t.width_ns, t.period_ns, t.glitch_ns, t.glitch_after_ns});
      return true;
    }
    case Kind::fault: {
      const auto f = message.as<io::FaultCommand>();
      parts_->faults.add({f.number, static_cast<io::FaultKind>(f.kind), f.start_ns, f.end_ns, f.bus,
                          f.address, f.axis, f.value});
      return true;
    }
    default:
      return false;
  }
}

void DeviceRack::report(io::Nanoseconds now) {
  for (auto& [motor, stage] : parts_->stages) {
    parts_->site.happened.add(Kind::shaft_state, port(motor), now, stage->report(now));
  }
}

}  // namespace whirl::board
