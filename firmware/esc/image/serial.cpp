#include "firmware/esc/image/serial.hpp"

#include <array>

#include "firmware/esc/image/registers.hpp"
#include "firmware/hal/interrupts.hpp"

namespace fw::esc::serial {
namespace {

using namespace f103;

constexpr std::uint32_t kPclk2_Hz = 72'000'000;

template <std::size_t kSize>
class Ring {  // one writer, one reader; kSize is a power of two
 public:
  bool push(char c) {
    if (free() == 0) return false;
    bytes_[head_++ % kSize] = c;
    return true;
  }
  bool pop(char& c) {
    if (head_ == tail_) return false;
    c = bytes_[tail_++ % kSize];
    return true;
  }
  std::size_t free() const { return kSize - (head_ - tail_); }

 private:
  std::array<char, kSize> bytes_{};
  std::size_t head_ = 0, tail_ = 0;
};

constinit Ring<64> received;
constinit Ring<256> to_send;
constinit std::array<char, 48> line{};
constinit std::size_t line_length = 0;
constinit bool line_spoilt = false;  // too long: dropped as a whole

void on_interrupt() {
  const std::uint32_t sr = USART1::SR::read();
  if ((sr & (USART1::RXNE | USART1::ORE)) != 0) {
    received.push(static_cast<char>(USART1::DR::read()));
  }
  if ((sr & USART1::TXE) != 0 && USART1::CR1::has(USART1::TXEIE)) {
    char c = 0;
    if (to_send.pop(c)) {
      USART1::DR::write(static_cast<std::uint8_t>(c));
    } else {
      USART1::CR1::clear(USART1::TXEIE);
    }
  }
}

}  // namespace

void start() {
  RCC::APB2ENR::set(RCC::USART1EN);
  GPIOA::configure(9, kAlternate);
  GPIOA::configure(10, kInputFloating);
  USART1::BRR::write((kPclk2_Hz + kBaud / 2) / kBaud);
  USART1::CR1::write(USART1::UE | USART1::TE | USART1::RE | USART1::RXNEIE);
  Nvic<Irq::USART1_Global>::enable(kPrioritySerial);
}

std::string_view take_line() {
  char c = 0;
  while (received.pop(c)) {
    if (c == '\r' || c == '\n') {
      const std::string_view done(line.data(), line_spoilt ? 0 : line_length);
      line_length = 0;
      line_spoilt = false;
      if (!done.empty()) return done;
    } else if (line_length < line.size()) {
      line[line_length++] = c;
    } else {
      line_spoilt = true;
    }
  }
  return {};
}

bool put(std::string_view text) {
  const hal::InterruptLock lock;
  if (to_send.free() < text.size()) return false;
  for (const char c : text) to_send.push(c);
  USART1::CR1::set(USART1::TXEIE);
  return true;
}

}  // namespace fw::esc::serial

extern "C" void usart1_handler() {
  fw::esc::serial::on_interrupt();
}
