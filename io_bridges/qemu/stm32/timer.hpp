// TIM1..TIM14: one model with a table of abilities (timer_config.hpp).
//
//   Counting   is computed from virtual time when somebody looks; an event is set only for what
//              somebody waits for (interrupt, DMA, trigger, routed pin, observer)
//   Shadows    PSC, ARR (ARPE), CCRx (OCxPE), CCxE/OCxM (CCPC) act at the update or COM event
//   Time       edges of the timer clock as TickGrid has them; CNT is exact at every read
//   Source     RM0090 ch. 17 to 20
//   Left out   fast enable (OCxFE), OCxCE clearing by ETR, synchronisation delay of trigger inputs
//              (2-3 clocks), DBGMCU freeze, dead-time insertion on the off edges of a break
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "io_bridges/qemu/stm32/irq_line.hpp"
#include "io_bridges/qemu/stm32/peripheral.hpp"
#include "io_bridges/qemu/stm32/pwm_pattern.hpp"
#include "io_bridges/qemu/stm32/signal.hpp"
#include "io_bridges/qemu/stm32/tick_grid.hpp"
#include "io_bridges/qemu/stm32/timer_config.hpp"
#include "io_bridges/qemu/stm32/trigger_line.hpp"

namespace whirl::stm32 {

class Timer : public Peripheral {
 public:
  Timer(const Chip& chip, const TimerConfig& config);
  ~Timer() override;

  const char* name() const override { return name_.c_str(); }
  std::uint32_t read(std::uint32_t offset, unsigned size) override;
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override;
  void reset() override;

  int number() const { return config_.number; }
  int channels() const { return can_.channels; }
  bool is_advanced() const { return can_.advanced; }

  // Pins. Channels count from 1.
  Signal& pin(int channel) { return *pins_[static_cast<std::size_t>(channel - 1)]; }
  Signal& pin_n(int channel) { return *pins_n_[static_cast<std::size_t>(channel - 1)]; }
  Signal& etr() { return etr_; }
  Signal& break_in() { return break_; }
  // What OCx (or OCxN) does to its pin right now, exact also while no pin is routed.
  Drive output(int channel, bool complementary);

  // Lines inside the chip.
  TriggerLine& trgo() { return trgo_; }
  TriggerLine& compare(int channel) { return compare_[static_cast<std::size_t>(channel - 1)]; }
  void connect_itr(int n, TriggerLine& master);

  DmaRequest& update_request() { return dma_[0]; }
  DmaRequest& compare_request(int channel) { return dma_[static_cast<std::size_t>(channel)]; }
  DmaRequest& com_request() { return dma_[5]; }
  DmaRequest& trigger_request() { return dma_[6]; }

  void observe_pwm(std::function<void(const PwmPattern&)> observer);
  PwmPattern pwm_pattern();

 private:
  static constexpr int kUpdate = 0, kCom = 5, kTrigger = 6;  // of dma_; compare channels between
  static constexpr std::size_t kRequests = 7;

  struct Channel {
    std::uint32_t ccr = 0;     // as read and written
    std::uint32_t shadow = 0;  // as compared
    bool ref = false;          // OCxREF
    bool dead = false;         // within the dead time: neither output is active
    unsigned captures = 0;     // edges seen since the last capture (ICxPSC)
  };
  struct Input {  // TI1..TI4 behind the filter
    bool raw = false;
    bool level = false;
    std::unique_ptr<io::Event> filter;
  };

  // timer.cpp: registers
  std::uint32_t read_word(std::uint32_t offset);
  void write_word(std::uint32_t offset, std::uint32_t value);
  void write_control(std::uint32_t offset, std::uint32_t value);
  void write_count(std::uint32_t offset, std::uint32_t value);
  void write_cr1(std::uint32_t value);
  void write_ccr(int ch, std::uint32_t value);
  void write_ccmr(int half, std::uint32_t value);
  void write_ccer(std::uint32_t value);
  void write_bdtr(std::uint32_t value);
  void generate(std::uint32_t egr);
  std::uint32_t burst_register();
  void burst_step();

  // timer_count.cpp: the counter
  bool counts_clock() const;
  bool centre() const { return cms() != 0 && !encoder(); }
  unsigned cms() const { return (cr1_ >> 5) & 3; }
  unsigned slave_mode() const { return smcr_ & 7; }
  bool encoder() const { return slave_mode() >= 1 && slave_mode() <= 3; }
  bool blocked() const { return arr_shadow_ == 0 && !encoder(); }
  std::uint32_t max_count() const { return can_.wide ? 0xFFFFFFFFu : 0xFFFFu; }
  void sync();
  void advance(std::int64_t now_tick);
  void step_once();  // an edge of an external clock or an encoder
  void enable();
  void normalise_direction();
  void land();
  std::int64_t matches_per_period(int ch) const;
  std::int64_t steps_to_turn() const;
  void run(std::int64_t steps);
  void turn();
  void skip_equal_periods(std::int64_t now_tick);
  bool shadows_settled() const;
  void repeat_or_update();
  void update_event(bool from_overflow);
  void restart_count();
  void load_shadows();
  void match(int ch, bool flagged);
  bool is_output(int ch) const { return (ccmr(ch) & 3) == 0; }
  std::uint32_t ccmr(int ch) const { return (ccmr_[ch / 2] >> (8 * (ch & 1))) & 0xFF; }
  std::uint32_t active_ccmr(int ch) const {
    return (active_ccmr_[ch / 2] >> (8 * (ch & 1))) & 0xFF;
  }
  unsigned output_mode(int ch) const { return (active_ccmr(ch) >> 4) & 7; }
  std::int64_t divider() const { return static_cast<std::int64_t>(psc_shadow_) + 1; }

