// A line at whose other end the host plays a device: its bytes go out, what the flight controller tells it comes in.
//
//   Lines    gps_out: a GPS, USART6 (PC6 TX, PC7 RX), 9600 baud. radio_out: a telemetry radio, USART3 (PC10 TX,
//            PC11 RX), 57600 baud. Both 8N1, at that rate until the host says otherwise
//   Time     a piece begins at the microsecond of the pod's clock that it names, or as soon as those before it
//            are out; one that is named for more than a second ahead waits for nothing
//   Baud     changes once all before it has left the line
//   Full     a piece for which there is no room is dropped and counted
#pragma once
#include <array>
#include <cstdint>
#include <span>

namespace fw::hal {

struct PodGpsUart;
struct PodRadioUart;

}  // namespace fw::hal

namespace fw::pod {

inline constexpr std::size_t kLinePiece = 44;

// Port: of its UART (hal/uart_link.hpp).
template <typename Port>
class PlayedLine {
 public:
  explicit constexpr PlayedLine(std::uint32_t baud) : baud_(baud) {}

  void start();
  void add(std::uint32_t at_us,
           std::span<const std::uint8_t> bytes);  // 0: at once. Pre: at most kLinePiece
  void add_baud(std::uint32_t baud);
  void poll(std::uint32_t now_us);
  // What the flight controller has told it: kLinePiece bytes, or what came within 4 ms. Valid until the next call.
  std::span<const std::uint8_t> take_written(std::uint32_t now_us);
  std::uint32_t dropped() const { return dropped_; }

 private:
  struct Piece {
    std::uint32_t at_us = 0, baud = 0;  // baud: it is a change, and no bytes
    std::uint8_t size = 0;
    std::array<std::uint8_t, kLinePiece> bytes{};
  };
  static constexpr std::size_t kPieces = 16;  // a second of NMEA, or four solutions in UBX

  Piece* next_free();
  bool send(const Piece& piece, std::uint32_t now_us);

  std::uint32_t baud_;
  std::array<Piece, kPieces> pieces_{};
  std::size_t first_ = 0, count_ = 0;
  std::array<std::uint8_t, kLinePiece> written_{};
  std::size_t written_count_ = 0;
  std::uint32_t written_us_ = 0;  // the first of them
  std::uint32_t busy_us_ = 0;     // when the UART's queue was seen filled last
  std::uint32_t dropped_ = 0;
};

extern PlayedLine<hal::PodGpsUart> gps_out;
extern PlayedLine<hal::PodRadioUart> radio_out;

}  // namespace fw::pod
