// What a serial line of this host has brought, as far as one turn of a bench's loop may take it.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "base/result.hpp"
#include "io_bridges/serial/tty.hpp"

namespace whirl::bench {

// Hands it to `on_piece` (a span of bytes) in up to eight pieces: who floods a line must not hold the loop.
// Errors  those of Tty::read()
template <typename OnPiece>
Result<Done> read_turn(io::Tty& tty, OnPiece on_piece) {
  constexpr int kMost_pieces = 8;
  std::array<std::uint8_t, 1024> piece;
  for (int i = 0; i < kMost_pieces; ++i) {
    const auto got = tty.read(piece);
    if (!got) return got.error();
    if (got.value() == 0) break;
    on_piece(std::span<const std::uint8_t>(piece).first(got.value()));
  }
  return Done{};
}

}  // namespace whirl::bench
