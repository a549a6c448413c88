// bxCAN: CAN1 and CAN2 of F405, CAN1 of F103.
//
//   Bus      the arbiter of io_bridges/devices/can_bus.hpp, an own one until wire_to(): arbitration,
//            acknowledges, error frames and counters are there. This is what the registers make of it
//   Bit time of BTR and the APB's clock, handed to the bus when the block leaves initialisation
//   Loop     back (LBKM): a bus of its own, on which it acknowledges itself
//   TSR      TERR and ALST tell of the last attempt, RQCP of the end of the request
//   Source   RM0090 ch. 32
//   Left out TTCM and the time stamps of frames, debug freeze, that a loop-back that is not silent
//            shows on TX
#pragma once
#include <array>
#include <deque>

#include "io_bridges/devices/can_bus.hpp"
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

  io::CanBus& bus() { return *bus_; }
  void wire_to(io::CanBus& bus);  // before it has left initialisation

  const io::CanFrame* offered() override;
  void begun(Nanoseconds now) override;
  void sent(Nanoseconds now) override;
  void receive(const io::CanFrame& frame, Nanoseconds now) override;
  void lost_arbitration(Nanoseconds now) override;
  void failed(io::CanError error, bool sending, Nanoseconds now) override;
  void bus_off(Nanoseconds now) override;
  void joined(Nanoseconds now) override;
  void stirred(Nanoseconds now) override;
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
  bool loops_back() const;
  io::CanStation& station() { return loops_back() ? *loop_station_ : *station_; }
  const io::CanStation& station() const { return loops_back() ? *loop_station_ : *station_; }
  void set_bit_time();
  void leave(int idles);
  int next_mailbox() const;
  void attempt_failed(std::uint32_t why);
  void finish(int mailbox, std::uint32_t outcome);
  void note_levels();
  void abort(int mailbox);
  io::CanFrame frame_of(const Mailbox& mailbox) const;
  void store(const io::CanFrame& frame);
  void update_lines();

  Chip chip_;
  CanConfig config_;
  CanFilters& filters_;
  Signal rx_, tx_;
  io::CanBus own_bus_, loop_;
  io::CanBus* bus_ = &own_bus_;
  io::CanStation *station_, *loop_station_;
  IrqLine tx_irq_, rx0_irq_, rx1_irq_, sce_irq_;

  std::uint32_t mcr_ = 0x00010002, ier_ = 0, btr_ = 0x01230000, lec_ = 0;
  bool init_acknowledged_ = false, sleeping_ = true;
  std::uint32_t msr_flags_ = 0;  // ERRI, WKUI, SLAKI
  std::uint32_t tsr_flags_ = 0;  // RQCP, TXOK, ALST, TERR of each mailbox
  std::uint32_t levels_ = 0;     // EWGF, EPVF and BOFF as they were last
  bool leaving_ = false;         // INAK stays until eleven recessive bits have passed
  std::array<Mailbox, 3> mailbox_{};
  int offered_ = -1, in_flight_ = -1;  // mailboxes; in flight: on the wire or in the arbitration
  io::CanFrame out_;
  bool abort_in_flight_ = false;
  std::uint64_t sequence_ = 0;
  std::array<Fifo, 2> fifo_{};
};

}  // namespace whirl::stm32
