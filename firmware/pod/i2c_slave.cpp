#include "firmware/pod/i2c_slave.hpp"

#include "firmware/hal/clock.hpp"
#include "firmware/hal/registers.hpp"
#include "firmware/pod/pod_pins.hpp"

namespace fw::pod {

using namespace hw;

struct SensorPort {
  using Block = I2C1;
  using Scl = SensorScl;
  using Sda = SensorSda;
  static constexpr Irq kEvent = Irq::I2C1_EV, kError = Irq::I2C1_ER;
  static constexpr std::uint32_t kEnable = RCC::I2C1EN;
};
struct EscPort12 {
  using Block = I2C2;
  using Scl = EscScl12;
  using Sda = EscSda12;
  static constexpr Irq kEvent = Irq::I2C2_EV, kError = Irq::I2C2_ER;
  static constexpr std::uint32_t kEnable = RCC::I2C2EN;
};
struct EscPort34 {
  using Block = I2C3;
  using Scl = EscScl34;
  using Sda = EscSda34;
  static constexpr Irq kEvent = Irq::I2C3_EV, kError = Irq::I2C3_ER;
  static constexpr std::uint32_t kEnable = RCC::I2C3EN;
};

constinit I2cSlave<SensorPort> sensor_bus;
constinit I2cSlave<EscPort12> esc_bus_12;
constinit I2cSlave<EscPort34> esc_bus_34;

namespace {

constexpr std::uint32_t kAfI2c = 4;

}  // namespace

template <typename Port>
void I2cSlave<Port>::start(I2cPart& first, std::uint8_t first_address, I2cPart& second,
                           std::uint8_t second_address) {
  using Block = typename Port::Block;
  parts_[0] = &first;
  parts_[1] = &second;
  RCC::AHB1ENR::set(RCC::GPIOAEN | RCC::GPIOBEN | RCC::GPIOCEN);
  RCC::APB1ENR::set(Port::kEnable);
  Port::Scl::alternate(kAfI2c, true, hal::Pull::up);
  Port::Sda::alternate(kAfI2c, true, hal::Pull::up);
  Block::CR1::write(Block::SWRST);
  Block::CR1::write(0);
  Block::CR2::write(hal::kPclk1_Hz / 1'000'000 | Block::ITEVTEN | Block::ITERREN);
  Block::OAR1::write(Block::OAR1_KEPT_ONE | static_cast<std::uint32_t>(first_address) << 1);
  Block::OAR2::write(Block::ENDUAL | static_cast<std::uint32_t>(second_address) << 1);
  Block::CR1::write(Block::PE);
  Block::CR1::write(Block::PE | Block::ACK);  // ACK stays 0 while PE is
  Nvic<Port::kEvent>::enable(kPriorityBus);
  Nvic<Port::kError>::enable(kPriorityBus);
}

template <typename Port>
void I2cSlave<Port>::end() {
  if (talking_ != nullptr) talking_->stop();
  talking_ = nullptr;
}

template <typename Port>
void I2cSlave<Port>::addressed(std::uint32_t sr2) {
  using Block = typename Port::Block;
  talking_ = parts_[(sr2 & Block::DUALF) != 0 ? 1 : 0];
  sending_ = (sr2 & Block::TRA) != 0;
  // RXNE interrupts; TXE does not, for it asks for a byte before anybody knows that it is wanted.
  Block::CR2::replace(Block::ITBUFEN, sending_ ? 0 : Block::ITBUFEN);
  talking_->start(sending_);
  if (sending_) Block::DR::write(talking_->read());
}

// In the order in which things happened on the bus, if several are found at once.
template <typename Port>
void I2cSlave<Port>::event() {
  using Block = typename Port::Block;
  const std::uint32_t sr1 = Block::SR1::read();
  if ((sr1 & Block::RXNE) != 0 && talking_ != nullptr) {
    talking_->write(static_cast<std::uint8_t>(Block::DR::read()));
  }
  if ((sr1 & (Block::STOPF | Block::ADDR)) != 0) end();
  const std::uint32_t sr2 = (sr1 & Block::ADDR) != 0 ? Block::SR2::read() : 0;
  if ((sr1 & Block::STOPF) != 0) Block::CR1::write(Block::PE | Block::ACK);
  if ((sr1 & Block::ADDR) != 0) return addressed(sr2);
  if ((sr1 & Block::BTF) != 0 && sending_ && talking_ != nullptr) {
    Block::DR::write(talking_->read());
  }
}

// AF: the master has read enough.
template <typename Port>
void I2cSlave<Port>::error() {
  using Block = typename Port::Block;
  Block::SR1::write(~(Block::AF | Block::BERR | Block::OVR | Block::ARLO) & 0xFFFFu);
  end();
}

template class I2cSlave<SensorPort>;
template class I2cSlave<EscPort12>;
template class I2cSlave<EscPort34>;

}  // namespace fw::pod

extern "C" {
void i2c1_ev_handler() {
  fw::pod::sensor_bus.event();
}
void i2c1_er_handler() {
  fw::pod::sensor_bus.error();
}
void i2c2_ev_handler() {
  fw::pod::esc_bus_12.event();
}
void i2c2_er_handler() {
  fw::pod::esc_bus_12.error();
}
void i2c3_ev_handler() {
  fw::pod::esc_bus_34.event();
}
void i2c3_er_handler() {
  fw::pod::esc_bus_34.error();
}
}
