// The half of a part's assembly that F405 and F103 share: serial ports, function blocks, clock
// gates, regions, analog inputs, reset.
#pragma once
#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "io_bridges/qemu/stm32/chip_model.hpp"
#include "io_bridges/qemu/stm32/clock_gate.hpp"
#include "io_bridges/qemu/stm32/dma_bus.hpp"
#include "io_bridges/qemu/stm32/exti.hpp"
#include "io_bridges/qemu/stm32/function_blocks.hpp"
#include "io_bridges/qemu/stm32/i2c.hpp"
#include "io_bridges/qemu/stm32/part_tables.hpp"
#include "io_bridges/qemu/stm32/pwr.hpp"
#include "io_bridges/qemu/stm32/rcc.hpp"
#include "io_bridges/qemu/stm32/spi.hpp"
#include "io_bridges/qemu/stm32/usart.hpp"

namespace whirl::stm32 {

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

class Part : public ChipModel {
 public:
  const std::vector<Region>& regions() const override { return regions_; }
  void reset(ResetCause cause) override;
  void on_reset_request(std::function<void(ResetCause)> request) override {
    reset_request_ = std::move(request);
  }
  io::Wire* pin(std::string_view name) override;
  io::I2cBus* i2c(int number) override;
  bool solder_i2c(int number, std::string_view scl, std::string_view sda) override;
  io::SpiBus* spi(int number) override;
  io::SpiSlave* spi_slave(int number) override;
  bool join_uart(int number, io::UartPeer& peer) override;
  bool set_analog(std::string_view pin, std::function<double(Nanoseconds)> volts) override;
  bool on_dac(int channel, std::function<void(double volts)> told) override {
    return functions_->on_dac(channel, std::move(told));
  }
  void set_vdd(double volts) override {
    rcc_.set_vdd(volts);
    pwr_.set_vdd(volts);
  }
  Timer* timer(int number) override { return functions_->timer(number); }
  BxCan* can(int number) override { return functions_->can(number); }
  Adc* converter(int number) override { return functions_->converter(number); }
  const Clocks& clocks() const override { return rcc_; }
  void on_clock_change(std::function<void()> changed) override {
    rcc_.on_change(std::move(changed));
  }
  double sysclk_Hz() const override { return rcc_.sysclk_Hz(); }
  double core_waits_for_dma_at_most_ns() const override { return dma_bus_.core_waits_at_most_ns(); }

 protected:
  using MakeFunctionBlocks = std::unique_ptr<FunctionBlocks> (*)(const Chip&,
                                                                 const FunctionBlockHost&);
  Part(const ChipHost& host, Rcc& rcc, ChangesOnly& interrupts, const PartTables& tables,
       const std::array<int, Exti::kLines>& exti_irqs, bool f4);

  // In this order, by the derived part's constructor.
  void make_function_blocks(MakeFunctionBlocks make, std::function<double()> adcclk_Hz);
  void make_serial_ports();
  void add_region(std::uint32_t base, std::uint32_t size, Peripheral& block);
  void add_clocked(Peripheral& block, std::uint32_t size = 0x400);  // base from the table
  void finish();  // the shared regions, DMA's view, backup domain

  Signal& signal(const std::string& name);
  DmaRequest* request(const std::string& name);
  void edge(char port, int pin, bool level, Nanoseconds now);  // of a pin, from GPIO

  ChipHost host_;
  Rcc& rcc_;
  DmaBus dma_bus_;
  Chip chip_;
  PinBank bank_;
  Pwr pwr_;
  Exti exti_;

 private:
  double adc_volts(int adc, int channel, Nanoseconds t) const;

  const PartTables& tables_;
  std::map<int, std::unique_ptr<Spi>> spis_;
  std::map<int, std::unique_ptr<Usart>> usarts_;
  std::map<int, std::unique_ptr<I2c>> i2cs_;
  std::unique_ptr<FunctionBlocks> functions_;
  std::map<std::string, DmaRequest*> requests_;
  std::vector<std::unique_ptr<ClockGate>> gates_;
  std::vector<Region> regions_;
  std::vector<Peripheral*> own_blocks_;  // all but RCC and the function blocks
  std::function<void(ResetCause)> reset_request_;
  // [ADC1 and 2, ADC3][channel]
  std::array<std::array<std::function<double(Nanoseconds)>, 16>, 2> analog_;
};

}  // namespace whirl::stm32
