#include "firmware/hal/spi_master.hpp"

#include <bit>

#include "firmware/hal/interrupts.hpp"
#include "firmware/hal/pins.hpp"
#include "firmware/hal/registers.hpp"
#include "firmware/hal/time_base.hpp"

namespace fw::hal {

using namespace hw;

struct ImuBus {
  using Block = SPI1;
  using RxDma = Spi1RxDma;
  using TxDma = Spi1TxDma;
  using Select = ImuSelect;
  using Sck = ImuSck;
  using Miso = ImuMiso;
  using Mosi = ImuMosi;
  static constexpr std::uint32_t kAlternate = 5, kDmaChannel = 3;
  static constexpr std::uint32_t kMode = SPI1::CPOL | SPI1::CPHA;
  static constexpr std::uint32_t kSlow = SPI1::BR_DIV128, kFast = SPI1::BR_DIV8;
  static constexpr std::uint32_t kRxPriority = 3, kTxPriority = 2;
  static constexpr std::uint32_t kAtEnd = RxDma::TCIE | RxDma::TEIE;
  static constexpr Pull kMisoPull = Pull::none;
  static void start_clocks() {
    RCC::AHB1ENR::set(RCC::GPIOAEN | RCC::GPIOBEN | RCC::GPIOCEN | RCC::DMA2EN);
    RCC::APB2ENR::set(RCC::SPI1EN | RCC::SYSCFGEN);
  }
};

struct CardBus {
  using Block = SPI3;
  using RxDma = Spi3RxDma;
  using TxDma = Spi3TxDma;
  using Select = CardSelect;
  using Sck = CardSck;
  using Miso = CardMiso;
  using Mosi = CardMosi;
  static constexpr std::uint32_t kAlternate = 6, kDmaChannel = 0;
  static constexpr std::uint32_t kMode = 0;
  static constexpr std::uint32_t kSlow = SPI3::BR_DIV128, kFast = SPI3::BR_DIV2;
  static constexpr std::uint32_t kRxPriority = 1, kTxPriority = 0;  // the log waits for the others
  static constexpr std::uint32_t kAtEnd = 0;
  static constexpr Pull kMisoPull = Pull::up;  // board 1.6 has no resistor there
  static void start_clocks() {
    RCC::AHB1ENR::set(RCC::GPIOAEN | RCC::GPIOBEN | RCC::GPIOCEN | RCC::DMA1EN);
    RCC::APB1ENR::set(RCC::SPI3EN);
  }
};

constinit SpiMaster<ImuBus> spi1;
constinit SpiMaster<CardBus> spi3;
constinit ImuLink imu_link;

namespace {

template <typename Bus>
constexpr std::uint32_t kControl =
    Bus::Block::SSM | Bus::Block::SSI | Bus::Block::MSTR | Bus::kMode;

}  // namespace

template <typename Bus>
void SpiMaster<Bus>::init() {
  using Block = typename Bus::Block;
  Bus::start_clocks();
  Bus::Select::output(false, true);
  Bus::Sck::alternate(Bus::kAlternate, false, Pull::none);
  Bus::Miso::alternate(Bus::kAlternate, false, Bus::kMisoPull);
  Bus::Mosi::alternate(Bus::kAlternate, false, Pull::none);
  Block::CR1::write(kControl<Bus> | Bus::kSlow);
  Block::CR2::write(Block::RXDMAEN | Block::TXDMAEN);
  Bus::RxDma::PAR::write(Block::DR::address);
  Bus::TxDma::PAR::write(Block::DR::address);
}

template <typename Bus>
void SpiMaster<Bus>::select(bool on) {
  Bus::Select::set(!on);
}

template <typename Bus>
bool SpiMaster<Bus>::done() {
  const bool over = running_ && !Bus::RxDma::CR::has(Bus::RxDma::EN);  // off with the last byte
  if (over) finish();
  return !running_;
}

// A stream whose flags are up must not start: they go down here. One write where both share a register.
template <typename Bus>
void SpiMaster<Bus>::finish() {
  using Rx = typename Bus::RxDma;
  using Tx = typename Bus::TxDma;
  constexpr bool kShared = Rx::IFCR::address == Tx::IFCR::address;
  Rx::IFCR::write(Rx::all_flags | (kShared ? Tx::all_flags : 0));
  if constexpr (!kShared) Tx::IFCR::write(Tx::all_flags);
  running_ = false;
}

template <typename Bus>
Status SpiMaster<Bus>::start(std::span<std::uint8_t> bytes, bool fast) {
  using Block = typename Bus::Block;
  using Rx = typename Bus::RxDma;
  using Tx = typename Bus::TxDma;
  if (!done()) return Status::busy;
  running_ = true;
  const std::uint32_t control = kControl<Bus> | (fast ? Bus::kFast : Bus::kSlow);
  Block::CR1::write(control);  // off while the clock changes
  if (bytes.data() != memory_) {
    memory_ = bytes.data();
    Rx::M0AR::write(std::bit_cast<std::uint32_t>(memory_));
    Tx::M0AR::write(std::bit_cast<std::uint32_t>(memory_));
  }
  Rx::NDTR::write(bytes.size());
  Tx::NDTR::write(bytes.size());
  Rx::CR::write(Rx::channel(Bus::kDmaChannel) | Rx::priority(Bus::kRxPriority) | Rx::MINC |
                Bus::kAtEnd | Rx::EN);
  Tx::CR::write(Tx::channel(Bus::kDmaChannel) | Tx::priority(Bus::kTxPriority) | Tx::MINC |
                Tx::DIR_M2P | Tx::EN);
  __asm volatile("dsb" ::: "memory");  // the buffer is in memory before the first byte leaves it
  Block::CR1::write(control | Block::SPE);
  return Status::ok;
}

template class SpiMaster<ImuBus>;
template class SpiMaster<CardBus>;

// ---- The IMU's

namespace {

constexpr std::uint32_t kImuReadyLine = 3;

void init_data_ready() {
  ImuReady::input(Pull::none);
  SYSCFG::EXTICR1::replace(0xFu << 12, 2u << 12);  // line 3 from port C
  EXTI::RTSR::set(bit(kImuReadyLine));
  EXTI::PR::write(bit(kImuReadyLine));
  EXTI::IMR::set(bit(kImuReadyLine));
  Nvic<Irq::EXTI3>::enable(kPriorityImu);
}

}  // namespace

void ImuLink::init() {
  spi1.init();
  Nvic<Irq::DMA2_Stream0>::enable(kPriorityImu);
  init_data_ready();
}

Status ImuLink::start(std::span<const std::uint8_t> out, bool fast) {
  if (running_ || out.size() > kMaxLength) return Status::busy;
  running_ = true;
  std::copy(out.begin(), out.end(), bytes_.begin());
  length_ = out.size();
  spi1.select(true);
  return spi1.start(std::span(bytes_).first(length_), fast);
}

void ImuLink::finish() {
  spi1.finish();
  spi1.select(false);
  running_ = false;
}

}  // namespace fw::hal

extern "C" void dma2_stream0_handler() {
  fw::hal::imu_link.finish();
  fw::imu_transfer_done();
}

extern "C" void exti3_handler() {
  fw::hw::EXTI::PR::write(fw::hw::bit(fw::hal::kImuReadyLine));
  fw::imu_data_ready();
}
