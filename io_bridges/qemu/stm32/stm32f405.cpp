#include "io_bridges/qemu/stm32/stm32f405.hpp"

#include <array>
#include <map>
#include <string>

#include "harness/base/check.hpp"
#include "io_bridges/qemu/stm32/clock_gate.hpp"
#include "io_bridges/qemu/stm32/dma.hpp"
#include "io_bridges/qemu/stm32/dma_bus.hpp"
#include "io_bridges/qemu/stm32/exti.hpp"
#include "io_bridges/qemu/stm32/f405_tables.hpp"
#include "io_bridges/qemu/stm32/flash_f4.hpp"
#include "io_bridges/qemu/stm32/function_blocks.hpp"
#include "io_bridges/qemu/stm32/gpio_f4.hpp"
#include "io_bridges/qemu/stm32/i2c.hpp"
#include "io_bridges/qemu/stm32/pwr.hpp"
#include "io_bridges/qemu/stm32/rcc_f4.hpp"
#include "io_bridges/qemu/stm32/spi.hpp"
#include "io_bridges/qemu/stm32/usart.hpp"

namespace whirl::stm32 {
namespace {

constexpr std::uint32_t kFlashBytes = 1024 * 1024;
constexpr std::uint32_t kCcmBase = 0x10000000, kCcmBytes = 64 * 1024;
constexpr std::uint32_t kRccBase = 0x40023800, kFlashIfBase = 0x40023C00, kExtiBase = 0x40013C00;

// IRQ numbers: RM0090 table 62.
constexpr std::array<int, 8> kDma1Irqs{11, 12, 13, 14, 15, 16, 17, 47};
constexpr std::array<int, 8> kDma2Irqs{56, 57, 58, 59, 60, 68, 69, 70};
constexpr std::array<int, Exti::kLines> kExtiIrqs{6,  7,  8,  9,  10, 23, 23, 23, 23, 23, 40, 40,
                                                  40, 40, 40, 40, 1,  41, 42, 62, 76, 2,  3};
struct SerialRow {
  int number;
  const char* name;
  int irq;
  bool on_apb2;
};
constexpr SerialRow kSpis[] = {
    {1, "SPI1", 35, true}, {2, "SPI2", 36, false}, {3, "SPI3", 51, false}};
constexpr SerialRow kUsarts[] = {{1, "USART1", 37, true},  {2, "USART2", 38, false},
                                 {3, "USART3", 39, false}, {4, "UART4", 52, false},
                                 {5, "UART5", 53, false},  {6, "USART6", 71, true}};
constexpr SerialRow kI2cs[] = {
    {1, "I2C1", 31, false}, {2, "I2C2", 33, false}, {3, "I2C3", 72, false}};

// The analog inputs and the pins they sit on (datasheet table 7); -1: not on this converter.
struct AnalogPin {
  const char* pin;
  int adc12, adc3;
};
constexpr AnalogPin kAnalogPins[] = {
    {"PA0", 0, 0},   {"PA1", 1, 1},   {"PA2", 2, 2},   {"PA3", 3, 3},   {"PA4", 4, -1},
    {"PA5", 5, -1},  {"PA6", 6, -1},  {"PA7", 7, -1},  {"PB0", 8, -1},  {"PB1", 9, -1},
    {"PC0", 10, 10}, {"PC1", 11, 11}, {"PC2", 12, 12}, {"PC3", 13, 13}, {"PC4", 14, -1},
    {"PC5", 15, -1}, {"PF6", -1, 4},  {"PF7", -1, 5},  {"PF8", -1, 6},  {"PF9", -1, 7},
    {"PF10", -1, 8}, {"PF3", -1, 9},  {"PF4", -1, 14}, {"PF5", -1, 15}};

// Tells the NVIC changes only: blocks say their level whenever they look at it.
class ChangesOnly final : public InterruptLines {
 public:
  explicit ChangesOnly(InterruptLines& nvic) : nvic_(nvic) {}
  void set(int irq, bool level) override {
    bool& now = levels_[static_cast<std::size_t>(irq)];
    if (now == level) return;
    now = level;
    nvic_.set(irq, level);
  }

