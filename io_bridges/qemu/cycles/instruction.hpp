// What the timing of a Thumb instruction depends on, read from its bits.
//
//   Source  ARMv7-M ARM (DDI 0403E) A5 for the encodings
//   Errors  an encoding that is none counts as a plain instruction of one cycle: the core faults on it
#pragma once
#include <cstdint>

namespace whirl::cycles {

enum class Core : std::uint8_t { cortex_m3, cortex_m4f };

// The rows of ARM's timing tables (core_model.cpp has the cycles).
enum class Class : std::uint8_t {
  plain,          // data processing, moves, hints
  it,             // IT
  multiply,       // MUL, and all of one cycle on both cores
  accumulate,     // MLA, MLS
  long_multiply,  // UMULL, SMULL, UMLAL, SMLAL
  divide,         // UDIV, SDIV
  load,
  store,
  load_many,
  store_many,     // LDM, LDRD, POP; STM, STRD, PUSH: `registers` of them
  exclusive,      // LDREX, STREX
  table_branch,   // TBB, TBH
  barrier,        // DMB, DSB, ISB
  special,        // MRS, MSR, CPS
  fp,             // VADD, VMUL, VMOV, VCMP, VCVT, VABS, VNEG
  fp_accumulate,  // VMLA, VFMA and their kin
  fp_divide,      // VDIV, VSQRT
  fp_load,
  fp_store,
  fp_load_many,
  fp_store_many,
  fp_move_two,  // between two core registers and FP registers
};

enum class Flow : std::uint8_t {
  next,
  conditional,  // B<c>, CBZ: the target is in the instruction
  direct,       // B, BL
  indirect,     // BX, BLX, MOV PC, POP {..PC}, LDR PC, TBB
};

struct Instruction {
  std::uint32_t address = 0;
  std::uint8_t bytes = 2;
  Class kind = Class::plain;
  Flow flow = Flow::next;
  std::uint8_t registers = 0;                 // of a multiple transfer
  bool literal = false;                       // its address is relative to PC
  bool updates_base = false;                  // write-back
  bool register_offset = false;               // [Rn, Rm]
  bool doubleword = false;                    // VLDR, VSTR of D registers
  bool accumulates = false;                   // a long multiply
  bool with_sign = false;                     // the same
  bool folding_it = false;                    // an IT that may fold into what is before it
  std::uint32_t writes = 0;                   // core registers, a bit each
  std::uint32_t address_from = 0;             // core registers that make its address
  std::uint32_t fp_writes = 0, fp_reads = 0;  // S registers

  bool loads() const;
  bool stores() const;
  bool accesses_memory() const { return loads() || stores(); }
  bool floating() const { return kind >= Class::fp; }
};

// `second` counts for 32-bit encodings only.
Instruction decode(std::uint32_t address, std::uint16_t first, std::uint16_t second, bool wide);

}  // namespace whirl::cycles
