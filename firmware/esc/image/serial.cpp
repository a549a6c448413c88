#include "firmware/esc/image/serial.hpp"

#include <array>
#include <bit>

#include "firmware/esc/image/registers.hpp"
#include "firmware/hal/interrupts.hpp"

namespace fw::esc::serial {
namespace {

using namespace f103;

constexpr std::uint32_t kPclk2_Hz = 72'000'000;
constexpr std::size_t kReceiveSize = 256, kSendSize = 1024;  // powers of two

constinit std::array<char, kReceiveSize> received{};
constinit std::size_t taken = 0;  // place in `received`

constinit std::array<char, kSendSize> to_send{};
constinit std::size_t head = 0, tail = 0;  // ever queued, ever sent
constinit std::size_t under_way = 0;       // what the DMA has now

constinit std::array<char, 48> line{};
constinit std::size_t line_length = 0;
constinit bool line_spoilt = false;  // too long: dropped as a whole

void send_more() {
  if (under_way != 0 || head == tail) return;
  const std::size_t from = tail % kSendSize;
  under_way = head - tail < kSendSize - from ? head - tail : kSendSize - from;
  SerialOut::CCR::write(0);
  SerialOut::CMAR::write(std::bit_cast<std::uint32_t>(to_send.data() + from));
  SerialOut::CNDTR::write(under_way);
  SerialOut::CCR::write(SerialOut::MINC | SerialOut::DIR | SerialOut::TCIE | SerialOut::EN);
}

void on_sent() {
  DMA1::IFCR::write(SerialOut::CGIF);
  tail += under_way;
  under_way = 0;
  send_more();
}

}  // namespace

void start() {
  RCC::APB2ENR::set(RCC::USART1EN);
  RCC::AHBENR::set(RCC::DMA1EN);
  GPIOA::configure(9, kAlternate);
  GPIOA::configure(10, kInputFloating);
  USART1::BRR::write((kPclk2_Hz + kBaud / 2) / kBaud);
  USART1::CR3::write(USART1::DMAT | USART1::DMAR);
  SerialOut::CPAR::write(USART1::DR::address);
  SerialIn::CPAR::write(USART1::DR::address);
  SerialIn::CMAR::write(std::bit_cast<std::uint32_t>(received.data()));
  SerialIn::CNDTR::write(kReceiveSize);
  SerialIn::CCR::write(SerialIn::MINC | SerialIn::CIRC | SerialIn::EN);
  USART1::CR1::write(USART1::UE | USART1::TE | USART1::RE);
  Nvic<Irq::DMA1_Channel4>::enable(kPrioritySerial);
}

std::string_view take_line() {
  const std::size_t end = (kReceiveSize - SerialIn::CNDTR::read()) % kReceiveSize;
  while (taken != end) {
    const char c = received[taken];
    taken = (taken + 1) % kReceiveSize;
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

bool put(std::string_view bytes) {
  if (kSendSize - (head - tail) < bytes.size()) return false;  // `tail` only makes more room
  for (std::size_t i = 0; i < bytes.size(); ++i) to_send[(head + i) % kSendSize] = bytes[i];
  const hal::InterruptLock lock;
  head += bytes.size();
  send_more();
  return true;
}

}  // namespace fw::esc::serial

extern "C" void dma1_channel4_handler() {
  fw::esc::serial::on_sent();
}
