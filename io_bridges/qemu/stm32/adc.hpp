// ADC1..3 of F405 and ADC1/2 of F103: one converter model, two register dialects, multi modes.
//
//   Time     a conversion starts at the first ADCCLK edge at or after its trigger; the input is
//            asked for at the end of the sampling time; data come 12 (F1: 12.5) clocks later
//   Code     floor(V / VDDA * 4096 + 0.5), held within 0..4095
//   Source   RM0090 ch. 13, RM0008 ch. 11; temperature and reference from the data sheets
//   Left out start-up time after ADON, trigger latency beyond the next clock edge, offset and gain
//            errors (F103 calibration therefore takes its time and changes nothing), noise
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io_bridges/qemu/stm32/irq_line.hpp"
#include "io_bridges/qemu/stm32/peripheral.hpp"
#include "io_bridges/qemu/stm32/tick_grid.hpp"
#include "io_bridges/qemu/stm32/trigger_line.hpp"

namespace whirl::stm32 {

enum class AdcFamily : std::uint8_t { f1, f4 };

struct AdcConfig {
  AdcFamily family = AdcFamily::f4;
  int converters = 3;
  int irq = 18;
  std::function<double()> adcclk_Hz;  // F103: RCC_CFGR.ADCPRE; F405: unused, ADC_CCR divides PCLK2
  // ADCn_INx, n from 1, at the end of the sampling time.
  std::function<double(int adc, int channel, Nanoseconds t)> volts;
  double vdda_V = 3.3;
  double vbat_V = 3.3;
  double temperature_degC = 25.0;
};

class AdcBank;

// One converter and its registers 0x00..0x4C.
class Adc : public Peripheral {
 public:
  Adc(AdcBank& bank, const Chip& chip, int index);

  const char* name() const override { return name_.c_str(); }
  std::uint32_t read(std::uint32_t offset, unsigned size) override;
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override;
  void reset() override;

  // Told at the end of each sequence: when its first conversion began and its last one ended.
  using Sequence = std::function<void(Nanoseconds began, Nanoseconds ended)>;
  void on_sequence(Sequence sink) { sequence_sink_ = std::move(sink); }

  DmaRequest& request() { return request_; }
  std::uint32_t status() const { return sr_; }
  std::uint32_t control() const { return cr1_; }
  bool sensors_on() const;  // F103: TSVREFE sits in ADC1_CR2
  bool interrupting() const;
  void connect_regular(unsigned selection, TriggerLine& line);
  void connect_injected(unsigned selection, TriggerLine& line);

  // For the bank's multi modes. Half clocks of ADCCLK.
  void start_regular(std::int64_t half_clock, std::int64_t repeat_after = 0);
  void start_injected(std::int64_t half_clock);
  void flag_overrun();
  void data_read();
  std::uint32_t data() const { return dr_; }

 private:
  enum class Group : std::uint8_t { none, regular, injected };

  bool f4() const;
  std::uint32_t read_word(std::uint32_t offset);
  void write_word(std::uint32_t offset, std::uint32_t value);
  void write_cr2(std::uint32_t value);
  void write_cr2_f1(std::uint32_t value, std::uint32_t before);
  void select_triggers();
  void trigger_edge(bool injected, bool level);

  unsigned regular_length() const;
  unsigned injected_length() const;
  unsigned regular_channel(unsigned rank) const;
  unsigned injected_channel(unsigned rank) const;
  std::int64_t sampling_half_clocks(unsigned channel) const;
  std::int64_t conversion_half_clocks() const;
  unsigned bits() const;

  void begin(Group group, std::int64_t half_clock);
  void step();
  void sample();
  void finish();
  void finish_regular(std::int64_t at);
  void finish_injected(std::int64_t at);
  void sequence_over(std::int64_t at);
  void injected_over(std::int64_t at);
  void tell_sequence(std::int64_t began, std::int64_t ended);
  void store_regular(std::uint32_t code, bool last);
  void watch_window(std::uint32_t code, bool injected);
  std::uint32_t align(std::int32_t value, bool injected) const;
  void stop();

