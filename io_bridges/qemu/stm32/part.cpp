#include "io_bridges/qemu/stm32/part.hpp"

#include "base/check.hpp"

namespace whirl::stm32 {

Part::Part(const ChipHost& host, Rcc& rcc, ChangesOnly& interrupts, const PartTables& tables,
           const std::array<int, Exti::kLines>& exti_irqs, bool f4)
    : host_(host),
      rcc_(rcc),
      dma_bus_(host.memory, rcc),
      chip_{host.events, interrupts, dma_bus_, rcc_, host.finding},
      pwr_(f4),
      exti_(chip_, exti_irqs),
      tables_(tables) {}

io::Wire* Part::pin(std::string_view name) {
  Pin* found = bank_.find(name);
  return found != nullptr ? &found->wire() : nullptr;
}

io::I2cBus* Part::i2c(int number) {
  const auto it = i2cs_.find(number);
  return it != i2cs_.end() ? &it->second->bus() : nullptr;
}

// I2C2 and I2C3 have one pair of pins on the parts with 48 and 64 pins; I2C1 can be remapped.
bool Part::solder_i2c(int number, std::string_view scl, std::string_view sda) {
  io::I2cBus* bus = i2c(number);
  if (bus == nullptr) return false;
  if (scl.empty() && sda.empty() && number == 1) return true;
  if (scl.empty()) scl = number == 2 ? "PB10" : "PA8";
  if (sda.empty()) sda = number == 2 ? "PB11" : "PC9";
  Pin *clock = bank_.find(scl), *data = bank_.find(sda);
  if (clock == nullptr || data == nullptr) return false;
  clock->join(bus->scl(), host_.events.now());
  data->join(bus->sda(), host_.events.now());
  return true;
}

io::SpiSlave* Part::spi_slave(int number) {
  const auto it = spis_.find(number);
  return it != spis_.end() ? it->second.get() : nullptr;
}

io::SpiBus* Part::spi(int number) {
  const auto it = spis_.find(number);
  return it != spis_.end() ? &it->second->bus() : nullptr;
}

bool Part::join_uart(int number, io::UartPeer& peer) {
  const auto it = usarts_.find(number);
  if (it == usarts_.end()) return false;
  it->second->join(peer);
  return true;
}

Signal& Part::signal(const std::string& name) {
  Signal* found = functions_ ? functions_->signal(name) : nullptr;
  return found != nullptr ? *found : bank_.signal(name);
}

DmaRequest* Part::request(const std::string& name) {
  const auto it = requests_.find(name);
  if (it != requests_.end()) return it->second;
  return functions_->dma_request(name);
}

void Part::edge(char port, int pin, bool level, Nanoseconds now) {
  exti_.pin_edge(port, pin, level);
  if (functions_ && (pin == 11 || pin == 15)) functions_->exti_edge(pin, now);
}

void Part::make_function_blocks(MakeFunctionBlocks make, std::function<double()> adcclk_Hz) {
  FunctionBlockHost host;
  host.rtcclk_Hz = [this] { return rcc_.rtc_Hz(); };
  host.backup_writable = [this] { return pwr_.backup_writable(); };
  host.adcclk_Hz = std::move(adcclk_Hz);
  host.request_reset = [this](ResetCause cause) {
    if (reset_request_) reset_request_(cause);
  };
  host.exti = [this](int line, bool level) { exti_.set_line(line, level); };
  host.adc_volts = [this](int adc, int channel, Nanoseconds t) {
    return adc_volts(adc, channel, t);
  };
  functions_ = make(chip_, host);
}

void Part::make_serial_ports() {
  for (const SerialPort& port : tables_.serial_ports) {
    const std::string name = port.name;
    const auto pin = [&](const char* what) -> Signal& { return signal(name + "_" + what); };
    const auto join = [&](auto& block) {
      requests_[name + "_TX"] = &block.tx_request();
      requests_[name + "_RX"] = &block.rx_request();
    };
    switch (port.kind) {
      case SerialKind::spi: {
        auto& spi = spis_[port.number] =
            std::make_unique<Spi>(name, chip_, port.irq, port.on_apb2,
                                  SpiPins{pin("SCK"), pin("MISO"), pin("MOSI"), pin("NSS")});
        join(*spi);
        break;
      }
      case SerialKind::usart: {
        auto& usart = usarts_[port.number] =
            std::make_unique<Usart>(name, chip_, port.irq, port.on_apb2,
                                    UsartPins{pin("TX"), pin("RX"), pin("CTS"), pin("RTS")});
        join(*usart);
        break;
      }
      case SerialKind::i2c: {
        auto& i2c = i2cs_[port.number] = std::make_unique<I2c>(name, chip_, port.irq, port.irq + 1,
                                                               I2cPins{pin("SCL"), pin("SDA")});
        join(*i2c);
        bank_.set_net(name + "_SCL", i2c->bus().scl());
        bank_.set_net(name + "_SDA", i2c->bus().sda());
        break;
      }
    }
  }
}

void Part::add_region(std::uint32_t base, std::uint32_t size, Peripheral& block) {
  ClockGate::Control control;
  for (const BlockClock& row : tables_.clocks) {
    if (row.base != base) continue;
    control.enable = rcc_.enable_register(row.enable);
    control.enable_mask = row.enable_mask;
    if (row.reset == 0) continue;
    control.reset_line = rcc_.enable_register(row.reset);
    control.reset_mask = row.reset_mask;
    rcc_.on_block_reset(row.reset, row.reset_mask, [&block] { block.reset(); });
  }
  gates_.push_back(std::make_unique<ClockGate>(block, control, chip_));
  regions_.push_back({base, size, gates_.back().get()});
  if (&block != &rcc_) own_blocks_.push_back(&block);
}

void Part::add_clocked(Peripheral& block, std::uint32_t size) {
  for (const BlockClock& row : tables_.clocks) {
    if (std::string_view(block.name()) == row.name) return add_region(row.base, size, block);
  }
  WHIRL_CHECK(false, block.name());
}

void Part::finish() {
  for (const auto& [number, spi] : spis_) add_clocked(*spi);
  for (const auto& [number, usart] : usarts_) add_clocked(*usart);
  for (const auto& [number, i2c] : i2cs_) add_clocked(*i2c);
  add_clocked(pwr_);
  const std::size_t own = own_blocks_.size();
  for (const Region& region : functions_->regions()) {
    add_region(region.base, region.size, *region.block);
  }
  own_blocks_.resize(own);  // the function blocks reset themselves: some outlive a reset
  dma_bus_.map(regions_);
  rcc_.set_backup_writable([this] { return pwr_.backup_writable(); });
  rcc_.on_backup_reset([this] { functions_->reset_backup_domain(); });
  rcc_.on_change([this] { functions_->backup_clock_changed(); });
  pwr_.on_pvd([this](bool below) { exti_.set_line(16, below); });
}

void Part::reset(ResetCause cause) {
  rcc_.system_reset(cause);
  for (Peripheral* block : own_blocks_) block->reset();
  functions_->reset(cause);
}

double Part::adc_volts(int adc, int channel, Nanoseconds t) const {
  if (channel < 0 || channel > 15) return 0.0;
  const auto& source = analog_[adc == 3 ? 1 : 0][static_cast<std::size_t>(channel)];
  return source ? source(t) : 0.0;
}

bool Part::set_analog(std::string_view pin, std::function<double(Nanoseconds)> volts) {
  for (const AnalogPin& row : tables_.analog_pins) {
    if (pin != row.pin) continue;
    if (row.adc12 >= 0) analog_[0][static_cast<std::size_t>(row.adc12)] = volts;
    if (row.adc3 >= 0) analog_[1][static_cast<std::size_t>(row.adc3)] = volts;
    return true;
  }
  return false;
}

}  // namespace whirl::stm32
