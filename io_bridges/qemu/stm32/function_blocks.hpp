// The function blocks of a part, wired to each other: timers, converters, RTC, watchdogs, CRC, RNG,
// DAC, CAN, the cycle counter, and blocks that only answer a probe. The chip model (stm32f405,
// stm32f103) adds clocks, pins, DMA and serial ports, and joins both halves by the names below.
//
//   Signals   "TIM3_CH2", "TIM1_CH1N", "TIM1_ETR", "TIM1_BKIN", "CAN1_RX", "CAN1_TX"
//   Requests  "TIM1_UP", "TIM1_CH1", "TIM1_TRIG", "TIM1_COM", "ADC1", "DAC1"
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "io_bridges/qemu/stm32/chip_model.hpp"
#include "io_bridges/qemu/stm32/peripheral.hpp"
#include "io_bridges/qemu/stm32/reset_cause.hpp"
#include "io_bridges/qemu/stm32/signal.hpp"

namespace whirl::stm32 {

class Adc;
class BxCan;
class Timer;

// What the function blocks take from the other half of the chip.
struct FunctionBlockHost {
  std::function<double()> rtcclk_Hz;      // RCC_BDCR: RTCSEL's clock while RTCEN, else 0
  std::function<bool()> backup_writable;  // PWR_CR.DBP
  std::function<double()> adcclk_Hz;      // F103 only: RCC_CFGR.ADCPRE; F405 divides PCLK2 itself
  std::function<void(ResetCause)> request_reset;
  std::function<void(int line, bool level)> exti;  // EXTI inputs 17 alarm, 21 stamp, 22 wake-up
  // ADCn_INx, external channels 0..15, asked for at the end of each sampling time.
  std::function<double(int adc, int channel, Nanoseconds t)> adc_volts;
  std::uint64_t seed = 1;  // of RNG
};

class FunctionBlocks {
 public:
  virtual ~FunctionBlocks() = default;

  virtual const std::vector<Region>& regions() const = 0;
  virtual Signal* signal(std::string_view name) = 0;           // null: no such signal
  virtual DmaRequest* dma_request(std::string_view name) = 0;  // null: no such request
  virtual Timer* timer(int number) = 0;                        // null: the part has no such timer
  virtual BxCan* can(int number) = 0;
  virtual Adc* converter(int number) = 0;  // null: the part has no such converter
  // EXTI lines that trigger converters (9: DAC; 11 and 15: ADC): call at each edge that EXTI passes.
  virtual void exti_edge(int line, Nanoseconds now) = 0;
  virtual void reset(ResetCause cause) = 0;  // power_on clears the backup domain too
  virtual void reset_backup_domain() = 0;    // RCC_BDCR.BDRST
  virtual void backup_clock_changed() = 0;   // RTCSEL, RTCEN or LSE/LSI on/off changed
  virtual double dac_volts(int channel) = 0;
  // Told at each change of a channel's volts. False: the part has no such channel.
  virtual bool on_dac(int channel, std::function<void(double volts)> told) = 0;
};

std::unique_ptr<FunctionBlocks> make_f405_function_blocks(const Chip& chip,
                                                          const FunctionBlockHost& host);
std::unique_ptr<FunctionBlocks> make_f103_function_blocks(const Chip& chip,
                                                          const FunctionBlockHost& host);

}  // namespace whirl::stm32
