#include "harness/live/datagram_pieces.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "harness/live/tests/live_tools.hpp"

namespace whirl::live {
namespace {

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

std::vector<Bytes> cut(const Bytes& datagram) {
  std::vector<Bytes> pieces;
  for (const auto piece : pieces_of(datagram)) pieces.emplace_back(piece.begin(), piece.end());
  return pieces;
}

TEST(DatagramPieces, EachFrameOfADatagramIsAPieceOfItsOwn) {
  const Bytes one = heartbeat();
  EXPECT_EQ(cut(joined({one, one, one})), (std::vector<Bytes>{one, one, one}));
  const Bytes old{0xFE, 2, 0, 1, 1, 0, 7, 7, 8, 8};  // version 1: 8 bytes and the payload
  EXPECT_EQ(cut(joined({old, one})), (std::vector<Bytes>{old, one}));
}

TEST(DatagramPieces, ASignedFrameIsLongerByItsSignature) {
  Bytes with = heartbeat();
  with[2] = 1;
  with.resize(with.size() + 13, 0x55);
  EXPECT_EQ(cut(joined({with, heartbeat()})), (std::vector<Bytes>{with, heartbeat()}));
}

TEST(DatagramPieces, WhatIsNoFrameGoesOnInPiecesAndSwallowsNone) {
  const Bytes garbage(100, 0x41), cut_off{0xFD, 200, 0};
  EXPECT_EQ(cut(joined({garbage, heartbeat(), cut_off})),
            (std::vector<Bytes>{Bytes(64, 0x41), Bytes(36, 0x41), heartbeat(), cut_off}));
  EXPECT_TRUE(cut({}).empty());
}

TEST(DatagramPieces, NoByteIsLostOrMoved) {
  RandomStream random(3, "datagram_pieces");
  for (int i = 0; i < 300; ++i) {
    Bytes datagram(static_cast<std::size_t>(random.uniform() * 1500.0));
    for (std::uint8_t& byte : datagram) {
      byte = random.uniform() < 0.1 ? 0xFD : static_cast<std::uint8_t>(random.uniform() * 256.0);
    }
    Bytes together;
    for (const Bytes& piece : cut(datagram)) {
      EXPECT_LE(piece.size(), 280u);
      together.insert(together.end(), piece.begin(), piece.end());
    }
    EXPECT_EQ(together, datagram);
  }
}

}  // namespace
}  // namespace whirl::live
