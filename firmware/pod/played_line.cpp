#include "firmware/pod/played_line.hpp"

#include <algorithm>
#include <utility>

#include "firmware/hal/clock.hpp"
#include "firmware/hal/uart_dma.hpp"
#include "firmware/pod/pod_pins.hpp"

namespace fw::hal {

using namespace hw;

struct PodGpsUart : Usart6Port<PriorityLock<kPriorityUart>, pod::GpsTx, pod::GpsRx> {};

struct PodRadioUart {
  using Lock = PriorityLock<kPriorityUart>;
  using Block = USART3;
  using RxDma = Usart3RxDma;
  using TxDma = Usart3TxDma;
  using Tx = pod::RadioTx;
  using Rx = pod::RadioRx;
  static constexpr std::uint32_t kAf = 7, kDmaChannel = 4, kClock_Hz = kPclk1_Hz;
  static constexpr Irq kSent = Irq::DMA1_Stream3;
  static void start_clocks() {
    RCC::AHB1ENR::set(RCC::GPIOCEN | RCC::DMA1EN);
    RCC::APB1ENR::set(RCC::USART3EN);
  }
};

template class UartLink<PodGpsUart>;
template class UartLink<PodRadioUart>;

}  // namespace fw::hal

namespace fw::pod {
namespace {

template <typename Port>
constinit hal::UartLink<Port> line;
constexpr std::uint32_t kFurthest_us = 1'000'000;
// What the UART's queue no longer has is in its two registers still.
constexpr std::uint32_t kIn_registers = 2;

constexpr std::uint32_t character_us(std::uint32_t baud) {
  return 10'000'000 / baud + 1;
}

}  // namespace

constinit PlayedLine<hal::PodGpsUart> gps_out(9600);
constinit PlayedLine<hal::PodRadioUart> radio_out(57600);

template <typename Port>
void PlayedLine<Port>::start() {
  line<Port>.init(baud_);
}

template <typename Port>
auto PlayedLine<Port>::next_free() -> Piece* {
  if (count_ == kPieces) {
    ++dropped_;
    return nullptr;
  }
  return &pieces_[(first_ + count_++) % kPieces];
}

template <typename Port>
void PlayedLine<Port>::add(std::uint32_t at_us, std::span<const std::uint8_t> bytes) {
  Piece* piece = next_free();
  if (piece == nullptr) return;
  piece->at_us = at_us;
  piece->baud = 0;
  piece->size = static_cast<std::uint8_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), piece->bytes.begin());
}

template <typename Port>
void PlayedLine<Port>::add_baud(std::uint32_t baud) {
  constexpr std::uint32_t kLeast = 1200, kMost = Port::kClock_Hz / 16;
  if (baud < kLeast || baud > kMost) return;
  if (Piece* piece = next_free()) {
    piece->at_us = 0;
    piece->baud = baud;
  }
}

template <typename Port>
void PlayedLine<Port>::poll(std::uint32_t now_us) {
  if (line<Port>.waiting() > 0) busy_us_ = now_us;
  if (count_ == 0 || !send(pieces_[first_], now_us)) return;
  first_ = (first_ + 1) % kPieces;
  --count_;
}

// False: not yet.
template <typename Port>
bool PlayedLine<Port>::send(const Piece& piece, std::uint32_t now_us) {
  if (piece.baud != 0) {
    if (now_us - busy_us_ <= kIn_registers * character_us(baud_)) return false;
    line<Port>.set_baud(piece.baud);
    baud_ = piece.baud;
    return true;
  }
  const std::uint32_t ahead_us = piece.at_us - now_us;
  if (piece.at_us != 0 && ahead_us != 0 && ahead_us <= kFurthest_us) return false;
  if (line<Port>.send(std::span(piece.bytes).first(piece.size)) != Status::ok) return false;
  busy_us_ = now_us;
  return true;
}

template <typename Port>
std::span<const std::uint8_t> PlayedLine<Port>::take_written(std::uint32_t now_us) {
  constexpr std::uint32_t kGather_us = 4000;
  const std::size_t n = line<Port>.read(std::span(written_).subspan(written_count_));
  if (written_count_ == 0) written_us_ = now_us;
  written_count_ += n;
  if (written_count_ < kLinePiece && now_us - written_us_ < kGather_us) return {};
  return std::span(written_).first(std::exchange(written_count_, 0));
}

template class PlayedLine<hal::PodGpsUart>;
template class PlayedLine<hal::PodRadioUart>;

}  // namespace fw::pod

extern "C" void dma2_stream6_handler() {
  fw::pod::line<fw::hal::PodGpsUart>.piece_sent();
}

extern "C" void dma1_stream3_handler() {
  fw::pod::line<fw::hal::PodRadioUart>.piece_sent();
}
