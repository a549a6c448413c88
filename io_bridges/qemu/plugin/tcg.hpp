// SPDX-License-Identifier: GPL-2.0-or-later
//
// QEMU's translator from the inside: the operations of the block that is being translated, as a list
// that can be added to.
//
//   When     in the plug-in's translation callback: the block's operations are complete, the public
//            plug-in calls not yet put in
//   Numbers  operations are known by name, so no enumeration of QEMU's is copied
//   Source   QEMU 7.2: tcg/tcg.c, include/tcg/tcg.h, include/exec/gen-icount.h
#pragma once
#include <array>
#include <bitset>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"

namespace whirl::qemu::tcg {

struct Label;
using Argument = std::uintptr_t;  // a temporary, a label or a number

struct Operation {
  unsigned number : 8, counts : 24;
  unsigned life;
  void* links[2];
  Argument arguments[10];
};

struct Numbers {
  int st32 = -1, ld64 = -1, st64 = -1, st16 = -1, add64 = -1, sub64 = -1, and64 = -1, sar64 = -1,
      shl64 = -1, widen = -1, move32 = -1, move64 = -1, sub32 = -1, add32 = -1, and32 = -1,
      sar32 = -1, shl32 = -1, branch32 = -1, label = -1, instruction = -1, goto_block = -1,
      exit_block = -1, goto_pointer = -1, callback = -1, callback_end = -1, call = -1,
      leading_zeros32 = -1, xor32 = -1, multiply64 = -1, widen_unsigned = -1, shr32 = -1,
      shr64 = -1, load32 = -1, load64 = -1, store32 = -1, multiply_long = -1,
      multiply_long_signed = -1, load_half32 = -1;
};

// Finds all of it, once; refused where this QEMU lacks something.
Result<Done> find();
const Numbers& numbers();

std::vector<Operation*> operations();
// A new one behind all others, with no arguments yet: what is put ahead of it is behind all others too.
Operation* add_instruction_mark();
void remove(Operation* operation);
Argument number32(std::int32_t value);
Argument number64(std::int64_t value);
Argument address(const void* where);
// The name of the helper function that a call operation calls; empty: not a call.
std::string_view helper_name(const Operation& operation);
// The last two arguments of such a call.
struct LastInputs {
  Argument first, second;
};
LastInputs last_inputs(const Operation& call);

// Of the guest's memory that such an operation accesses, log2 of the bytes.
int size_log2(const Operation& access);

// Those that it has: behind them stands what an earlier operation has left in the same place.
std::span<const Argument> arguments_of(const Operation& operation);
// The translator's name for a word of the CPU's environment that it keeps in registers, by the offset of
// that word; 0: it has none. `environment` is the temporary that points there.
Argument global_at(Argument environment, std::intptr_t offset);
// Does the operation put a new value into it?
bool writes(const Operation& operation, Argument temporary);

// Temporaries of our own. The translator has given all of its own back by then, so that a new one may be
// one that it still uses: only those that no operation of the block names are taken.
class Spare {
 public:
  explicit Spare(const std::vector<Operation*>& block);
  Argument allocate(int type);
  // What those taken since then hold is no longer wanted. The translator has few hundred of them.
  using Taken = std::array<std::size_t, 2>;
  Taken taken() const { return taken_; }
  void give_back(Taken since) { taken_ = since; }

 private:
  static constexpr std::size_t kWords = 32768;  // temporaries lie at the start of the context
  std::size_t place_of(Argument argument) const { return (argument - context_) / sizeof(Argument); }

  Argument context_;
  std::bitset<kWords> used_;       // by the block
  std::vector<Argument> ours_[2];  // of 32 and 64 bits
  Taken taken_{};
};

// Puts operations in front of one that is there. What it computes is good for as long as it lives.
class Ahead {
 public:
  Ahead(Operation* place, Spare& spare) : place_(place), spare_(spare), since_(spare.taken()) {}
  ~Ahead() { spare_.give_back(since_); }
  Ahead(const Ahead&) = delete;
  Ahead& operator=(const Ahead&) = delete;
  Argument op32(int number, Argument a, Argument b = 0);  // a new 32-bit temporary holds the result
  Argument op64(int number, Argument a, Argument b = 0);
  void put(int number, Argument a, Argument b = 0, Argument c = 0);
  Label* branch_if_at_least(Argument a, Argument b);   // signed, 32 bits
  Label* branch_if_not_below(Argument a, Argument b);  // unsigned
  void here(Label* label);

 private:
  Label* branch_if(Argument condition, Argument a, Argument b);

  Operation* place_;
  Spare& spare_;
  const Spare::Taken since_;
};

}  // namespace whirl::qemu::tcg
