#include "io_bridges/qemu/stm32/stm32f405.hpp"

#include "io_bridges/qemu/stm32/dma.hpp"
#include "io_bridges/qemu/stm32/flash_f4.hpp"
#include "io_bridges/qemu/stm32/gpio_f4.hpp"
#include "io_bridges/qemu/stm32/part.hpp"
#include "io_bridges/qemu/stm32/rcc_f4.hpp"

namespace whirl::stm32 {
namespace {

constexpr std::uint32_t kFlashBytes = 1024 * 1024;
constexpr std::uint32_t kCcmBase = 0x10000000, kCcmBytes = 64 * 1024;

// IRQ numbers: RM0090 table 62.
constexpr std::array<int, 8> kDma1Irqs{11, 12, 13, 14, 15, 16, 17, 47};
constexpr std::array<int, 8> kDma2Irqs{56, 57, 58, 59, 60, 68, 69, 70};
constexpr std::array<int, Exti::kLines> kExtiIrqs{6,  7,  8,  9,  10, 23, 23, 23, 23, 23, 40, 40,
                                                  40, 40, 40, 40, 1,  41, 42, 62, 76, 2,  3};

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

// What Part's constructor needs to find ready.
struct F405Core {
  explicit F405Core(const ChipHost& host)
      : interrupts(host.interrupts),
        rcc({host.events, interrupts, host.finding, host.hse_Hz, host.lse_Hz, host.hse_start_ns,
             host.hsi_error, host.hse_error}) {}
  ChangesOnly interrupts;
  RccF4 rcc;
};

class Stm32f405 final : F405Core, public Part {
 public:
  explicit Stm32f405(const ChipHost& host);

  void reset(ResetCause cause) override {
    if (cause == ResetCause::power_on) backup_sram_.clear();
    Part::reset(cause);
  }
  cycles::FlashTiming flash_timing() const override { return flash_.timing(); }
  void on_flash_timing_change(std::function<void()> changed) override {
    flash_.on_timing_change(std::move(changed));
  }
  bool flash_store(std::uint32_t address, unsigned size, std::uint32_t value) override {
    flash_.store(address, size, value);
    return true;
  }

 private:
  void make_pins();
  void wire_dma();

  FlashF4 flash_;
  std::vector<std::unique_ptr<GpioF4>> gpios_;  // A to I
  Syscfg syscfg_;
  Dma dma1_, dma2_;
  BackupSram backup_sram_;
};

Stm32f405::Stm32f405(const ChipHost& host)
    : F405Core(host),
      Part(host, F405Core::rcc, F405Core::interrupts, f405_tables(), kExtiIrqs, true),
      flash_(chip_, host.flash, kFlashBytes),
      syscfg_(exti_,
              [this](char port, int pin) {
                const auto n = static_cast<std::size_t>(port - 'A');
                return n < gpios_.size() && gpios_[n]->level(pin);
              }),
      dma1_("DMA1", chip_, kDma1Irqs, false),
      dma2_("DMA2", chip_, kDma2Irqs, true),
      backup_sram_(pwr_) {
  dma_bus_.bar(kCcmBase, kCcmBytes);  // CCM is on the core's data bus alone
  make_function_blocks(make_f405_function_blocks, {});
  make_serial_ports();
  make_pins();
  wire_dma();
  add_region(0x40023800, 0x400, rcc_);
  add_region(0x40023C00, 0x400, flash_);
  add_region(0x40013C00, 0x400, exti_);
  for (const auto& gpio : gpios_) add_clocked(*gpio);
  add_clocked(syscfg_);
  add_clocked(dma1_);
  add_clocked(dma2_);
  add_clocked(backup_sram_, 0x1000);
  finish();
}

void Stm32f405::make_pins() {
  for (char port = 'A'; port <= 'I'; ++port) {
    gpios_.push_back(std::make_unique<GpioF4>(chip_, bank_, port));
    gpios_.back()->on_edge(
        [this, port](int pin, bool level, Nanoseconds now) { edge(port, pin, level, now); });
  }
  for (const AlternateFunction& af : f405_alternate_functions()) {
    gpios_[static_cast<std::size_t>(af.port - 'A')]->add_alternate(af.pin, af.af,
                                                                   signal(af.signal));
  }
}

void Stm32f405::wire_dma() {
  for (const DmaRoute& route : f405_dma_routes()) {
    DmaRequest* source = request(route.request);
    if (source == nullptr) continue;  // SDIO, DCMI: not modelled
    (route.controller == 1 ? dma1_ : dma2_).connect(route.stream, route.channel, *source);
  }
}

}  // namespace

std::unique_ptr<ChipModel> make_stm32f405(const ChipHost& host) {
  return std::make_unique<Stm32f405>(host);
}

}  // namespace whirl::stm32