 private:
  InterruptLines& nvic_;
  std::array<bool, 96> levels_{};
};

// 4 KiB that outlive a system reset; PWR_CR.DBP protects them (RM0090 5.1.2).
class BackupSram final : public WordBlock {
 public:
  explicit BackupSram(const Pwr& pwr) : WordBlock("BKPSRAM", Narrow::merge), pwr_(pwr) {}
  void reset() override {}
  void clear() { words_.fill(0); }

 private:
  std::uint32_t read_word(std::uint32_t offset) override { return words_[offset / 4]; }
  void write_word(std::uint32_t offset, std::uint32_t value) override {
    if (pwr_.backup_writable()) words_[offset / 4] = value;
  }
  const Pwr& pwr_;
  std::array<std::uint32_t, 1024> words_{};
};

class Stm32f405 final : public ChipModel {
 public:
  explicit Stm32f405(const ChipHost& host);

  const std::vector<Region>& regions() const override { return regions_; }
  void reset(ResetCause cause) override;
  void on_reset_request(std::function<void(ResetCause)> request) override {
    reset_request_ = std::move(request);
  }
  bool flash_store(std::uint32_t address, unsigned size, std::uint32_t value) override {
    flash_.store(address, size, value);
    return true;
  }
  io::Wire* pin(std::string_view name) override {
    Pin* found = bank_.find(name);
    return found != nullptr ? &found->wire() : nullptr;
  }
  io::I2cBus* i2c(int number) override {
    return number >= 1 && number <= 3 ? &i2cs_[static_cast<std::size_t>(number - 1)]->bus()
                                      : nullptr;
  }
  io::SpiBus* spi(int number) override {
    return number >= 1 && number <= 3 ? &spis_[static_cast<std::size_t>(number - 1)]->bus()
                                      : nullptr;
  }
  bool join_uart(int number, io::UartPeer& peer) override {
    if (number < 1 || number > 6) return false;
    usarts_[static_cast<std::size_t>(number - 1)]->join(peer);
    return true;
  }
  bool set_analog(std::string_view pin, std::function<double(Nanoseconds)> volts) override;
  const Clocks& clocks() const override { return rcc_; }
  double sysclk_Hz() const override { return rcc_.sysclk_Hz(); }

 private:
  void make_serial_blocks();
  void make_function_blocks();
  void wire_pins();
  void wire_dma();
  void wire_reset_and_power();
  void add_region(std::uint32_t base, std::uint32_t size, Peripheral& block);
  void add_regions();
  Signal& signal(const std::string& name);
  DmaRequest* request(const std::string& name);
  double adc_volts(int adc, int channel, Nanoseconds t) const;

