#include "harness/target/fuzz_image.hpp"

#include <elf.h>

#include <cstring>
#include <initializer_list>
#include <iterator>

#include "base/random.hpp"

namespace whirl {
namespace {

constexpr std::uint32_t kFlash = 0x08000000, kRam = 0x20000000, kStack = 0x20005000;
constexpr std::uint32_t kNvic = 0xE000E100, kSysTick = 0xE000E010;
constexpr int kVectors = 98, kAccesses = 400;

struct Block {
  std::uint32_t first, last;  // of blocks of 1 KiB
};
constexpr Block kF405[] = {{0x40000000, 0x40007C00},
                           {0x40010000, 0x40014C00},
                           {0x40020000, 0x40026400},
                           {0x50060800, 0x50060800}};
constexpr Block kF103[] = {
    {0x40000000, 0x40007C00}, {0x40010000, 0x40015400}, {0x40018000, 0x40023400}};

// Instructions, ARMv7-M ARM chapter A7.
class Code {
 public:
  std::uint32_t here() const { return static_cast<std::uint32_t>(2 * halfwords_.size()); }
  void put(std::initializer_list<unsigned> halfwords) {
    for (const unsigned halfword : halfwords) {
      halfwords_.push_back(static_cast<std::uint16_t>(halfword));
    }
  }
  void load(unsigned reg, std::uint32_t value) {  // MOVW, MOVT
    move(0xF240, reg, value & 0xFFFF);
    move(0xF2C0, reg, value >> 16);
  }
  const std::vector<std::uint16_t>& halfwords() const { return halfwords_; }

 private:
  void move(unsigned opcode, unsigned reg, std::uint32_t imm) {
    put({opcode | ((imm >> 11) & 1) << 10 | imm >> 12,
         ((imm >> 8) & 7) << 12 | reg << 8 | (imm & 0xFF)});
  }
  std::vector<std::uint16_t> halfwords_;
};

class Writer {
 public:
  explicit Writer(std::uint64_t seed) : random_(seed, "fuzz_image"), f405_(seed % 2 == 0) {}

  FuzzImage write() {
    for (int i = 0; i < kVectors; ++i) code_.put({0, 0});
    const std::uint32_t interrupt = put_interrupt_handler();
    const std::uint32_t fault = put_fault_handler();
    const std::uint32_t reset = code_.here();
    put_set_up();
    const std::uint32_t loop = code_.here();
    for (int i = 0; i < kAccesses; ++i) put_step();
    code_.load(0, kFlash + loop + 1);
    code_.put({0x4700});  // bx r0
    return {f405_ ? "stm32f405rg" : "stm32f103cb", elf(interrupt, fault, reset)};
  }

 private:
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_.bits() % n); }
  bool one_in(std::uint32_t n) { return below(n) == 0; }

  // Counts in RAM's first word; at every 256th clears all enables in the NVIC.
  std::uint32_t put_interrupt_handler() {
    const std::uint32_t at = code_.here();
    code_.load(0, kRam);
    code_.put({0x6801, 0x3101, 0x6001, 0x060A, 0xD108});  // ldr adds str lsls bne out
    code_.load(0, kNvic + 0x80);
    code_.put({0x2100, 0x43C9, 0x6001, 0x6041, 0x6081});  // movs mvns str str str
    code_.put({0x4770});                                  // out: bx lr
    return at;
  }
  // Moves the stacked PC behind an instruction of 2 or 4 bytes.
  std::uint32_t put_fault_handler() {
    const std::uint32_t at = code_.here();
    code_.put({0x4668, 0x6981, 0x880A, 0x3102, 0x0AD2, 0x2A1D, 0xDB00, 0x3102, 0x6181, 0x4770});
    return at;
  }

  // The clocks of all blocks on.
  void put_set_up() {
    const std::uint32_t rcc = f405_ ? 0x40023830 : 0x40021014;
    for (std::uint32_t at = 0; at <= (f405_ ? 0x14u : 0x8u); at += 4)
      store(rcc + at, 0x1FFFFFFF, 4);
  }

  void put_step() {
    switch (below(64)) {
      case 0:
        return idle();
      case 1:
        return store(kNvic + 4 * below(3), value(), 4);
      case 2:
        return store(kSysTick + 4 * below(3), one_in(2) ? 7 : value() & 0xFFFF, 4);
      case 3:
        if (one_in(8)) code_.put({0xBF30});  // wfi
        return;
      case 4:
        if (one_in(200)) return move_stack();
        return;
      default:
        return access();
    }
  }

