// The card driver on a simulated card: an SPI bus whose bytes take their time.
#pragma once
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "firmware/drivers/sd_card.hpp"
#include "io_bridges/devices/sd_card.hpp"
#include "io_bridges/devices/spi_bus.hpp"
#include "io_bridges/devices/wire_faults.hpp"

namespace fw {

namespace io = whirl::io;

struct CardRig {
  // The bus as the driver sees it: each exchange is over when start() returns.
  struct Bus {
    CardRig& rig;
    void select(bool on) {
      rig.chip_select.drive(rig.driver_pin, on ? io::Drive::low : io::Drive::high, rig.queue.now());
    }
    Status start(std::span<std::uint8_t> bytes, bool fast) {
      if (bytes.size() == 20 && bytes[1] != 0xFF) ++rig.commands[bytes[1] & 0x3F];
      const std::uint32_t sck_Hz = fast ? 21'000'000 : 328'125;
      for (std::uint8_t& byte : bytes) {
        rig.queue.run_until(rig.queue.now() + 8'000'000'000LL / sck_Hz);
        byte = rig.spi.transfer(byte, sck_Hz, 0, rig.queue.now());
      }
      rig.moved += bytes.size();
      return Status::ok;
    }
    bool done() const { return true; }
  };

  static io::SdCard::Params quick() {
    io::SdCard::Params params;
    params.stall_every = 0.0;
    params.bus = 3;
    params.device = 0;
    return params;
  }
  static io::MemoryFile memory(std::int64_t size_bytes) {
    auto file = io::MemoryFile::create("", size_bytes);
    EXPECT_TRUE(file);
    return std::move(file.value());
  }

  explicit CardRig(const io::SdCard::Params& params = quick(),
                   io::MemoryFile contents = memory(64 << 20))
      : part(queue, params, std::move(contents), &faults,
             [this](const io::Finding& f) { findings.push_back(f.what); }) {
    spi.add(wire, chip_select);
    chip_select.drive(driver_pin, io::Drive::high, 0);
  }

  std::uint32_t now_us() const { return static_cast<std::uint32_t>(queue.now() / 1000); }
  double now_ms() const { return static_cast<double>(queue.now()) * 1e-6; }
  void tick() {
    queue.run_until(queue.now() + 100'000);
    moved = 0;
    card.tick(now_us());
    most_moved = std::max(most_moved, moved);
  }
  bool until_ready(double limit_ms) {
    const double end_ms = now_ms() + limit_ms;
    while (!card.ready() && now_ms() < end_ms) tick();
    return card.ready();
  }
  Status until_done(Status begun) {
    if (begun != Status::ok) return begun;
    for (int i = 0; card.busy() && i < 200'000; ++i) tick();
    return card.result();
  }
  void add(io::FaultKind kind, double start_ms, double end_ms, double value = 0.0) {
    faults.add({.number = 1,
                .kind = kind,
                .start_ns = static_cast<io::Nanoseconds>(start_ms * 1e6),
                .end_ns = end_ms < 0.0 ? io::kNever : static_cast<io::Nanoseconds>(end_ms * 1e6),
                .bus = 3,
                .address = 0,
                .value = value});
  }

  io::EventQueue queue;
  io::FaultBook faults;
  io::SpiBus spi{"SPI3"};
  io::Wire chip_select{"CS"};
  int driver_pin = chip_select.add_driver();
  std::vector<std::string> findings;
  io::SdCard part;
  io::SpiWireFaults wire{faults, part, 3, 0};
  Bus bus{*this};
  SdCard<Bus> card{bus};
  std::map<int, int> commands;            // sent so far, by index
  std::size_t moved = 0, most_moved = 0;  // bytes in a tick
};

}  // namespace fw
