#include "firmware/pod/spi_slave.hpp"

#include <bit>

#include "firmware/hal/registers.hpp"
#include "firmware/pod/pod_pins.hpp"

#define POD_RAM_CODE __attribute__((section(".ramcode"), noinline, used))

namespace fw::pod {
namespace {

using namespace hw;

constexpr std::uint32_t kAf5 = 5, kSelectLine = 15, kTxChannel = 3;
constexpr std::uint32_t kControl = SPI1::SPE | SPI1::CPOL | SPI1::CPHA;
constexpr std::uint8_t kRead = 0x80;
constexpr std::uint32_t kTxStream =
    Spi1TxDma::channel(kTxChannel) | Spi1TxDma::priority(3) | Spi1TxDma::MINC | Spi1TxDma::DIR_M2P;

struct State {
  const std::uint8_t* answers = nullptr;
  std::uint32_t passed = 0;  // bytes of this transfer, the command's included, as far as seen
  std::uint32_t command = 0, address = 0;
  std::uint32_t next = 0;  // the answer to the byte that passes now, fetched while there was time
  std::array<std::uint8_t, Transfer::kMostWritten> written{};
  SpiCounters counters;
};
constinit State state;

}  // namespace

void start_spi_slave() {
  RCC::AHB1ENR::set(RCC::GPIOAEN | RCC::GPIOBEN | RCC::DMA2EN);
  RCC::APB2ENR::set(RCC::SPI1EN | RCC::SYSCFGEN);
  SlaveSelect::alternate(kAf5, false, hal::Pull::up);
  SlaveSck::alternate(kAf5, false, hal::Pull::none);
  SlaveMiso::alternate(kAf5, false, hal::Pull::none);
  SlaveMosi::alternate(kAf5, false, hal::Pull::none);
  Spi1TxDma::PAR::write(SPI1::DR::address);
  SYSCFG::EXTICR4::replace(0xFu << 12, 0);  // line 15 from port A
  EXTI::RTSR::set(bit(kSelectLine));
  EXTI::PR::write(bit(kSelectLine));
  EXTI::IMR::set(bit(kSelectLine));
  Nvic<Irq::EXTI15_10>::enable(kPriorityParts);
  Nvic<Irq::SPI1_Global>::enable(kPriorityAnswer);
}

bool spi_selected() {
  return !SlaveSelect::level();
}

const SpiCounters& spi_counters() {
  return state.counters;
}

// Only a reset of the block empties DR for certain: what was prepared and not fetched would begin the
// next transfer.
POD_RAM_CODE void arm_spi_slave(const std::uint8_t* answers) {
  Spi1TxDma::CR::write(kTxStream);
  RCC::APB2RSTR::write(RCC::SPI1RST);
  RCC::APB2RSTR::write(0);
  state.answers = answers;
  state.passed = 0;
  Spi1TxDma::IFCR::write(Spi1TxDma::all_flags);
  Spi1TxDma::M0AR::write(std::bit_cast<std::uint32_t>(answers) + (kBurstCommand & 0x7F));
  Spi1TxDma::NDTR::write(kBurstBytes);
  SPI1::CR1::write(kControl);
  SPI1::DR::write(0);  // while the command passes
  Spi1TxDma::CR::write(kTxStream | Spi1TxDma::EN);
  SPI1::CR2::write(SPI1::TXDMAEN | SPI1::RXNEIE);
}

namespace {

// Of the register behind the one that is answered.
[[gnu::always_inline]] inline void fetch_next() {
  state.address = (state.address + 1) & 0x7F;
  state.next = (state.command & kRead) != 0 ? state.answers[state.address] : 0u;
}

// What else there is to a register's command, apart: what it saves to the stack would be saved before the answer.
POD_RAM_CODE void begin_registers(std::uint32_t command) {
  SPI1::CR2::write(SPI1::RXNEIE);
  Spi1TxDma::CR::write(kTxStream);
  state.address = command & 0x7F;
  state.passed = 1;
  state.command = command;
  fetch_next();
}

// The command has passed, and half a period is left until DR moves on: first of all the answer.
[[gnu::always_inline]] inline void answer_command(std::uint32_t command) {
  if (command == kBurstCommand) {
    SPI1::CR2::write(SPI1::TXDMAEN);  // what comes in does not matter
    state.passed = 1;
    state.command = command;
    return;
  }
  const std::uint32_t answer = state.answers[command & 0x7F];
  SPI1::DR::write((command & kRead) != 0 ? answer : 0u);
  __asm volatile("" ::: "memory");  // nothing is moved before it
  begin_registers(command);
}

}  // namespace

// What passed is applied. Its bytes are still in state.written: the next transfer's command takes longer
// to come than this copy.
void finish_transfer(std::uint32_t command, std::uint32_t count) {
  Transfer transfer;
  transfer.written = state.written;
  transfer.burst = command == kBurstCommand;
  transfer.read = (command & kRead) != 0;
  transfer.first = static_cast<std::uint8_t>(command & 0x7F);
  transfer.count = transfer.burst ? kBurstBytes : count;
  if (transfer.burst) ++state.counters.bursts;
  if (!transfer.read && transfer.count > Transfer::kMostWritten) {
    ++state.counters.overflow;
    transfer.count = Transfer::kMostWritten;
  }
  transfer_over(transfer);
}

namespace {

// Apart for the same reason.
POD_RAM_CODE void byte_passed(std::uint32_t in) {
  const std::uint32_t at = state.passed++ - 1;
  if ((state.command & kRead) == 0 && at < Transfer::kMostWritten) {
    state.written[at] = static_cast<std::uint8_t>(in);
  }
  fetch_next();
}

}  // namespace
}  // namespace fw::pod

// The last bit of a byte has been sampled.
extern "C" POD_RAM_CODE void spi1_handler() {
  using namespace fw::pod;
  const std::uint32_t in = fw::hw::SPI1::DR::read();
  if (state.passed == 0) {
    answer_command(in);
  } else {
    fw::hw::SPI1::DR::write(state.next);
    __asm volatile("" ::: "memory");  // nothing is moved before it
    byte_passed(in);
  }
}

// Cleared away first, for the next transfer may be a microsecond and a half away; effects after it.
extern "C" POD_RAM_CODE void exti15_10_handler() {
  using namespace fw::pod;
  using namespace fw::hw;
  EXTI::PR::write(bit(kSelectLine));
  const std::uint32_t command = state.command, passed = state.passed;
  if (spi_selected()) ++state.counters.late_rearm;
  arm_spi_slave(state.answers);
  ++state.counters.transfers;
  if (passed != 0) finish_transfer(command, passed - 1);
}
