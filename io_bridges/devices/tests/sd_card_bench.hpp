// An SD card on a bench: a host's bytes on an SPI bus, at the pace of its clock.
#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io_bridges/devices/sd_card.hpp"
#include "io_bridges/devices/spi_bus.hpp"
#include "io_bridges/devices/wire_faults.hpp"

namespace whirl::io {

struct CardBench {
  using Bytes = std::vector<std::uint8_t>;

  EventQueue queue;
  FaultBook faults;
  SpiBus bus{"SPI3"};
  Wire chip_select{"CS"};
  int driver = chip_select.add_driver();
  std::vector<std::string> findings;
  std::uint32_t sck_Hz = 400'000;
  SdCard card;
  SpiWireFaults wire{faults, card, 3, 0};

  explicit CardBench(const SdCard::Params& params = quick(),
                     std::int64_t size_bytes = 64LL * 1024 * 1024)
      : card(queue, params, memory(size_bytes), &faults,
             [this](const Finding& f) { findings.push_back(f.what); }) {
    bus.add(wire, chip_select);
    chip_select.drive(driver, Drive::high, 0);
  }
  static SdCard::Params quick() {  // without stalls
    SdCard::Params params;
    params.stall_every = 0.0;
    params.bus = 3;
    params.device = 0;
    return params;
  }
  static MemoryFile memory(std::int64_t size_bytes) {
    auto file = MemoryFile::create("", size_bytes);
    EXPECT_TRUE(file);
    return std::move(file.value());
  }

  void run_ms(double ms) { queue.run_until(queue.now() + static_cast<Nanoseconds>(ms * 1e6)); }
  void select(bool on) { chip_select.drive(driver, on ? Drive::low : Drive::high, queue.now()); }
  std::uint8_t clock(std::uint8_t mosi = 0xFF) {
    queue.run_until(queue.now() + 8'000'000'000LL / sck_Hz);
    return bus.transfer(mosi, sck_Hz, 0, queue.now());
  }
  Bytes clock(const Bytes& mosi) {
    Bytes miso;
    for (const std::uint8_t byte : mosi) miso.push_back(clock(byte));
    return miso;
  }
  Bytes read_bytes(std::size_t count) { return clock(Bytes(count, 0xFF)); }

  // The six bytes, then R1 and what follows it. Nothing within nine bytes: empty.
  Bytes command(const Bytes& six, std::size_t more = 0) {
    clock(six);
    for (int i = 0; i < 9; ++i) {
      const std::uint8_t r1 = clock();
      if (r1 == 0xFF) continue;
      Bytes response{r1};
      const Bytes rest = read_bytes(more);
      response.insert(response.end(), rest.begin(), rest.end());
      return response;
    }
    return {};
  }
  Bytes at(std::uint8_t index, std::uint32_t argument) {  // with CRC off: any will do
    return {static_cast<std::uint8_t>(0x40 | index),   static_cast<std::uint8_t>(argument >> 24),
            static_cast<std::uint8_t>(argument >> 16), static_cast<std::uint8_t>(argument >> 8),
            static_cast<std::uint8_t>(argument),       0x01};
  }
  void power_up() {
    run_ms(2.0);
    read_bytes(10);
    select(true);
  }
  // True: ready after ACMD41 within a second.
  bool start(bool high_capacity = true) {
    sck_Hz = 400'000;
    select(false);
    power_up();
    if (command({0x40, 0, 0, 0, 0, 0x95}) != Bytes{0x01}) return false;
    if (command({0x48, 0, 0, 0x01, 0xAA, 0x87}, 4) != Bytes{0x01, 0, 0, 0x01, 0xAA}) return false;
    const Nanoseconds until = queue.now() + 1'000'000'000;
    while (queue.now() < until) {
      if (command({0x77, 0, 0, 0, 0, 0x65}) != Bytes{0x01}) return false;
      const Bytes hcs{0x69, 0x40, 0, 0, 0, 0x77}, none{0x69, 0, 0, 0, 0, 0xE5};
      if (command(high_capacity ? hcs : none) == Bytes{0x00}) {
        sck_Hz = 21'000'000;
        return true;
      }
    }
    return false;
  }
  // 0xFE's block without its CRC; nothing: no token within 100 ms, or an error token, in `token`.
  std::optional<Bytes> data(std::size_t length) {
    const Nanoseconds until = queue.now() + 100'000'000;
    do {
      token = clock();
    } while (token == 0xFF && queue.now() < until);
    if (token != 0xFE) return std::nullopt;
    Bytes bytes = read_bytes(length);
    crc = read_bytes(2);
    return bytes;
  }
  std::optional<Bytes> read_block(std::uint32_t address) {
    if (command(at(17, address)) != Bytes{0x00}) return std::nullopt;
    return data(512);
  }
  // A block behind its token; returns the masked data response.
  int send_block(std::uint8_t start, const Bytes& block, int block_crc = 0) {
    clock(start);
    clock(block);
    clock(static_cast<std::uint8_t>(block_crc >> 8));
    clock(static_cast<std::uint8_t>(block_crc & 0xFF));
    return clock() & 0x1F;
  }
  // Nanoseconds until a byte is no longer 0; at most 600 ms.
  Nanoseconds busy() {
    const Nanoseconds from = queue.now();
    while (clock() == 0x00 && queue.now() < from + 600'000'000) {
    }
    return queue.now() - from;
  }
  int write_block(std::uint32_t address, const Bytes& block) {
    if (command(at(24, address)) != Bytes{0x00}) return -1;
    const int response = send_block(0xFE, block);
    busy();
    return response;
  }
  static Bytes filled(std::uint8_t byte) { return Bytes(512, byte); }
  void add(FaultKind kind, double start_ms, double end_ms, double value = 0.0) {
    faults.add({.number = 1,
                .kind = kind,
                .start_ns = static_cast<Nanoseconds>(start_ms * 1e6),
                .end_ns = static_cast<Nanoseconds>(end_ms * 1e6),
                .bus = 3,
                .address = 0,
                .value = value});
  }
  double now_ms() const { return static_cast<double>(queue.now()) * 1e-6; }

  std::uint8_t token = 0;
  Bytes crc;
};

}  // namespace whirl::io