  ChipHost host_;
  ChangesOnly interrupts_;
  DmaBus dma_bus_;
  RccF4 rcc_;
  Chip chip_;
  PinBank bank_;
  Pwr pwr_;
  FlashF4 flash_;
  Exti exti_;
  std::vector<std::unique_ptr<GpioF4>> gpios_;  // A to I
  Syscfg syscfg_;
  Dma dma1_, dma2_;
  BackupSram backup_sram_;
  std::vector<std::unique_ptr<Spi>> spis_;
  std::vector<std::unique_ptr<Usart>> usarts_;
  std::vector<std::unique_ptr<I2c>> i2cs_;
  std::unique_ptr<FunctionBlocks> functions_;
  std::map<std::string, DmaRequest*> requests_;
  std::vector<std::unique_ptr<ClockGate>> gates_;
  std::vector<Region> regions_;
  std::vector<Peripheral*> own_blocks_;  // all but RCC and the function blocks
  std::function<void(ResetCause)> reset_request_;
  // [ADC1 and 2, ADC3][channel]
  std::array<std::array<std::function<double(Nanoseconds)>, 16>, 2> analog_;
};

Stm32f405::Stm32f405(const ChipHost& host)
    : host_(host),
      interrupts_(host.interrupts),
      dma_bus_(host.memory),
      rcc_({host.events, interrupts_, host.finding, host.hse_Hz, host.lse_Hz}),
      chip_{host.events, interrupts_, dma_bus_, rcc_, host.finding},
      pwr_(true),
      flash_(chip_, host.flash, kFlashBytes),
      exti_(chip_, kExtiIrqs),
      syscfg_(exti_,
              [this](char port, int pin) {
                const auto n = static_cast<std::size_t>(port - 'A');
                return n < gpios_.size() && gpios_[n]->level(pin);
              }),
      dma1_("DMA1", chip_, kDma1Irqs, false),
      dma2_("DMA2", chip_, kDma2Irqs, true),
      backup_sram_(pwr_) {
  for (char port = 'A'; port <= 'I'; ++port) {
    gpios_.push_back(std::make_unique<GpioF4>(chip_, bank_, port));
    gpios_.back()->on_edge([this, port](int pin, bool level, Nanoseconds now) {
      exti_.pin_edge(port, pin, level);
      if (functions_ && (pin == 9 || pin == 11 || pin == 15)) functions_->exti_edge(pin, now);
    });
  }
  dma_bus_.bar(kCcmBase, kCcmBytes);
  make_function_blocks();
  make_serial_blocks();
  wire_pins();
  wire_dma();
  add_regions();
  dma_bus_.map(regions_);
  wire_reset_and_power();
}

Signal& Stm32f405::signal(const std::string& name) {
  Signal* found = functions_ ? functions_->signal(name) : nullptr;
  return found != nullptr ? *found : bank_.signal(name);
}

void Stm32f405::make_function_blocks() {
  FunctionBlockHost host;
  host.rtcclk_Hz = [this] { return rcc_.rtc_Hz(); };
  host.backup_writable = [this] { return pwr_.backup_writable(); };
  host.request_reset = [this](ResetCause cause) {
    if (reset_request_) reset_request_(cause);
  };
  host.exti = [this](int line, bool level) { exti_.set_line(line, level); };
  host.adc_volts = [this](int adc, int channel, Nanoseconds t) {
    return adc_volts(adc, channel, t);
  };
  functions_ = make_f405_function_blocks(chip_, host);
}

void Stm32f405::make_serial_blocks() {
  const auto pin = [this](const std::string& block, const char* what) -> Signal& {
    return signal(block + "_" + what);
  };
  for (const SerialRow& row : kSpis) {
    const std::string n = row.name;
    spis_.push_back(std::make_unique<Spi>(
        n, chip_, row.irq, row.on_apb2,
        SpiPins{pin(n, "SCK"), pin(n, "MISO"), pin(n, "MOSI"), pin(n, "NSS")}));
    requests_[n + "_TX"] = &spis_.back()->tx_request();
    requests_[n + "_RX"] = &spis_.back()->rx_request();
  }
  for (const SerialRow& row : kUsarts) {
    const std::string n = row.name;
    usarts_.push_back(std::make_unique<Usart>(
        n, chip_, row.irq, row.on_apb2,
        UsartPins{pin(n, "TX"), pin(n, "RX"), pin(n, "CTS"), pin(n, "RTS")}));
    requests_[n + "_TX"] = &usarts_.back()->tx_request();
    requests_[n + "_RX"] = &usarts_.back()->rx_request();
  }
  for (const SerialRow& row : kI2cs) {
    const std::string n = row.name;
    i2cs_.push_back(std::make_unique<I2c>(n, chip_, row.irq, row.irq + 1,
                                          I2cPins{pin(n, "SCL"), pin(n, "SDA")}));
    requests_[n + "_TX"] = &i2cs_.back()->tx_request();
    requests_[n + "_RX"] = &i2cs_.back()->rx_request();
    bank_.set_net(n + "_SCL", i2cs_.back()->bus().scl());
    bank_.set_net(n + "_SDA", i2cs_.back()->bus().sda());
  }
}

void Stm32f405::wire_pins() {
  for (const AlternateFunction& af : f405_alternate_functions()) {
    gpios_[static_cast<std::size_t>(af.port - 'A')]->add_alternate(af.pin, af.af,
                                                                   signal(af.signal));
  }
}

DmaRequest* Stm32f405::request(const std::string& name) {
  const auto it = requests_.find(name);
  if (it != requests_.end()) return it->second;
  return functions_ ? functions_->dma_request(name) : nullptr;
}

void Stm32f405::wire_dma() {
  for (const DmaRoute& route : f405_dma_routes()) {
    DmaRequest* source = request(route.request);
    if (source == nullptr) continue;  // SDIO, DCMI: not modelled
    (route.controller == 1 ? dma1_ : dma2_).connect(route.stream, route.channel, *source);
  }
}

void Stm32f405::add_region(std::uint32_t base, std::uint32_t size, Peripheral& block) {
  ClockGate::Control control;
  for (const BlockClock& row : f405_block_clocks()) {
    if (row.base != base) continue;
    control = {rcc_.enable_register(row.enable), row.mask, rcc_.enable_register(row.enable - 0x20),
               row.reset_mask};
    rcc_.on_block_reset(row.enable - 0x20, row.reset_mask, [&block] { block.reset(); });
  }
  gates_.push_back(std::make_unique<ClockGate>(block, control, chip_));
  regions_.push_back({base, size, gates_.back().get()});
}

void Stm32f405::add_regions() {
  constexpr std::uint32_t kPage = 0x400;
  add_region(kRccBase, kPage, rcc_);
  add_region(kFlashIfBase, kPage, flash_);
  add_region(kExtiBase, kPage, exti_);
  const auto base_of = [](std::string_view name) {
    for (const BlockClock& row : f405_block_clocks()) {
      if (name == row.name) return row.base;
    }
    WHIRL_CHECK(false, name);
  };
  for (const auto& gpio : gpios_) add_region(base_of(gpio->name()), kPage, *gpio);
  for (const auto& spi : spis_) add_region(base_of(spi->name()), kPage, *spi);
  for (const auto& usart : usarts_) add_region(base_of(usart->name()), kPage, *usart);
  for (const auto& i2c : i2cs_) add_region(base_of(i2c->name()), kPage, *i2c);
  add_region(base_of("PWR"), kPage, pwr_);
  add_region(base_of("SYSCFG"), kPage, syscfg_);
  add_region(base_of("DMA1"), kPage, dma1_);
  add_region(base_of("DMA2"), kPage, dma2_);
  add_region(base_of("BKPSRAM"), 0x1000, backup_sram_);
  for (const Region& region : regions_) {
    if (region.base != kRccBase) own_blocks_.push_back(region.block);
  }
  if (!functions_) return;
  for (const Region& region : functions_->regions()) {
    add_region(region.base, region.size, *region.block);
  }
}

void Stm32f405::wire_reset_and_power() {
  rcc_.set_backup_writable([this] { return pwr_.backup_writable(); });
  rcc_.on_backup_reset([this] {
    if (functions_) functions_->reset_backup_domain();
  });
  rcc_.on_change([this] {
    if (functions_) functions_->backup_clock_changed();
  });
  pwr_.on_pvd([this](bool below) { exti_.set_line(16, below); });
}

void Stm32f405::reset(ResetCause cause) {
  if (cause == ResetCause::power_on) backup_sram_.clear();
  rcc_.system_reset(cause);
  for (Peripheral* block : own_blocks_) block->reset();
  if (functions_) functions_->reset(cause);
}

double Stm32f405::adc_volts(int adc, int channel, Nanoseconds t) const {
  if (channel < 0 || channel > 15) return 0.0;
  const auto& source = analog_[adc == 3 ? 1 : 0][static_cast<std::size_t>(channel)];
  return source ? source(t) : 0.0;
}

bool Stm32f405::set_analog(std::string_view pin, std::function<double(Nanoseconds)> volts) {
  for (const AnalogPin& row : kAnalogPins) {
    if (pin != row.pin) continue;
    if (row.adc12 >= 0) analog_[0][static_cast<std::size_t>(row.adc12)] = volts;
    if (row.adc3 >= 0) analog_[1][static_cast<std::size_t>(row.adc3)] = volts;
    return true;
  }
  return false;
}

}  // namespace

std::unique_ptr<ChipModel> make_stm32f405(const ChipHost& host) {
  return std::make_unique<Stm32f405>(host);
}

}  // namespace whirl::stm32
