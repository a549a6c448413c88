#include "io_bridges/qemu/stm32/stm32f103.hpp"

#include "io_bridges/qemu/stm32/dma_f1.hpp"
#include "io_bridges/qemu/stm32/flash_f1.hpp"
#include "io_bridges/qemu/stm32/gpio_f1.hpp"
#include "io_bridges/qemu/stm32/part.hpp"
#include "io_bridges/qemu/stm32/rcc_f1.hpp"

namespace whirl::stm32 {
namespace {

constexpr std::uint32_t kFlashBytes = 128 * 1024;
constexpr int kDma1FirstIrq = 11;

// RM0008 table 63; lines 16 PVD, 17 RTC alarm, 18 USB wake-up are the last.
constexpr std::array<int, Exti::kLines> kExtiIrqs{6,  7,  8,  9,  10, 23, 23, 23, 23, 23, 40, 40,
                                                  40, 40, 40, 40, 1,  41, 42, 42, 42, 42, 42};

// What Part's constructor needs to find ready.
struct F103Core {
  explicit F103Core(const ChipHost& host)
      : interrupts(host.interrupts),
        rcc({host.events, interrupts, host.finding, host.hse_Hz, host.lse_Hz, host.hse_start_ns,
             host.hsi_error, host.hse_error}) {}
  ChangesOnly interrupts;
  RccF1 rcc;
};

class Stm32f103 final : F103Core, public Part {
 public:
  explicit Stm32f103(const ChipHost& host);

  cycles::FlashTiming flash_timing() const override { return flash_.timing(); }
  void on_flash_timing_change(std::function<void()> changed) override {
    flash_.on_timing_change(std::move(changed));
  }
  bool flash_store(std::uint32_t address, unsigned size, std::uint32_t value) override {
    return flash_.store(address, size, value);
  }

 private:
  void make_pins();

  FlashF1 flash_;
  std::vector<std::unique_ptr<GpioF1>> gpios_;  // A to E
  Afio afio_;
  DmaF1 dma_;
};

Stm32f103::Stm32f103(const ChipHost& host)
    : F103Core(host),
      Part(host, F103Core::rcc, F103Core::interrupts, f103_tables(), kExtiIrqs, false),
      flash_(chip_, host.flash, kFlashBytes),
      afio_(exti_,
            [this](char port, int pin) {
              const auto n = static_cast<std::size_t>(port - 'A');
              return n < gpios_.size() && gpios_[n]->level(pin);
            }),
      dma_("DMA1", chip_, kDma1FirstIrq) {
  make_function_blocks(make_f103_function_blocks, [this] { return F103Core::rcc.adcclk_Hz(); });
  make_serial_ports();
  make_pins();
  for (const DmaRoute& route : f103_dma_routes()) {
    if (DmaRequest* source = request(route.request)) dma_.connect(route.stream, *source);
  }
  add_region(0x40021000, 0x400, rcc_);
  add_region(0x40022000, 0x400, flash_);
  add_region(0x40010400, 0x400, exti_);
  for (const auto& gpio : gpios_) add_clocked(*gpio);
  add_clocked(afio_);
  add_clocked(dma_);
  finish();
}

void Stm32f103::make_pins() {
  for (char port = 'A'; port <= 'E'; ++port) {
    gpios_.push_back(std::make_unique<GpioF1>(chip_, bank_, port));
    gpios_.back()->on_edge(
        [this, port](int pin, bool level, Nanoseconds now) { edge(port, pin, level, now); });
  }
  for (const RemapRow& row : f103_remaps()) {
    gpios_[static_cast<std::size_t>(row.port - 'A')]->add_signal(row.pin, row, signal(row.signal));
  }
  afio_.on_remap([this](std::uint32_t mapr) {
    for (const auto& gpio : gpios_) gpio->remap(mapr);
  });
  afio_.reset();
}

}  // namespace

std::unique_ptr<ChipModel> make_stm32f103(const ChipHost& host) {
  return std::make_unique<Stm32f103>(host);
}

}  // namespace whirl::stm32