  void access() {
    const std::uint32_t block = any_block();
    const unsigned size = one_in(4) ? 1u << below(2) : 4u;
    const std::uint32_t address = block + (below(one_in(8) ? 0x400 : 0x100) & ~(size - 1));
    const bool watchdog = block == 0x40003000 || block == 0x40002C00;
    const bool clocks = block == (f405_ ? 0x40023800u : 0x40021000u);
    if ((watchdog || clocks) && !one_in(16)) return;
    if (one_in(3)) return read(address, size);
    store(address, value(), size);
  }

  void read(std::uint32_t address, unsigned size) {
    code_.load(0, address);
    code_.put({size == 4 ? 0x6801u : size == 2 ? 0x8801u : 0x7801u});
  }
  void store(std::uint32_t address, std::uint32_t value, unsigned size) {
    code_.load(0, address);
    code_.load(1, value);
    code_.put({size == 4 ? 0x6001u : size == 2 ? 0x8001u : 0x7001u});
  }
  void idle() {
    code_.load(1, 1 + below(2000));
    code_.put({0x3901, 0xD1FD});  // subs r1, #1; bne
  }
  void move_stack() {
    code_.load(1, one_in(2) ? any_block() + 0x40 : value() & ~3u);
    code_.put({0x468D});  // mov sp, r1
  }

  std::uint32_t any_block() {
    const auto pick = [this](const auto& blocks) {
      const Block& block = blocks[below(static_cast<std::uint32_t>(std::size(blocks)))];
      return block.first + 0x400 * below((block.last - block.first) / 0x400 + 1);
    };
    return f405_ ? pick(kF405) : pick(kF103);
  }
  std::uint32_t value() {
    switch (below(8)) {
      case 0:
        return 0;
      case 1:
        return 0xFFFFFFFF;
      case 2:
        return 1u << below(32);
      case 3:
        return below(0x10000);
      case 4:
        return kRam + 0x100 + (below(0x4000) & ~3u);
      case 5:
        return any_block() + (below(0x100) & ~3u);
      default:
        return static_cast<std::uint32_t>(random_.bits());
    }
  }

  std::vector<std::uint8_t> elf(std::uint32_t interrupt, std::uint32_t fault,
                                std::uint32_t reset) const {
    const std::vector<std::uint16_t>& code = code_.halfwords();
    const auto bytes = static_cast<std::uint32_t>(2 * code.size());
    Elf32_Ehdr head{};
    std::memcpy(head.e_ident, ELFMAG, SELFMAG);
    head.e_ident[EI_CLASS] = ELFCLASS32;
    head.e_ident[EI_DATA] = ELFDATA2LSB;
    head.e_ident[EI_VERSION] = EV_CURRENT;
    head.e_type = ET_EXEC;
    head.e_machine = EM_ARM;
    head.e_version = EV_CURRENT;
    head.e_entry = kFlash + reset + 1;
    head.e_phoff = sizeof head;
    head.e_ehsize = sizeof head;
    head.e_phentsize = sizeof(Elf32_Phdr);
    head.e_phnum = 1;
    Elf32_Phdr program{};
    program.p_type = PT_LOAD;
    program.p_offset = sizeof head + sizeof program;
    program.p_vaddr = program.p_paddr = kFlash;
    program.p_filesz = program.p_memsz = bytes;
    std::vector<std::uint8_t> file(program.p_offset + bytes);
    std::memcpy(file.data(), &head, sizeof head);
    std::memcpy(file.data() + sizeof head, &program, sizeof program);
    std::memcpy(file.data() + program.p_offset, code.data(), bytes);
    const auto vector = [&](int number, std::uint32_t value) {
      std::memcpy(file.data() + program.p_offset + 4 * number, &value, sizeof value);
    };
    vector(0, kStack);
    vector(1, kFlash + reset + 1);
    for (int n = 2; n < kVectors; ++n) {
      vector(n, kFlash + 1 + (n >= 3 && n <= 6 ? fault : interrupt));
    }
    return file;
  }

  RandomStream random_;
  bool f405_;
  Code code_;
};

}  // namespace

FuzzImage fuzz_image(std::uint64_t seed) {
  return Writer(seed).write();
}

}  // namespace whirl