  AdcBank& bank_;
  Chip chip_;
  std::string name_;
  int index_;
  io::Event event_, calibration_;
  DmaRequest request_;

  std::uint32_t sr_ = 0, cr1_ = 0, cr2_ = 0, htr_ = 0xFFF, ltr_ = 0, jsqr_ = 0, dr_ = 0;
  std::array<std::uint32_t, 2> smpr_{};
  std::array<std::uint32_t, 3> sqr_{};
  std::array<std::uint32_t, 4> jofr_{}, jdr_{};

  Group active_ = Group::none;
  unsigned rank_ = 0, injected_rank_ = 0;
  unsigned left_in_part_ = 0;     // conversions until a discontinuous group ends
  bool regular_waiting_ = false;  // interrupted by, or triggered during, an injected group
  bool automatic_ = false;        // the injected group runs by JAUTO
  bool sampled_ = false;
  bool last_transfer_done_ = false;  // DDS = 0: no further requests
  unsigned channel_ = 0;
  std::int64_t start_ = 0, repeat_after_ = 0;
  std::int64_t regular_began_ = 0, injected_began_ = 0;
  Sequence sequence_sink_;
  std::uint32_t code_ = 0;

  struct Tap {
    TriggerLine* line = nullptr;
    int handle = 0;
  };
  std::array<Tap, 16> regular_taps_{}, injected_taps_{};
};

// The converters of a part with what they share: clock, interrupt, common registers, multi modes.
class AdcBank {
 public:
  AdcBank(const Chip& chip, AdcConfig config);

  Adc& converter(int number) { return *converters_[static_cast<std::size_t>(number - 1)]; }
  Adc* find(int number) {  // null: there is none of that number
    return number >= 1 && number <= config_.converters ? &converter(number) : nullptr;
  }
  int converters() const { return config_.converters; }
  AdcFamily family() const { return config_.family; }
  void connect_regular(unsigned selection, TriggerLine& line);
  void connect_injected(unsigned selection, TriggerLine& line);
  void reset();

  // F405: the common registers at 0x300.
  std::uint32_t read_common(std::uint32_t offset);
  void write_common(std::uint32_t offset, std::uint32_t value);

  // For the converters.
  TickGrid& grid() { return grid_; }
  std::int64_t next_half_clock();
  void update_clock();
  void update_interrupt();
  void trigger_regular(int index);
  void trigger_injected(int index);
  double volts(int index, unsigned channel) const;
  double vdda_V() const { return config_.vdda_V; }
  bool packs_data() const;  // data leave through CDR (F405) instead of each DR
  void regular_data(int index, std::uint32_t value);
  std::uint32_t upper_data(int index) const;  // F103 dual mode: ADC2's data in ADC1_DR[31:16]
  void transfers_done();

 private:
  int partners() const;  // converters that the multi mode joins; 1: independent
  unsigned multi() const;
  bool regular_together() const;
  bool injected_together() const;
  bool alternating() const;
  std::int64_t interleave_half_clocks() const;
  bool interleaved() const;
  std::uint32_t read_cdr();
  void pack();
  void request_packed();
  unsigned packing() const;

  Chip chip_;
  AdcConfig config_;
  TickGrid grid_;
  std::vector<std::unique_ptr<Adc>> converters_;
  IrqLine irq_;
  std::uint32_t ccr_ = 0;
  std::array<std::uint32_t, 3> latest_{};
  unsigned fresh_ = 0;                 // converters whose part of the current set is there
  std::vector<std::uint32_t> stream_;  // data in the order of the converters, not yet packed
  std::deque<std::uint32_t> packed_;
  bool last_transfer_done_ = false;
  int alternate_ = 0;
};

// F405 maps all three and the common registers as one block.
class AdcF4Block : public Peripheral {
 public:
  explicit AdcF4Block(AdcBank& bank) : bank_(bank) {}
  const char* name() const override { return "ADC"; }
  std::uint32_t read(std::uint32_t offset, unsigned size) override;
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override;
  void reset() override { bank_.reset(); }

 private:
  AdcBank& bank_;
};

}  // namespace whirl::stm32
