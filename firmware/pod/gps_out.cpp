#include "firmware/pod/gps_out.hpp"

#include <algorithm>
#include <utility>

#include "firmware/hal/clock.hpp"
#include "firmware/hal/uart_dma.hpp"
#include "firmware/pod/pod_pins.hpp"

namespace fw::hal {

struct PodGpsUart : Usart6Port<PriorityLock<kPriorityUart>, pod::GpsTx, pod::GpsRx> {};

template class UartLink<PodGpsUart>;

}  // namespace fw::hal

namespace fw::pod {
namespace {

constinit hal::UartLink<hal::PodGpsUart> line;
constexpr std::uint32_t kBaud = 9600, kFurthest_us = 1'000'000;
// What the UART's queue no longer has is in its two registers still.
constexpr std::uint32_t kIn_registers = 2;

constexpr std::uint32_t character_us(std::uint32_t baud) {
  return 10'000'000 / baud + 1;
}

}  // namespace

constinit GpsOut gps_out;

void GpsOut::start() {
  character_us_ = character_us(kBaud);
  line.init(kBaud);
}

GpsOut::Piece* GpsOut::next_free() {
  if (count_ == kPieces) {
    ++dropped_;
    return nullptr;
  }
  return &pieces_[(first_ + count_++) % kPieces];
}

void GpsOut::add(std::uint32_t at_us, std::span<const std::uint8_t> bytes) {
  Piece* piece = next_free();
  if (piece == nullptr) return;
  piece->at_us = at_us;
  piece->baud = 0;
  piece->size = static_cast<std::uint8_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), piece->bytes.begin());
}

void GpsOut::add_baud(std::uint32_t baud) {
  constexpr std::uint32_t kLeast = 1200, kMost = hal::kPclk2_Hz / 16;
  if (baud < kLeast || baud > kMost) return;
  if (Piece* piece = next_free()) {
    piece->at_us = 0;
    piece->baud = baud;
  }
}

void GpsOut::poll(std::uint32_t now_us) {
  if (line.waiting() > 0) busy_us_ = now_us;
  if (count_ == 0 || !send(pieces_[first_], now_us)) return;
  first_ = (first_ + 1) % kPieces;
  --count_;
}

// False: not yet.
bool GpsOut::send(const Piece& piece, std::uint32_t now_us) {
  if (piece.baud != 0) {
    if (now_us - busy_us_ <= kIn_registers * character_us_) return false;
    line.set_baud(piece.baud);
    character_us_ = character_us(piece.baud);
    return true;
  }
  const std::uint32_t ahead_us = piece.at_us - now_us;
  if (piece.at_us != 0 && ahead_us != 0 && ahead_us <= kFurthest_us) return false;
  if (line.send(std::span(piece.bytes).first(piece.size)) != Status::ok) return false;
  busy_us_ = now_us;
  return true;
}

std::span<const std::uint8_t> GpsOut::take_written(std::uint32_t now_us) {
  constexpr std::uint32_t kGather_us = 4000;
  const std::size_t n = line.read(std::span(written_).subspan(written_count_));
  if (written_count_ == 0) written_us_ = now_us;
  written_count_ += n;
  if (written_count_ < kPiece && now_us - written_us_ < kGather_us) return {};
  return std::span(written_).first(std::exchange(written_count_, 0));
}

}  // namespace fw::pod

extern "C" void dma2_stream6_handler() {
  fw::pod::line.piece_sent();
}
