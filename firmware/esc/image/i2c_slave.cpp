#include "firmware/esc/image/i2c_slave.hpp"

#include <array>
#include <span>

#include "firmware/esc/image/registers.hpp"
#include "firmware/hal/interrupts.hpp"

namespace fw::esc::i2c_slave {
namespace {

using namespace f103;

constexpr std::uint32_t kPclk1_MHz = 36;
constexpr std::uint32_t kStuck_ms = 25;

struct Wire {
  std::uint8_t address = 0;
  std::array<std::uint8_t, 4> received{};
  std::uint8_t received_count = 0;  // saturates at its size: one more than a set-point has
  bool transmitting = false;
  protocol::StatusBytes sending{};
  std::uint8_t sent = 0;
  protocol::Status next;  // prepared by publish()
  std::uint16_t setpoint = 0;
  bool fresh = false;
  bool write_rejected = false;  // since the last read
  std::uint32_t rejected = 0;
  std::uint32_t events = 0, seen_events = 0;
  std::uint32_t idle_ms = 0;  // busy without an event
  std::uint32_t restarts = 0;
};
constinit Wire wire;

void judge_write() {
  const std::span bytes(wire.received.data(), wire.received_count);
  if (protocol::decode_setpoint(wire.address, bytes, wire.setpoint)) {
    wire.fresh = true;
  } else if (wire.received_count > 0) {
    ++wire.rejected;
    wire.write_rejected = true;
  }
  wire.received_count = 0;
}

void begin_status() {
  protocol::Status status = wire.next;
  if (wire.write_rejected) status.flags |= flag_write_rejected;
  wire.write_rejected = false;
  wire.sending = protocol::encode_status(wire.address, status);
  wire.sent = 0;
}

void send_next() {
  const std::uint8_t byte = wire.sent < wire.sending.size() ? wire.sending[wire.sent++] : 0xFF;
  I2C2::DR::write(byte);
}

void on_event() {
  ++wire.events;
  const std::uint32_t sr1 = I2C2::SR1::read();
  if ((sr1 & I2C2::ADDR) != 0) {
    if (!wire.transmitting) judge_write();  // a repeated START ends a write, too
    wire.transmitting = (I2C2::SR2::read() & I2C2::TRA) != 0;
    if (wire.transmitting) begin_status();
  }
  if ((sr1 & I2C2::RXNE) != 0) {
    const auto byte = static_cast<std::uint8_t>(I2C2::DR::read());
    if (wire.received_count < wire.received.size()) wire.received[wire.received_count++] = byte;
  }
  if (wire.transmitting && (I2C2::SR1::read() & I2C2::TXE) != 0) send_next();
  if ((sr1 & I2C2::STOPF) != 0) {
    I2C2::CR1::set(I2C2::PE);  // SR1 has been read: a write to CR1 clears STOPF
    judge_write();
    wire.transmitting = false;
  }
}

void on_error() {
  const std::uint32_t sr1 = I2C2::SR1::read();
  I2C2::SR1::write(~(sr1 & (I2C2::AF | I2C2::BERR | I2C2::ARLO | I2C2::OVR)) & 0xFFFFu);
  if ((sr1 & I2C2::AF) != 0) wire.transmitting = false;  // the master has read enough
  if ((sr1 & (I2C2::BERR | I2C2::ARLO)) != 0) {
    wire.received_count = 0;
    wire.transmitting = false;
  }
}

void set_up() {
  I2C2::CR1::write(I2C2::SWRST);
  I2C2::CR1::write(0);
  I2C2::CR2::write(kPclk1_MHz | I2C2::ITEVTEN | I2C2::ITBUFEN | I2C2::ITERREN);
  I2C2::CCR::write(1u << 15 | 30);  // as a slave only the filters matter; fast mode
  I2C2::TRISE::write(12);
  I2C2::OAR1::write(bit(14) | static_cast<std::uint32_t>(wire.address) << 1);
  I2C2::CR1::write(I2C2::PE);
  I2C2::CR1::write(I2C2::PE | I2C2::ACK);
}

}  // namespace

void start(std::uint8_t address_7bit) {
  wire.address = address_7bit;
  publish({});
  RCC::APB1ENR::set(RCC::I2C2EN);
  GPIOB::configure(10, kAlternateOpenDrain);
  GPIOB::configure(11, kAlternateOpenDrain);
  set_up();
  Nvic<Irq::I2C2_EV>::enable(kPriorityI2c);
  Nvic<Irq::I2C2_ER>::enable(kPriorityI2c);
}

void publish(const protocol::Status& status) {
  const hal::InterruptLock lock;
  wire.next = status;
}

bool take_setpoint(std::uint16_t& v) {
  const hal::InterruptLock lock;
  const bool fresh = wire.fresh;
  v = wire.setpoint;
  wire.fresh = false;
  return fresh;
}

void supervise() {
  const hal::InterruptLock lock;
  const bool quiet = wire.events == wire.seen_events;
  wire.seen_events = wire.events;
  const bool stuck = quiet && (I2C2::SR2::read() & I2C2::BUSY) != 0;
  wire.idle_ms = stuck ? wire.idle_ms + 1 : 0;
  if (wire.idle_ms < kStuck_ms) return;
  wire.idle_ms = 0;
  wire.received_count = 0;
  wire.transmitting = false;
  ++wire.restarts;
  set_up();
}

std::uint32_t restarts() {
  return wire.restarts;
}

std::uint32_t rejected() {
  return wire.rejected;
}

}  // namespace fw::esc::i2c_slave

extern "C" void i2c2_ev_handler() {
  fw::esc::i2c_slave::on_event();
}
extern "C" void i2c2_er_handler() {
  fw::esc::i2c_slave::on_error();
}
