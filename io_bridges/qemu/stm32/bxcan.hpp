// bxCAN: CAN1 and CAN2 of F405, CAN1 of F103.
//
//   Time     a frame takes its bits (stuffing included) at the bit time of BTR; it arrives at the
//            other nodes, and TXOK is set, when its last bit has passed
//   Bus      join() names the other nodes; any of them acknowledges. Without one a frame is an
//            acknowledge error: TEC rises by 8 up to error passive, and the frame is sent again
//            until aborted, unless NART
//   Source   RM0090 ch. 32
//   Left out arbitration against frames that others send at the same time, bus-off and bit errors,
//            TTCM transmission of time stamps, debug freeze
#pragma once
#include <array>
#include <deque>
#include <functional>
#include <vector>

#include "io_bridges/devices/bus.hpp"
#include "io_bridges/qemu/stm32/can_filters.hpp"
#include "io_bridges/qemu/stm32/irq_line.hpp"
#include "io_bridges/qemu/stm32/peripheral.hpp"
#include "io_bridges/qemu/stm32/signal.hpp"

namespace whirl::stm32 {

struct CanConfig {
  int number = 1;
  int tx_irq = 19, rx0_irq = 20, rx1_irq = 21, sce_irq = 22;
};

class BxCan : public Peripheral, public io::CanNode {
 public:
  BxCan(const Chip& chip, const CanConfig& config, CanFilters& filters);

  const char* name() const override { return config_.number == 1 ? "CAN1" : "CAN2"; }
  std::uint32_t read(std::uint32_t offset, unsigned size) override;
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override;
  void reset() override;

  void join(io::CanNode& other) { others_.push_back(&other); }
  void receive(const io::CanFrame& frame, Nanoseconds now) override;
  double bit_time_s() const;
  Signal& rx() { return rx_; }
  Signal& tx() { return tx_; }

 private:
  struct Mailbox {
    std::array<std::uint32_t, 4> word{};  // TIR, TDTR, TDLR, TDHR
    bool pending = false;
    std::uint64_t order = 0;
  };
  struct Received {
    std::array<std::uint32_t, 4> word{};
  };
  struct Fifo {
    std::deque<Received> frames;
    bool full = false, overrun = false;
  };

  std::uint32_t read_word(std::uint32_t offset);
  void write_word(std::uint32_t offset, std::uint32_t value);
  void write_mcr(std::uint32_t value);
  void write_tsr(std::uint32_t value);
  void write_mailbox(std::uint32_t offset, std::uint32_t value);
  void enter_or_leave();
  std::uint32_t msr() const;
  std::uint32_t tsr() const;
  std::uint32_t esr() const;
  std::uint32_t fifo_register(int n) const;
  void release(int fifo);

  bool initialising() const { return init_acknowledged_; }
  int next_mailbox() const;
  void try_transmit();
  void transmitted();
  void finish(int mailbox, bool ok, bool error);
  void abort(int mailbox);
  io::CanFrame frame_of(const Mailbox& mailbox) const;
  void store(const io::CanFrame& frame);
  void update_lines();

  Chip chip_;
  CanConfig config_;
  CanFilters& filters_;
  std::vector<io::CanNode*> others_;
  Signal rx_, tx_;
  io::Event sending_, leaving_;
  IrqLine tx_irq_, rx0_irq_, rx1_irq_, sce_irq_;

  std::uint32_t mcr_ = 0x00010002, ier_ = 0, btr_ = 0x01230000, lec_ = 0;
  bool init_acknowledged_ = false, sleeping_ = true;
  std::uint32_t msr_flags_ = 0;  // ERRI, WKUI, SLAKI
  std::uint32_t tsr_flags_ = 0;  // RQCP, TXOK, ALST, TERR of each mailbox
  std::uint32_t tec_ = 0, rec_ = 0;
  std::array<Mailbox, 3> mailbox_{};
  int in_flight_ = -1;
  bool abort_in_flight_ = false;
  std::uint64_t sequence_ = 0;
  std::array<Fifo, 2> fifo_{};
};

}  // namespace whirl::stm32
