#include "firmware/hal/spi_master.hpp"

#include <algorithm>
#include <bit>

#include "firmware/hal/interrupts.hpp"
#include "firmware/hal/pins.hpp"
#include "firmware/hal/registers.hpp"
#include "firmware/hal/time_base.hpp"

namespace fw::hal {

using namespace hw;

constinit SpiMaster spi1;

namespace {

constexpr std::uint32_t kAfSpi1 = 5, kDmaChannel = 3, kImuReadyLine = 3;

void init_pins() {
  RCC::AHB1ENR::set(RCC::GPIOAEN | RCC::GPIOBEN | RCC::GPIOCEN | RCC::DMA2EN);
  RCC::APB2ENR::set(RCC::SPI1EN | RCC::SYSCFGEN);
  ImuSelect::output(false, true);
  SpiSck::alternate(kAfSpi1, false, Pull::none);
  SpiMiso::alternate(kAfSpi1, false, Pull::none);
  SpiMosi::alternate(kAfSpi1, false, Pull::none);
  ImuReady::input(Pull::none);
}

void init_data_ready() {
  SYSCFG::EXTICR1::replace(0xFu << 12, 2u << 12);  // line 3 from port C
  EXTI::RTSR::set(bit(kImuReadyLine));
  EXTI::PR::write(bit(kImuReadyLine));
  EXTI::IMR::set(bit(kImuReadyLine));
  Nvic<Irq::EXTI3>::enable(kPriorityImu);
}

}  // namespace

void SpiMaster::init() {
  init_pins();
  SPI1::CR1::write(SPI1::SSM | SPI1::SSI | SPI1::MSTR | SPI1::CPOL | SPI1::CPHA | SPI1::BR_DIV128);
  SPI1::CR2::write(SPI1::RXDMAEN | SPI1::TXDMAEN);
  Spi1RxDma::PAR::write(SPI1::DR::address);
  Spi1TxDma::PAR::write(SPI1::DR::address);
  Spi1RxDma::M0AR::write(std::bit_cast<std::uint32_t>(in_.data()));
  Spi1TxDma::M0AR::write(std::bit_cast<std::uint32_t>(out_.data()));
  Nvic<Irq::DMA2_Stream0>::enable(kPriorityImu);
  init_data_ready();
}

Status SpiMaster::start(std::span<const std::uint8_t> out, bool fast) {
  if (running_ || out.size() > kMaxLength) return Status::busy;
  running_ = true;
  std::copy(out.begin(), out.end(), out_.begin());
  length_ = out.size();
  SPI1::CR1::replace(SPI1::BR_Msk | SPI1::SPE, fast ? SPI1::BR_DIV8 : SPI1::BR_DIV128);
  ImuSelect::set(false);
  Spi1RxDma::IFCR::write(Spi1RxDma::all_flags);
  Spi1TxDma::IFCR::write(Spi1TxDma::all_flags);
  Spi1RxDma::NDTR::write(length_);
  Spi1TxDma::NDTR::write(length_);
  Spi1RxDma::CR::write(Spi1RxDma::channel(kDmaChannel) | Spi1RxDma::priority(3) | Spi1RxDma::MINC |
                       Spi1RxDma::TCIE | Spi1RxDma::TEIE | Spi1RxDma::EN);
  Spi1TxDma::CR::write(Spi1TxDma::channel(kDmaChannel) | Spi1TxDma::priority(2) | Spi1TxDma::MINC |
                       Spi1TxDma::DIR_M2P | Spi1TxDma::EN);
  __asm volatile("dsb" ::: "memory");  // the buffer is in memory before the first byte leaves it
  SPI1::CR1::set(SPI1::SPE);
  return Status::ok;
}

void SpiMaster::finish() {
  ImuSelect::set(true);
  running_ = false;
}

}  // namespace fw::hal

extern "C" void dma2_stream0_handler() {
  fw::hw::Spi1RxDma::IFCR::write(fw::hw::Spi1RxDma::all_flags);
  fw::hal::spi1.finish();
  fw::imu_transfer_done();
}

extern "C" void exti3_handler() {
  fw::hw::EXTI::PR::write(fw::hw::bit(fw::hal::kImuReadyLine));
  fw::hal::restart_tick_guard();
  fw::imu_data_ready();
}
