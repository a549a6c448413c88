#include "io_bridges/qemu/stm32/dma_f1.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::stm32 {
namespace {

constexpr std::uint32_t EN = 1u << 0, TCIE = 1u << 1, HTIE = 1u << 2, TEIE = 1u << 3, DIR = 1u << 4,
                        CIRC = 1u << 5, PINC = 1u << 6, MINC = 1u << 7, MEM2MEM = 1u << 14;
constexpr std::uint32_t GIF = 1, TCIF = 2, HTIF = 4, TEIF = 8;
constexpr int kBurst = 16, kCyclesPerBurst = 8 * kBurst;

unsigned peripheral_size(std::uint32_t ccr) {
  return 1u << std::min((ccr >> 8) & 3, 2u);
}
unsigned memory_size(std::uint32_t ccr) {
  return 1u << std::min((ccr >> 10) & 3, 2u);
}

}  // namespace

DmaF1::DmaF1(std::string name, Chip chip, int first_irq)
    : WordBlock(std::move(name), Narrow::merge),
      chip_(std::move(chip)),
      first_irq_(first_irq),
      service_(chip_.events, [this] { service(); }) {}

void DmaF1::connect(int channel, DmaRequest& request) {
  Channel& c = channels_[static_cast<std::size_t>(channel - 1)];
  c.requests.push_back(&request);
  request.on_change([this, &c](bool) {
    if (wants_service(c)) wake(false);
  });
}

void DmaF1::reset() {
  service_.cancel();
  for (Channel& c : channels_) {
    c.ccr = c.cndtr = c.cpar = c.cmar = c.flags = c.reload = c.peripheral = c.memory = 0;
    update_irq(c);
  }
}

std::uint32_t DmaF1::read_word(std::uint32_t offset) {
  if (offset == 0) {
    std::uint32_t value = 0;
    for (unsigned i = 0; i < kChannels; ++i) value |= channels_[i].flags << (4 * i);
    return value;
  }
  const std::uint32_t at = offset - 8;
  if (offset < 8 || at >= 0x14 * kChannels) return 0;
  const Channel& c = channels_[at / 0x14];
  switch (at % 0x14) {
    case 0x00:
      return c.ccr;
    case 0x04:
      return c.cndtr;
    case 0x08:
      return c.cpar;
    case 0x0C:
      return c.cmar;
    default:
      return 0;
  }
}

void DmaF1::write_word(std::uint32_t offset, std::uint32_t value) {
  if (offset == 4) {
    for (unsigned i = 0; i < kChannels; ++i) {
      const std::uint32_t clear = (value >> (4 * i)) & 0xF;
      channels_[i].flags &= (clear & GIF) != 0 ? 0 : ~clear;
      if ((channels_[i].flags & ~GIF) == 0) channels_[i].flags = 0;
      update_irq(channels_[i]);
    }
    return;
  }
  const std::uint32_t at = offset - 8;
  if (offset < 8 || at >= 0x14 * kChannels) return;
  Channel& c = channels_[at / 0x14];
  const bool running = (c.ccr & EN) != 0;
  switch (at % 0x14) {
    case 0x00:
      return write_ccr(c, value & 0x7FFF);
    case 0x04:
      if (!running) c.cndtr = value & 0xFFFF;
      return;
    case 0x08:
      if (!running) c.cpar = value;
      return;
    case 0x0C:
      if (!running) c.cmar = value;
      return;
    default:
      return;
  }
}

void DmaF1::write_ccr(Channel& c, std::uint32_t value) {
  const bool was = (c.ccr & EN) != 0;
  c.ccr = value;
  if (!was && (value & EN) != 0) {
    c.reload = c.cndtr;
    c.peripheral = c.cpar;
    c.memory = c.cmar;
    if (wants_service(c)) wake(false);
  }
  update_irq(c);
}

bool DmaF1::wants_service(const Channel& c) {
  if ((c.ccr & EN) == 0 || c.cndtr == 0) return false;
  return (c.ccr & MEM2MEM) != 0 || std::any_of(c.requests.begin(), c.requests.end(),
                                               [](const DmaRequest* r) { return r->level(); });
}

void DmaF1::wake(bool after_burst) {
  if (serving_ || service_.pending()) return;
  const double hclk_Hz = chip_.clocks.hclk_Hz();
  const bool waits = after_burst && hclk_Hz > 0.0;
  service_.in(waits ? std::llround(kCyclesPerBurst * 1e9 / hclk_Hz) : 0);
}

DmaF1::Channel* DmaF1::pick() {
  Channel* best = nullptr;
  for (Channel& c : channels_) {
    if (!wants_service(c)) continue;
    if (best == nullptr || ((c.ccr >> 12) & 3) > ((best->ccr >> 12) & 3)) best = &c;
  }
  return best;
}

void DmaF1::service() {
  serving_ = true;  // what is raised meanwhile is seen by the loop
  const bool done = serve_burst();
  serving_ = false;
  if (!done) wake(true);
}

// False: the burst is full and more is wanted.
bool DmaF1::serve_burst() {
  for (int i = 0; i < kBurst; ++i) {
    Channel* c = pick();
    if (c == nullptr) return true;
    if (move(*c)) {
      item_done(*c);
    } else {
      c->ccr &= ~EN;
      c->flags |= TEIF | GIF;
      update_irq(*c);
    }
  }
  return pick() == nullptr;
}

bool DmaF1::move(Channel& c) {
  const unsigned psize = peripheral_size(c.ccr), msize = memory_size(c.ccr);
  const std::uint32_t from = (c.ccr & DIR) != 0 ? c.memory : c.peripheral;
  const std::uint32_t to = (c.ccr & DIR) != 0 ? c.peripheral : c.memory;
  const unsigned from_size = (c.ccr & DIR) != 0 ? msize : psize;
  const unsigned to_size = (c.ccr & DIR) != 0 ? psize : msize;
  std::uint32_t value = 0;
  if (!chip_.bus.read(from, from_size, value) || !chip_.bus.write(to, to_size, value)) return false;
  if ((c.ccr & PINC) != 0) c.peripheral += psize;
  if ((c.ccr & MINC) != 0) c.memory += msize;
  return true;
}

void DmaF1::item_done(Channel& c) {
  --c.cndtr;
  for (DmaRequest* request : c.requests) {
    if (request->level()) request->served();
    if (c.cndtr == 1) request->last_but_one();
  }
  if (c.cndtr == c.reload / 2 && c.reload > 1) c.flags |= HTIF | GIF;
  if (c.cndtr == 0) {
    c.flags |= TCIF | GIF;
    if ((c.ccr & CIRC) != 0) {
      c.cndtr = c.reload;
      c.peripheral = c.cpar;
      c.memory = c.cmar;
    } else {
      for (DmaRequest* request : c.requests) request->transfer_complete();
    }
  }
  update_irq(c);
}

void DmaF1::update_irq(const Channel& c) {
  const bool irq = ((c.ccr & TCIE) != 0 && (c.flags & TCIF) != 0) ||
                   ((c.ccr & HTIE) != 0 && (c.flags & HTIF) != 0) ||
                   ((c.ccr & TEIE) != 0 && (c.flags & TEIF) != 0);
  chip_.interrupts.set(first_irq_ + static_cast<int>(&c - channels_.data()), irq);
}

}  // namespace whirl::stm32