  // timer_schedule.cpp: who waits for what
  void settle();
  void schedule();
  std::int64_t steps_to_match(int ch) const;
  bool turn_wanted() const;
  bool match_wanted(int ch) const;
  bool level_wanted(int ch) const;
  void flush();
  void set_interrupts();
  void raise(int request) { raised_ |= 1u << request; }
  void raise_requests();
  void request_served(int request);
  void clock_changed();

  // timer_input.cpp: capture, slave mode, triggers
  Nanoseconds behind_synchroniser() const;
  void hear_later(unsigned source, bool level);
  void hear_late_edges();
  void raw_changed(int ti);
  void set_trigger_flag();
  void capture_on_trc();
  bool captures_trc() const;
  Nanoseconds filter_time_ns(int ti) const;
  void filtered_edge(int ti);
  void capture(int ch);
  bool edge_counts(int ch, bool level) const;
  bool polarised(int ti, int ch, bool level) const;
  void trigger_edge(bool level);
  void trigger_source_edge(unsigned source, bool level);
  void external_clock_edge();
  void encoder_edge(int ti);
  void etr_changed(bool level);
  void break_changed();
  void break_now();
  void select_trigger();
  bool trigger_level() const;
  bool break_active() const;

  // timer_output.cpp: OCxREF, pins, the observer
  void refresh_reference(int ch);
  bool pwm_reference(int ch) const;
  void refresh_outputs();
  void drive_pins(int ch);
  Drive output_now(int ch, bool complementary) const;
  Drive idle_output(int ch, bool complementary) const;
  std::int64_t dead_ticks() const;
  void reference_changed(int ch);
  unsigned master_mode() const { return can_.master ? (cr2_ >> 4) & 7 : 8; }
  void com_event();
  void follow_writes();
  void set_master_line();
  void notify_observer();
  PwmChannel pwm_channel(int ch) const;

  Chip chip_;
  TimerConfig config_;
  TimerAbilities can_;
  std::string name_;
  TickGrid grid_;
  io::Event event_;

  std::uint32_t cr1_ = 0, cr2_ = 0, smcr_ = 0, dier_ = 0, sr_ = 0, ccer_ = 0, active_ccer_ = 0;
  std::array<std::uint32_t, 2> ccmr_{}, active_ccmr_{};
  std::uint32_t psc_ = 0, arr_ = 0, rcr_ = 0, bdtr_ = 0, dcr_ = 0, or_ = 0;
  std::uint32_t psc_shadow_ = 0, arr_shadow_ = 0, repetitions_ = 0;
  std::array<Channel, 4> channel_{};

  std::uint32_t cnt_ = 0;
  bool down_ = false;
  std::int64_t psc_count_ = 0;  // clock edges since the last step, at anchor_
  std::int64_t anchor_ = 0;     // clock edge at which cnt_ and psc_count_ hold
  std::int64_t turns_ = 0;      // since the shadows last changed
  bool gate_ = false;
  bool flushing_ = false, settling_ = false;

  std::array<Input, 4> input_{};
  bool etr_level_ = false;
  unsigned etr_edges_ = 0;

  std::array<std::unique_ptr<Signal>, 4> pins_, pins_n_;
  Signal etr_, break_;
  TriggerLine trgo_;
  std::array<TriggerLine, 4> compare_;
  std::array<TriggerLine*, 4> itr_{};
  std::array<int, 4> itr_handle_{};
  static constexpr int kSynchroniser_clocks = 3;
  std::vector<std::pair<unsigned, bool>> late_edges_;  // trigger source, level
  io::Event resynchronised_;
  std::array<std::unique_ptr<io::Event>, 4> dead_time_;

  std::array<DmaRequest, kRequests> dma_;
  std::uint32_t raised_ = 0;
  std::uint32_t burst_index_ = 0;
  bool burst_touched_ = false;
  std::uint32_t pulses_ = 0;  // of trgo_, due when the state is consistent

  IrqLine update_irq_, compare_irq_, trigger_irq_, break_irq_;
  std::function<void(const PwmPattern&)> observer_;
  PwmPattern told_;
  bool pattern_dirty_ = false;
  bool phase_changed_ = true;  // the period's start is no longer where the observer was told
};

}  // namespace whirl::stm32
