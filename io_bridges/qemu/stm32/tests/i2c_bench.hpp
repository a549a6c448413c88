// I2C1 of an F405 at 400 kHz on PB8, PB9, with a register file at 0x50 on the bus.
#pragma once
#include "io_bridges/qemu/stm32/tests/chip_bench.hpp"

namespace whirl::stm32 {

inline constexpr std::uint32_t kI2c = 0x40005400;
inline constexpr std::uint32_t kCr1 = kI2c, kCr2 = kI2c + 4, kOar1 = kI2c + 8, kOar2 = kI2c + 0xC,
                               kDr = kI2c + 0x10, kSr1 = kI2c + 0x14, kSr2 = kI2c + 0x18,
                               kCcr = kI2c + 0x1C, kTrise = kI2c + 0x20;
inline constexpr std::uint32_t SB = 1, ADDR = 2, BTF = 4, STOPF = 16, RXNE = 64, TXE = 128,
                               AF = 1024, OVR = 2048, ARLO = 512;
inline constexpr std::uint32_t START = 256, STOP = 512, ACK = 1024, POS = 2048;
inline constexpr Nanoseconds kBit_ns = 2500;

// Writes go to the register that the first byte names; reads count up from there.
struct RegisterFile : io::I2cTarget {
  bool answers(std::uint8_t a) const override { return a == 0x50; }
  bool start(std::uint8_t, bool read, Nanoseconds now) override {
    log += read ? 'R' : 'W';
    first = !read;
    started_at = now;
    return true;
  }
  bool write(std::uint8_t byte, Nanoseconds now) override {
    byte_at.push_back(now);
    if (written == refuse_at) return false;
    ++written;
    if (first) {
      pointer = byte;
    } else {
      bytes[pointer++] = byte;
    }
    first = false;
    return true;
  }
  std::uint8_t read(Nanoseconds now) override {
    fetched_at.push_back(now);
    return bytes[pointer++];
  }
  void acked(bool ack, Nanoseconds) override { log += ack ? 'a' : 'n'; }
  void stop(Nanoseconds now) override {
    log += 'P';
    stopped_at = now;
  }

  std::array<std::uint8_t, 256> bytes{};
  std::uint8_t pointer = 0;
  bool first = false;
  int written = 0, refuse_at = -1;
  std::string log;  // R W addressed, a n answers of the master, P stop
  Nanoseconds started_at = 0, stopped_at = 0;
  std::vector<Nanoseconds> byte_at, fetched_at;
};

struct I2cBench : ChipBench {
  I2cBench() {
    clock_168();
    set_bits(0x40023840, 1u << 21);
    mux('B', 8, 4, true);
    mux('B', 9, 4, true);
    put(kCr2, 42);
    put(kCcr, 0x8000 | 35);  // 3 x 35 / 42 MHz = 2500 ns
    put(kTrise, 13);
    put(kCr1, 1);
    for (int i = 0; i < 256; ++i)
      file.bytes[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(i);
    bus().add(file);
  }
  io::I2cBus& bus() { return *chip().i2c(1); }

  void start_and_address(std::uint8_t address_byte) {
    set_bits(kCr1, START);
    wait(kSr1, SB, SB);
    put(kDr, address_byte);
  }
  void clear_addr() {
    wait(kSr1, ADDR, ADDR);
    get(kSr2);
  }
  void point_at(std::uint8_t reg) {  // START, address, register number; TXE is up
    start_and_address(0xA0);
    clear_addr();
    wait(kSr1, TXE, TXE);
    put(kDr, reg);
    wait(kSr1, TXE, TXE);
  }
  std::uint8_t received() {
    wait(kSr1, RXNE, RXNE);
    return static_cast<std::uint8_t>(get(kDr));
  }

  RegisterFile file;
};

}  // namespace whirl::stm32
