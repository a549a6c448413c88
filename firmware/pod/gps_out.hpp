// The line of a GPS receiver that the host plays: its bytes go out, what the flight controller tells it comes in.
//
//   Line     USART6 (PC6 TX, PC7 RX), 8N1; 9600 baud until the host says otherwise
//   Time     a piece begins at the microsecond of the pod's clock that it names, or as soon as those before it
//            are out; one that is named for more than a second ahead waits for nothing
//   Baud     changes once all before it has left the line
//   Full     a piece for which there is no room is dropped and counted
#pragma once
#include <array>
#include <cstdint>
#include <span>

namespace fw::pod {

class GpsOut {
 public:
  static constexpr std::size_t kPiece = 44;

  void start();
  void add(std::uint32_t at_us,
           std::span<const std::uint8_t> bytes);  // 0: at once. Pre: at most kPiece
  void add_baud(std::uint32_t baud);
  void poll(std::uint32_t now_us);
  // What the flight controller has told it: kPiece bytes, or what came within 4 ms. Valid until the next call.
  std::span<const std::uint8_t> take_written(std::uint32_t now_us);
  std::uint32_t dropped() const { return dropped_; }

 private:
  struct Piece {
    std::uint32_t at_us = 0, baud = 0;  // baud: it is a change, and no bytes
    std::uint8_t size = 0;
    std::array<std::uint8_t, kPiece> bytes{};
  };
  static constexpr std::size_t kPieces = 16;  // a second of NMEA, or four solutions in UBX

  Piece* next_free();
  bool send(const Piece& piece, std::uint32_t now_us);

  std::array<Piece, kPieces> pieces_{};
  std::size_t first_ = 0, count_ = 0;
  std::array<std::uint8_t, kPiece> written_{};
  std::size_t written_count_ = 0;
  std::uint32_t written_us_ = 0;  // the first of them
  std::uint32_t busy_us_ = 0;     // when the UART's queue was seen filled last
  std::uint32_t character_us_ = 0, dropped_ = 0;
};

extern GpsOut gps_out;

}  // namespace fw::pod
