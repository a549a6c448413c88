#include "io_bridges/qemu/cycles/instruction.hpp"

#include <bit>

namespace whirl::cycles {
namespace {

constexpr std::uint32_t kSp = 13, kPc = 15;
constexpr std::uint32_t bit(std::uint32_t n) {
  return 1u << n;
}

struct Bits {
  std::uint32_t word;
  bool is(std::uint32_t mask, std::uint32_t value) const { return (word & mask) == value; }
  std::uint32_t field(int at, int count) const { return (word >> at) & (bit(count) - 1); }
};

void one(Instruction& i, bool load, std::uint32_t rt, std::uint32_t address_from) {
  i.kind = load ? Class::load : Class::store;
  i.address_from = address_from;
  if (load) i.writes |= bit(rt);
  if (load && rt == kPc) i.flow = Flow::indirect;
}

void many(Instruction& i, bool load, std::uint32_t base, std::uint32_t list, bool update) {
  i.kind = load ? Class::load_many : Class::store_many;
  i.registers = static_cast<std::uint8_t>(std::popcount(list));
  i.address_from = bit(base);
  i.updates_base = update;
  if (load) i.writes |= list;
  if (update) i.writes |= bit(base);
  if (load && (list & bit(kPc)) != 0) i.flow = Flow::indirect;
}

// Data processing on registers (A5.2.2) and special data instructions (A5.2.3).
void decode_register_operation(Instruction& i, Bits h) {
  if (h.word < 0x4400) {
    const bool compares = h.is(0xFFC0, 0x4200) || h.is(0xFF80, 0x4280);
    if (!compares) i.writes = bit(h.field(0, 3));
    if (h.is(0xFFC0, 0x4340)) i.kind = Class::multiply;
    return;
  }
  if (h.word >= 0x4700) {
    i.flow = Flow::indirect;  // BX, BLX
    return;
  }
  if (h.is(0xFF00, 0x4500)) return;  // CMP
  const std::uint32_t rd = h.field(0, 3) | (h.field(7, 1) << 3);
  i.writes = bit(rd);
  if (rd == kPc) i.flow = Flow::indirect;
}

void decode_load_store(Instruction& i, Bits h) {
  const std::uint32_t rt = h.field(0, 3), rn = h.field(3, 3);
  if (h.word < 0x5000) {
    one(i, true, h.field(8, 3), 0);
    i.literal = true;
  } else if (h.word < 0x6000) {
    one(i, h.word >= 0x5600, rt, bit(rn) | bit(h.field(6, 3)));
    i.register_offset = true;
  } else if (h.word < 0x9000) {
    one(i, h.field(11, 1) != 0, rt, bit(rn));
  } else {
    one(i, h.field(11, 1) != 0, h.field(8, 3), bit(kSp));
  }
}

// Miscellaneous 16-bit instructions, A5.2.5.
void decode_miscellaneous(Instruction& i, Bits h) {
  if (h.is(0xF500, 0xB100))
    i.flow = Flow::conditional;  // CBZ, CBNZ
  else if (h.is(0xFE00, 0xB400))
    many(i, false, kSp, h.word & 0x1FF, true);
  else if (h.is(0xFE00, 0xBC00))
    many(i, true, kSp, (h.word & 0xFF) | (h.field(8, 1) << kPc), true);
  else if (h.is(0xFF00, 0xB000))
    i.writes = bit(kSp);
  else if (h.is(0xFF00, 0xB200) || h.is(0xFF00, 0xBA00))
    i.writes = bit(h.field(0, 3));
  else if (h.is(0xFFE0, 0xB660))
    i.kind = Class::special;
  else if (h.is(0xFF00, 0xBF00) && h.field(0, 4) != 0)
    i.kind = Class::it, i.folding_it = true;
}

void decode_16(Instruction& i, Bits h) {
  if (h.word < 0x2000)
    i.writes = bit(h.field(0, 3));
  else if (h.word < 0x4000)
    i.writes = h.is(0xF800, 0x2800) ? 0 : bit(h.field(8, 3));
  else if (h.word < 0x4800)
    decode_register_operation(i, h);
  else if (h.word < 0xA000)
    decode_load_store(i, h);
  else if (h.word < 0xB000)
    i.writes = bit(h.field(8, 3));
  else if (h.word < 0xC000)
    decode_miscellaneous(i, h);
  else if (h.word < 0xD000)
    many(i, h.field(11, 1) != 0, h.field(8, 3), h.word & 0xFF, true);
  else if (h.word < 0xDE00)
    i.flow = Flow::conditional;
  else if (h.is(0xF800, 0xE000))
    i.flow = Flow::direct;
}

// VLDM, VSTM, VPUSH, VPOP; VLDR, VSTR: A6.6.
void decode_fp_transfer(Instruction& i, Bits first, Bits second, std::uint32_t sd) {
  const bool load = first.field(4, 1) != 0, pairs = second.field(8, 1) != 0;
  const std::uint32_t rn = first.field(0, 4);
  i.address_from = rn == kPc ? 0 : bit(rn);
  if (first.is(0xFF20, 0xED00)) {
    i.kind = load ? Class::fp_load : Class::fp_store;
    i.doubleword = pairs;
    i.literal = rn == kPc;
    (load ? i.fp_writes : i.fp_reads) = pairs ? 3u << (sd & 30) : bit(sd);
    return;
  }
  i.kind = load ? Class::fp_load_many : Class::fp_store_many;
  i.registers = static_cast<std::uint8_t>(second.field(0, 8));
  i.updates_base = first.field(5, 1) != 0;
  if (i.updates_base) i.writes |= bit(rn);
}

// A6.4, A6.5, A6.7.
void decode_fp_operation(Instruction& i, Bits first, Bits second, std::uint32_t sd) {
  const std::uint32_t sn = ((first.word << 1) & 30) | second.field(7, 1);
  const std::uint32_t sm = ((second.word << 1) & 30) | second.field(5, 1);
  i.kind = Class::fp;
  if (second.field(4, 1) != 0) {  // between a core register and the FPU
    const bool to_core = first.field(4, 1) != 0;
    (to_core ? i.fp_reads : i.fp_writes) = bit(sn);
    if (to_core) i.writes = bit(second.field(12, 4)) & ~bit(kPc);
    return;
  }
  const std::uint32_t operation = first.word & 0xB0;
  i.fp_writes = bit(sd);
  i.fp_reads = bit(sm) | (operation == 0xB0 ? 0 : bit(sn));
  const bool root = first.is(0xBF, 0xB1) && second.is(0xC0, 0xC0);
  if (operation == 0x80 || root) i.kind = Class::fp_divide;
  if (operation <= 0x10 || operation == 0x90 || operation == 0xA0) {
    i.kind = Class::fp_accumulate;
    i.fp_reads |= bit(sd);
  }
}

void decode_fp(Instruction& i, Bits first, Bits second) {
  const std::uint32_t sd = ((second.word >> 11) & 30) | first.field(6, 1);
  if (first.is(0xFFE0, 0xEC40))
    i.kind = Class::fp_move_two;
  else if (first.is(0xFE00, 0xEC00) || first.is(0xFF20, 0xED00))
    decode_fp_transfer(i, first, second, sd);
  else
    decode_fp_operation(i, first, second, sd);
}

// Load and store multiple, dual, exclusive, table branch: A5.3.5, A5.3.6.
void decode_many_32(Instruction& i, Bits first, Bits second) {
  const bool load = first.field(4, 1) != 0;
  const std::uint32_t rn = first.field(0, 4), rt = second.field(12, 4);
  if (first.field(6, 1) == 0) return many(i, load, rn, second.word, first.field(5, 1) != 0);
  i.address_from = bit(rn);
  if (first.is(0xFFF0, 0xE8D0) && second.is(0xFFE0, 0xF000)) {
    i.kind = Class::table_branch;
    i.address_from |= bit(second.field(0, 4));
    i.flow = Flow::indirect;
  } else if (first.is(0xFF60, 0xE840) || first.is(0xFFE0, 0xE8C0)) {
    i.kind = Class::exclusive;
    if (load)
      i.writes = bit(rt);
    else
      i.writes = bit(second.field(first.is(0xFFF0, 0xE840) ? 8 : 0, 4));
  } else {
    many(i, load, rn, bit(rt) | bit(second.field(8, 4)), first.field(5, 1) != 0);
    if (rn == kPc) i.address_from = 0, i.literal = true;
  }
}

// Branches and miscellaneous control: A5.3.4.
void decode_control(Instruction& i, Bits first, Bits second) {
  if (second.field(12, 1) != 0)
    i.flow = Flow::direct;  // B.W, BL
  else if (!first.is(0x0380, 0x0380))
    i.flow = Flow::conditional;
  else if (first.is(0xFFFF, 0xF3BF))
    i.kind = Class::barrier;
  else if (!first.is(0xFFFF, 0xF3AF))
    i.kind = Class::special;  // not a hint
}

// A5.3.7 to A5.3.10.
void decode_load_store_32(Instruction& i, Bits first, Bits second) {
  const bool load = first.field(4, 1) != 0, offset_12 = first.field(7, 1) != 0;
  const std::uint32_t rn = first.field(0, 4), rt = second.field(12, 4);
  if (load && rt == kPc && !first.is(0x60, 0x40)) return;  // PLD
  i.literal = rn == kPc;
  i.register_offset = !i.literal && !offset_12 && second.is(0x0FC0, 0);
  i.updates_base = !i.literal && !offset_12 && second.is(0x0900, 0x0900);
  one(i, load, rt, (i.literal ? 0 : bit(rn)) | (i.register_offset ? bit(second.field(0, 4)) : 0));
  if (i.updates_base) i.writes |= bit(rn);
}

// A5.3.12 to A5.3.17.
void decode_register_32(Instruction& i, Bits first, Bits second) {
  i.writes = bit(second.field(8, 4));
  const std::uint32_t ra = second.field(12, 4);
  if (first.is(0xFF80, 0xFB00)) {
    i.kind = ra == kPc ? Class::multiply : Class::accumulate;
  } else if (first.is(0xFFD0, 0xFB90)) {
    i.kind = Class::divide;
  } else if (first.is(0xFF80, 0xFB80)) {
    i.kind = Class::long_multiply;
    i.accumulates = first.field(6, 1) != 0;
    i.with_sign = first.field(5, 1) == 0;
    i.writes |= bit(ra);
  }
}

void decode_32(Instruction& i, Bits first, Bits second) {
  const std::uint32_t h = first.word;
  if (first.is(0xFE00, 0xE800)) return decode_many_32(i, first, second);
  if (first.is(0xEC00, 0xEC00)) return decode_fp(i, first, second);
  if (h >= 0xFA00) return decode_register_32(i, first, second);
  if (h >= 0xF800) return decode_load_store_32(i, first, second);
  if (h >= 0xF000 && second.field(15, 1) != 0) return decode_control(i, first, second);
  const std::uint32_t rd = second.field(8, 4);
  if (rd != kPc) i.writes = bit(rd);
}

}  // namespace

bool Instruction::loads() const {
  return kind == Class::load || kind == Class::load_many || kind == Class::fp_load ||
         kind == Class::fp_load_many || kind == Class::table_branch ||
         (kind == Class::exclusive && writes != 0);
}

bool Instruction::stores() const {
  return kind == Class::store || kind == Class::store_many || kind == Class::fp_store ||
         kind == Class::fp_store_many || kind == Class::exclusive;
}

Instruction decode(std::uint32_t address, std::uint16_t first, std::uint16_t second, bool wide) {
  Instruction i;
  i.address = address;
  i.bytes = wide ? 4 : 2;
  if (wide)
    decode_32(i, {first}, {second});
  else
    decode_16(i, {first});
  return i;
}

}  // namespace whirl::cycles
