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
  std::uint32_t burst_command = 0, burst_bytes = 0;
  std::uint32_t passed = 0;  // bytes of this transfer, the command's included, as far as seen
  std::uint32_t command = 0, address = 0;
  std::array<std::uint8_t, Transfer::kMostWritten> written{};
  SpiCounters counters;
};
constinit State state;

}  // namespace

void start_spi_slave(std::uint8_t burst_command, std::uint32_t burst_bytes) {
  state.burst_command = burst_command;
  state.burst_bytes = burst_bytes;
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
  Spi1TxDma::M0AR::write(std::bit_cast<std::uint32_t>(answers) + (state.burst_command & 0x7F));
  Spi1TxDma::NDTR::write(state.burst_bytes);
  SPI1::CR1::write(kControl);
  SPI1::DR::write(0);  // while the command passes
  Spi1TxDma::CR::write(kTxStream | Spi1TxDma::EN);
  SPI1::CR2::write(SPI1::TXDMAEN | SPI1::RXNEIE);
}

namespace {

// The command has passed, and half a period is left until DR moves on: first of all the answer.
[[gnu::always_inline]] inline void answer_command(std::uint32_t command) {
  if (command == state.burst_command) {
    SPI1::CR2::write(SPI1::TXDMAEN);  // what comes in does not matter
  } else {
    const std::uint32_t answer = state.answers[command & 0x7F];
    SPI1::DR::write((command & kRead) != 0 ? answer : 0u);
    __asm volatile("" ::: "memory");  // nothing is moved before it
    SPI1::CR2::write(SPI1::RXNEIE);
    Spi1TxDma::CR::write(kTxStream);
    state.address = command & 0x7F;
  }
  state.passed = 1;
  state.command = command;
}

}  // namespace

// What passed is applied. Its bytes are still in state.written: the next transfer's command takes longer
// to come than this copy.
void finish_transfer(std::uint32_t command, std::uint32_t count) {
  Transfer transfer;
  transfer.written = state.written;
  transfer.burst = command == state.burst_command;
  transfer.read = (command & kRead) != 0;
  transfer.first = static_cast<std::uint8_t>(command & 0x7F);
  transfer.count = transfer.burst ? state.burst_bytes : count;
  if (transfer.burst) ++state.counters.bursts;
  if (!transfer.read && transfer.count > Transfer::kMostWritten) {
    ++state.counters.overflow;
    transfer.count = Transfer::kMostWritten;
  }
  transfer_over(transfer);
}

}  // namespace fw::pod

// The last bit of a byte has been sampled.
extern "C" POD_RAM_CODE void spi1_handler() {
  using namespace fw::pod;
  using namespace fw::hw;
  const std::uint32_t in = SPI1::DR::read();
  if (state.passed == 0) return answer_command(in);
  const bool read = (state.command & kRead) != 0;
  state.address = (state.address + 1) & 0x7F;
  SPI1::DR::write(read ? state.answers[state.address] : 0u);
  const std::uint32_t at = state.passed++ - 1;
  if (!read && at < Transfer::kMostWritten) {
    state.written[at] = static_cast<std::uint8_t>(in);
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
