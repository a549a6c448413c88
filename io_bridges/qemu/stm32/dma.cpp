#include "io_bridges/qemu/stm32/dma.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"

namespace whirl::stm32 {
namespace {

// SxCR
constexpr std::uint32_t EN = 1u << 0, DMEIE = 1u << 1, TEIE = 1u << 2, HTIE = 1u << 3,
                        TCIE = 1u << 4, PFCTRL = 1u << 5, CIRC = 1u << 8, PINC = 1u << 9,
                        MINC = 1u << 10, PINCOS = 1u << 15, DBM = 1u << 18, CT = 1u << 19;
constexpr std::uint32_t kAlwaysWritable = EN | DMEIE | TEIE | HTIE | TCIE;
// flags
constexpr std::uint32_t FEIF = 1u << 0, DMEIF = 1u << 2, TEIF = 1u << 3, HTIF = 1u << 4,
                        TCIF = 1u << 5;
// SxFCR
constexpr std::uint32_t DMDIS = 1u << 2, FEIE = 1u << 7;

enum Direction : std::uint32_t { from_peripheral = 0, to_peripheral = 1, memory_to_memory = 2 };

constexpr unsigned kFlagShift[4] = {0, 6, 16, 22};
constexpr int kBurst = 16, kCyclesPerBurst = 8 * kBurst;

std::uint32_t direction(std::uint32_t cr) {
  return (cr >> 6) & 3;
}
unsigned peripheral_size(std::uint32_t cr) {
  return 1u << std::min((cr >> 11) & 3, 2u);
}
unsigned memory_size(std::uint32_t cr) {
  return 1u << std::min((cr >> 13) & 3, 2u);
}

}  // namespace

Dma::Dma(std::string name, Chip chip, const std::array<int, kStreams>& irqs, bool mem2mem)
    : WordBlock(std::move(name), Narrow::merge),
      chip_(std::move(chip)),
      irqs_(irqs),
      memory_to_memory_(mem2mem),
      service_(chip_.events, [this] { service(); }) {}

void Dma::connect(int stream, int channel, DmaRequest& request) {
  auto& slot =
      streams_[static_cast<std::size_t>(stream)].requests[static_cast<std::size_t>(channel)];
  const auto free = std::find(slot.begin(), slot.end(), nullptr);
  WHIRL_CHECK(free != slot.end(), stream, channel);
  *free = &request;
}

bool Dma::requested(const Stream& s) {
  if (direction(s.cr) == memory_to_memory) return true;
  for (const DmaRequest* request : s.requests[(s.cr >> 25) & 7]) {
    if (request == nullptr) return false;  // filled from the front
    if (request->level()) return true;
  }
  return false;
}

void Dma::arm(int n) {
  Stream& s = streams_[static_cast<std::size_t>(n)];
  const std::uint32_t bit = 1u << n;
  const bool ready = (s.cr & EN) != 0 && requested(s);
  ready_ = ready ? ready_ | bit : ready_ & ~bit;
  if (ready) wake(false);
}

void Dma::reset() {
  service_.cancel();
  ready_ = 0;
  for (int n = 0; n < kStreams; ++n) {
    Stream& s = streams_[static_cast<std::size_t>(n)];
    const auto requests = s.requests;
    s = Stream{};
    s.requests = requests;
    update_irq(n);
  }
}

std::uint32_t Dma::read_word(std::uint32_t offset) {
  if (offset < 0x08) {
    std::uint32_t value = 0;
    for (unsigned i = 0; i < 4; ++i) value |= streams_[offset + i].flags << kFlagShift[i];
    return value;
  }
  if (offset < 0x10 || offset >= 0x10 + 0x18 * kStreams) return 0;
  const Stream& s = streams_[(offset - 0x10) / 0x18];
  switch ((offset - 0x10) % 0x18) {
    case 0x00:
      return s.cr;
    case 0x04:
      return s.ndtr;
    case 0x08:
      return s.par;
    case 0x0C:
      return s.m0ar;
    case 0x10:
      return s.m1ar;
    default: {
      // FS: 0 below 1/4, 1 below 1/2, 2 below 3/4, 3 below full, 4 empty, 5 full
      const std::uint32_t level = s.fifo_used == 0 ? 4 : s.fifo_used == 16 ? 5 : s.fifo_used / 4;
      return (s.fcr & ~0x38u) | (level << 3);
    }
  }
}

void Dma::write_word(std::uint32_t offset, std::uint32_t value) {
  if (offset >= 0x08 && offset < 0x10) {
    for (unsigned i = 0; i < 4; ++i) {
      const unsigned n = (offset - 0x08) + i;
      streams_[n].flags &= ~((value >> kFlagShift[i]) & 0x3D);
      update_irq(static_cast<int>(n));
    }
    return;
  }
  if (offset < 0x10 || offset >= 0x10 + 0x18 * kStreams) return;
  const int n = static_cast<int>((offset - 0x10) / 0x18);
  Stream& s = streams_[static_cast<std::size_t>(n)];
  const bool running = (s.cr & EN) != 0;
  switch ((offset - 0x10) % 0x18) {
    case 0x00:
      return write_cr(n, value & 0x0FFFFFFF);
    case 0x04:
      if (!running) s.ndtr = value & 0xFFFF;
      return;
    case 0x08:
      if (!running) s.par = value;
      return;
    case 0x0C:  // in double buffer mode the buffer that is not in use may be changed
      if (!running || ((s.cr & DBM) != 0 && (s.cr & CT) != 0)) s.m0ar = value;
      return;
    case 0x10:
      if (!running || ((s.cr & DBM) != 0 && (s.cr & CT) == 0)) s.m1ar = value;
      return;
    default:
      s.fcr = running ? (s.fcr & ~FEIE) | (value & FEIE) : (value & 0x87) | 0x20;
      return update_irq(n);
  }
}

void Dma::write_cr(int n, std::uint32_t value) {
  Stream& s = streams_[static_cast<std::size_t>(n)];
  const bool was = (s.cr & EN) != 0;
  const std::uint32_t writable = was ? kAlwaysWritable : 0xFFFFFFFF;
  s.cr = (s.cr & ~writable) | (value & writable);
  const bool is = (s.cr & EN) != 0;
  if (is && !was) enable(n);
  if (!is && was) disable_by_software(n);
  update_irq(n);
}

void Dma::enable(int n) {
  Stream& s = streams_[static_cast<std::size_t>(n)];
  if ((s.flags & (TCIF | TEIF | DMEIF | FEIF)) != 0) {
    report_once(1u << n,
                "stream " + std::to_string(n) + " enabled with flags of the last transfer up");
  }
  if ((s.cr & PFCTRL) != 0) report_once(1u << 8, "PFCTRL is not modelled");
  const bool mem2mem = direction(s.cr) == memory_to_memory;
  if (mem2mem && !memory_to_memory_) {
    report_once(1u << 9, "memory-to-memory is not possible on this controller");
    return fail(n);
  }
  if (mem2mem) s.fcr |= DMDIS;  // forced: direct mode is not allowed
  if ((s.cr & DBM) != 0) s.cr |= CIRC;
  s.reload = s.ndtr;
  if (s.ndtr == 0) {
    s.cr &= ~EN;
    return;
  }
  // Every level that stands now counts as a request of this stream.
  for (DmaRequest* request : s.requests[(s.cr >> 25) & 7]) {
    if (request != nullptr) request->on_change([this, n](bool) { arm(n); });
  }
  start_block(s);
  arm(n);
}

void Dma::start_block(Stream& s) {
  s.ndtr = s.reload;
  s.peripheral = s.par;
  s.memory = (s.cr & DBM) != 0 && (s.cr & CT) != 0 ? s.m1ar : s.m0ar;
  s.memory_left = s.reload * peripheral_size(s.cr);
}

void Dma::stop(int n) {
  streams_[static_cast<std::size_t>(n)].cr &= ~EN;
  ready_ &= ~(1u << n);
}

// The rest of the FIFO goes to memory, then TCIF tells that the stream has stopped (10.3.15).
void Dma::disable_by_software(int n) {
  Stream& s = streams_[static_cast<std::size_t>(n)];
  if (direction(s.cr) != to_peripheral) drain_fifo(s, true);
  s.fifo_used = 0;
  stop(n);
  raise(n, TCIF);
}

// At this very instant, or after a burst when the bus has been busy for as long.
void Dma::wake(bool after_burst) {
  if (serving_ || service_.pending()) return;
  const double hclk_Hz = chip_.clocks.hclk_Hz();
  const bool waits = after_burst && hclk_Hz > 0.0;
  service_.in(waits ? std::llround(kCyclesPerBurst * 1e9 / hclk_Hz) : 0);
}

int Dma::pick() const {
  int best = -1;
  std::uint32_t best_priority = 0;
  for (std::uint32_t left = ready_; left != 0; left &= left - 1) {
    const int n = __builtin_ctz(left);
    const std::uint32_t priority = (streams_[static_cast<std::size_t>(n)].cr >> 16) & 3;
    if (best >= 0 && priority <= best_priority) continue;
    best = n;
    best_priority = priority;
  }
  return best;
}

void Dma::service() {
  serving_ = true;  // what is raised meanwhile is seen by the loop
  const bool done = serve_burst();
  serving_ = false;
  if (!done) wake(true);
}

// False: the burst is full and more is wanted.
bool Dma::serve_burst() {
  for (int i = 0; i < kBurst; ++i) {
    const int n = pick();
    if (n < 0) return true;
    move(n);
  }
  return ready_ == 0;
}

void Dma::move(int n) {
  const Stream& s = streams_[static_cast<std::size_t>(n)];
  switch (direction(s.cr)) {
    case from_peripheral:
      return move_peripheral_to_memory(n);
    case to_peripheral:
      return move_memory_to_peripheral(n);
    default:
      return move_memory_to_memory(n);
  }
}

// Moves one item of `size` bytes from `address` into the FIFO.
bool Dma::transfer_in(Stream& s, std::uint32_t& address, unsigned size, bool increment) {
  std::uint32_t value = 0;
  if (!chip_.bus.read(address, size, value)) return false;
  for (unsigned i = 0; i < size; ++i) {
    s.fifo[s.fifo_used++] = static_cast<std::uint8_t>(value >> (8 * i));
  }
  if (increment) address += size;
  return true;
}

// FIFO to memory: in direct mode at once, else from the threshold on, in units of MSIZE.
bool Dma::drain_fifo(Stream& s, bool all) {
  const bool direct = (s.fcr & DMDIS) == 0;
  const unsigned size = direct ? peripheral_size(s.cr) : memory_size(s.cr);
  const unsigned threshold = direct ? size : 4 * ((s.fcr & 3) + 1);
  if (!all && s.fifo_used < threshold) return true;
  while (s.fifo_used > 0) {
    const unsigned n = std::min(size, s.fifo_used);
    if (n < size && !all) break;
    std::uint32_t value = 0;
    for (unsigned i = 0; i < n; ++i) value |= static_cast<std::uint32_t>(s.fifo[i]) << (8 * i);
    const unsigned width = n == 3 ? 2 : n;  // a remainder is written in what it fills
    if (!chip_.bus.write(s.memory, width, value)) return false;
    if ((s.cr & MINC) != 0) s.memory += size;
    std::copy(s.fifo.begin() + n, s.fifo.begin() + s.fifo_used, s.fifo.begin());
    s.fifo_used -= n;
  }
  return true;
}

bool Dma::fill_fifo(Stream& s, unsigned up_to) {
  const bool direct = (s.fcr & DMDIS) == 0;
  const unsigned size = direct ? peripheral_size(s.cr) : memory_size(s.cr);
  while (s.fifo_used < up_to && s.memory_left > 0 && s.fifo_used + size <= s.fifo.size()) {
    if (!transfer_in(s, s.memory, size, (s.cr & MINC) != 0)) return false;
    s.memory_left -= std::min(s.memory_left, size);
  }
  return true;
}

void Dma::move_peripheral_to_memory(int n) {
  Stream& s = streams_[static_cast<std::size_t>(n)];
  const unsigned size = peripheral_size(s.cr);
  const std::uint32_t step = (s.cr & PINCOS) != 0 ? 4 : size;
  std::uint32_t address = s.peripheral;
  if (!transfer_in(s, address, size, false)) return fail(n);
  if ((s.cr & PINC) != 0) s.peripheral += step;
  if (!drain_fifo(s, s.ndtr == 1)) return fail(n);
  item_done(n);
}

void Dma::move_memory_to_peripheral(int n) {
  Stream& s = streams_[static_cast<std::size_t>(n)];
  const unsigned size = peripheral_size(s.cr);
  const bool direct = (s.fcr & DMDIS) == 0;
  if (!fill_fifo(s, direct ? size : 16)) return fail(n);
  std::uint32_t value = 0;
  for (unsigned i = 0; i < size; ++i) value |= static_cast<std::uint32_t>(s.fifo[i]) << (8 * i);
  std::copy(s.fifo.begin() + size, s.fifo.end(), s.fifo.begin());
  s.fifo_used -= std::min(size, s.fifo_used);
  if (!chip_.bus.write(s.peripheral, size, value)) return fail(n);
  if ((s.cr & PINC) != 0) s.peripheral += (s.cr & PINCOS) != 0 ? 4 : size;
  item_done(n);
}

// The "peripheral" side is the source (PAR), the memory side the destination.
void Dma::move_memory_to_memory(int n) {
  Stream& s = streams_[static_cast<std::size_t>(n)];
  const unsigned size = peripheral_size(s.cr);
  if (!transfer_in(s, s.peripheral, size, (s.cr & PINC) != 0)) return fail(n);
  if (!drain_fifo(s, s.ndtr == 1)) return fail(n);
  item_done(n);
}

void Dma::item_done(int n) {
  Stream& s = streams_[static_cast<std::size_t>(n)];
  --s.ndtr;
  for (DmaRequest* request : s.requests[(s.cr >> 25) & 7]) {
    if (request == nullptr) continue;
    if (request->level()) request->served();
    if (s.ndtr == 1) request->last_but_one();
  }
  if (!requested(s)) ready_ &= ~(1u << n);
  if (s.ndtr == s.reload / 2 && s.reload > 1) raise(n, HTIF);
  if (s.ndtr == 0) block_done(n);
}

void Dma::block_done(int n) {
  Stream& s = streams_[static_cast<std::size_t>(n)];
  s.fifo_used = 0;
  if ((s.cr & CIRC) != 0) {
    if ((s.cr & DBM) != 0) s.cr ^= CT;
    start_block(s);
  } else {
    stop(n);
    for (DmaRequest* request : s.requests[(s.cr >> 25) & 7]) {
      if (request != nullptr) request->transfer_complete();
    }
  }
  raise(n, TCIF);
}

void Dma::fail(int n) {
  Stream& s = streams_[static_cast<std::size_t>(n)];
  stop(n);
  s.fifo_used = 0;
  raise(n, TEIF);
}

void Dma::raise(int n, std::uint32_t flags) {
  streams_[static_cast<std::size_t>(n)].flags |= flags;
  update_irq(n);
}

void Dma::update_irq(int n) {
  const Stream& s = streams_[static_cast<std::size_t>(n)];
  const bool irq = ((s.cr & TCIE) != 0 && (s.flags & TCIF) != 0) ||
                   ((s.cr & HTIE) != 0 && (s.flags & HTIF) != 0) ||
                   ((s.cr & TEIE) != 0 && (s.flags & TEIF) != 0) ||
                   ((s.cr & DMEIE) != 0 && (s.flags & DMEIF) != 0) ||
                   ((s.fcr & FEIE) != 0 && (s.flags & FEIF) != 0);
  chip_.interrupts.set(irqs_[static_cast<std::size_t>(n)], irq);
}

void Dma::report_once(std::uint32_t bit, const std::string& what) {
  if ((reported_ & bit) != 0 || !chip_.finding) return;
  reported_ |= bit;
  chip_.finding({chip_.events.now(), name(), what});
}

}  // namespace whirl::stm32
