// SPDX-License-Identifier: GPL-2.0-or-later
#include "io_bridges/qemu/plugin/tcg.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cstring>

#include "base/check.hpp"
#include "io_bridges/qemu/plugin/qemu_api.hpp"

namespace whirl::qemu::tcg {
namespace {

struct Definition {  // TCGOpDef
  const char* name;
  std::uint8_t counts[4], flags;  // of outputs, inputs, constants, all arguments
  void* constraints;
};
struct HelperInfo {  // TCGHelperInfo
  void* function;
  const char* name;
};
constexpr int kMost_operations = 256;
constexpr int kWord = 0, kDoubleword = 1;                  // TCGType
constexpr Argument kSigned_at_least = 3, kNot_below = 5;   // TCG_COND_GE, TCG_COND_GEU
constexpr std::uint32_t kOne_reference = (1u << 16) | 1u;  // TCGLabel: present, refs

struct Functions {
  Operation* (*tcg_emit_op)(int) = nullptr;
  void (*tcg_op_remove)(void*, Operation*) = nullptr;
  Operation* (*tcg_op_insert_before)(void*, Operation*, int) = nullptr;
  Argument (*tcg_temp_new_internal)(int type, bool local) = nullptr;
  Argument (*tcg_constant_internal)(int type, std::int64_t) = nullptr;
  Label* (*gen_new_label)() = nullptr;
  const Definition* tcg_op_defs = nullptr;
} functions;
Numbers known;

// The context of the thread that translates.
void* context() {
  thread_local void* const* place = static_cast<void* const*>(dlsym(RTLD_DEFAULT, "tcg_ctx"));
  return *place;
}

struct Wanted {
  int Numbers::*number;
  const char* name;
};
constexpr Wanted kWanted[] = {{&Numbers::st32, "st_i32"},
                              {&Numbers::ld64, "ld_i64"},
                              {&Numbers::st64, "st_i64"},
                              {&Numbers::st16, "st16_i32"},
                              {&Numbers::add64, "add_i64"},
                              {&Numbers::sub64, "sub_i64"},
                              {&Numbers::and64, "and_i64"},
                              {&Numbers::sar64, "sar_i64"},
                              {&Numbers::shl64, "shl_i64"},
                              {&Numbers::widen, "ext_i32_i64"},
                              {&Numbers::move32, "mov_i32"},
                              {&Numbers::move64, "mov_i64"},
                              {&Numbers::sub32, "sub_i32"},
                              {&Numbers::add32, "add_i32"},
                              {&Numbers::and32, "and_i32"},
                              {&Numbers::sar32, "sar_i32"},
                              {&Numbers::shl32, "shl_i32"},
                              {&Numbers::branch32, "brcond_i32"},
                              {&Numbers::label, "set_label"},
                              {&Numbers::instruction, "insn_start"},
                              {&Numbers::goto_block, "goto_tb"},
                              {&Numbers::exit_block, "exit_tb"},
                              {&Numbers::goto_pointer, "goto_ptr"},
                              {&Numbers::callback, "plugin_cb_start"},
                              {&Numbers::callback_end, "plugin_cb_end"},
                              {&Numbers::call, "call"},
                              {&Numbers::leading_zeros32, "clz_i32"},
                              {&Numbers::xor32, "xor_i32"},
                              {&Numbers::multiply64, "mul_i64"},
                              {&Numbers::widen_unsigned, "extu_i32_i64"},
                              {&Numbers::shr32, "shr_i32"},
                              {&Numbers::shr64, "shr_i64"},
                              {&Numbers::load32, "qemu_ld_i32"},
                              {&Numbers::load64, "qemu_ld_i64"},
                              {&Numbers::store32, "qemu_st_i32"},
                              {&Numbers::multiply_long, "mulu2_i32"},
                              {&Numbers::multiply_long_signed, "muls2_i32"},
                              {&Numbers::load_half32, "ld16u_i32"}};

whirl::Error lacking(const std::string& what) {
  return {ErrorKind::host, "QEMU", "its translator has no " + what,
          std::string("use QEMU ") + tested_versions() +
              ", or a board file with a fixed timing (timing = \"8 ns\")"};
}

int number_of(const char* name) {
  for (int n = 0; n < kMost_operations && functions.tcg_op_defs[n].name != nullptr; ++n) {
    if (std::strcmp(functions.tcg_op_defs[n].name, name) == 0) return n;
  }
  return -1;
}

unsigned outputs_of(const Operation& operation) {
  const bool call = static_cast<int>(operation.number) == known.call;
  return call ? operation.counts & 0xF : functions.tcg_op_defs[operation.number].counts[0];
}

}  // namespace

Result<Done> find() {
  std::string missing;
  const auto symbol = [&missing](const char* name, auto& into) {
    into = reinterpret_cast<std::remove_reference_t<decltype(into)>>(dlsym(RTLD_DEFAULT, name));
    if (into == nullptr && missing.empty()) missing = name;
  };
  symbol("tcg_emit_op", functions.tcg_emit_op);
  symbol("tcg_op_remove", functions.tcg_op_remove);
  symbol("tcg_op_insert_before", functions.tcg_op_insert_before);
  symbol("tcg_temp_new_internal", functions.tcg_temp_new_internal);
  symbol("tcg_constant_internal", functions.tcg_constant_internal);
  symbol("gen_new_label", functions.gen_new_label);
  symbol("tcg_op_defs", functions.tcg_op_defs);
  if (missing.empty() && dlsym(RTLD_DEFAULT, "tcg_ctx") == nullptr) missing = "tcg_ctx";
  if (!missing.empty()) return lacking(missing);
  for (const Wanted& wanted : kWanted) {
    known.*wanted.number = number_of(wanted.name);
    if (known.*wanted.number < 0) return lacking(std::string("operation ") + wanted.name);
  }
  return Done{};
}

const Numbers& numbers() {
  return known;
}

Operation* add_instruction_mark() {
  return functions.tcg_emit_op(known.instruction);
}

void remove(Operation* operation) {
  functions.tcg_op_remove(context(), operation);
}

// The list has a head that we cannot name: from an operation emitted at its end we walk back.
std::vector<Operation*> operations() {
  struct Link {
    void* next;
    Link* previous;
  };
  std::vector<Operation*> list;
  Operation* end = add_instruction_mark();
  for (Operation* at = end;;) {
    const Link* link = reinterpret_cast<const Link*>(at->links);
    at = static_cast<Operation*>(link->previous->previous->next);
    if (at == nullptr) break;
    list.push_back(at);
  }
  remove(end);
  std::reverse(list.begin(), list.end());
  return list;
}

Argument number32(std::int32_t value) {
  return functions.tcg_constant_internal(kWord, value);
}

Argument number64(std::int64_t value) {
  return functions.tcg_constant_internal(kDoubleword, value);
}

Argument address(const void* where) {
  return number64(reinterpret_cast<std::int64_t>(where));
}

// Arguments of a call: outputs, inputs (their counts are the first two half-bytes of `counts`), function,
// info.
std::string_view helper_name(const Operation& operation) {
  if (static_cast<int>(operation.number) != known.call) return {};
  const unsigned outputs = operation.counts & 0xF, inputs = (operation.counts >> 4) & 0xF;
  const unsigned place = outputs + inputs + 1;
  if (place >= std::size(operation.arguments)) return {};
  return reinterpret_cast<const HelperInfo*>(operation.arguments[place])->name;
}

LastInputs last_inputs(const Operation& call) {
  const unsigned last = (call.counts & 0xF) + ((call.counts >> 4) & 0xF) - 1;
  return {call.arguments[last - 1], call.arguments[last]};
}

// MemOpIdx: four bits of MMU index, then MemOp, whose lowest three bits are the size.
int size_log2(const Operation& access) {
  return static_cast<int>((access.arguments[2] >> 4) & 7);
}

std::span<const Argument> arguments_of(const Operation& operation) {
  constexpr unsigned kFunction_and_info = 2;
  const bool call = static_cast<int>(operation.number) == known.call;
  const unsigned count =
      call ? (operation.counts & 0xF) + ((operation.counts >> 4) & 0xF) + kFunction_and_info
           : functions.tcg_op_defs[operation.number].counts[3];
  return std::span(operation.arguments)
      .first(std::min<std::size_t>(count, std::size(operation.arguments)));
}

// TCGTemp: four words, the third (mem_base) and the fourth (mem_offset) of which say where a global lives. The
// environment's pointer is the first of all temporaries, the globals follow.
Argument global_at(Argument environment, std::intptr_t offset) {
  constexpr int kSearched = 512, kBase = 2, kOffset = 3;
  const auto* words = reinterpret_cast<const std::intptr_t*>(environment);
  for (int at = 0; at < kSearched; ++at) {
    if (words[at + kBase] == static_cast<std::intptr_t>(environment) &&
        words[at + kOffset] == offset) {
      return reinterpret_cast<Argument>(words + at);
    }
  }
  return 0;
}

bool writes(const Operation& operation, Argument temporary) {
  const auto outputs = arguments_of(operation).first(outputs_of(operation));
  return std::find(outputs.begin(), outputs.end(), temporary) != outputs.end();
}

Spare::Spare(const std::vector<Operation*>& block)
    : context_(reinterpret_cast<Argument>(context())) {
  for (const Operation* operation : block) {
    for (const Argument argument : arguments_of(*operation)) {
      if (place_of(argument) < kWords) used_.set(place_of(argument));
    }
  }
}

Argument Spare::allocate(int type) {
  std::vector<Argument>& ours = ours_[type];
  while (taken_[type] == ours.size()) {
    const Argument fresh = functions.tcg_temp_new_internal(type, false);
    WHIRL_CHECK(place_of(fresh) < kWords, place_of(fresh));
    if (!used_.test(place_of(fresh))) ours.push_back(fresh);
  }
  return ours[taken_[type]++];
}

Argument Ahead::op32(int number, Argument a, Argument b) {
  const Argument result = spare_.allocate(kWord);
  put(number, result, a, b);
  return result;
}

Argument Ahead::op64(int number, Argument a, Argument b) {
  const Argument result = spare_.allocate(kDoubleword);
  put(number, result, a, b);
  return result;
}

void Ahead::put(int number, Argument a, Argument b, Argument c) {
  Operation* operation = functions.tcg_op_insert_before(context(), place_, number);
  operation->arguments[0] = a;
  operation->arguments[1] = b;
  operation->arguments[2] = c;
}

Label* Ahead::branch_if_at_least(Argument a, Argument b) {
  return branch_if(kSigned_at_least, a, b);
}

Label* Ahead::branch_if_not_below(Argument a, Argument b) {
  return branch_if(kNot_below, a, b);
}

Label* Ahead::branch_if(Argument condition, Argument a, Argument b) {
  Label* label = functions.gen_new_label();
  *reinterpret_cast<std::uint32_t*>(label) += kOne_reference;
  Operation* branch = functions.tcg_op_insert_before(context(), place_, known.branch32);
  branch->arguments[0] = a;
  branch->arguments[1] = b;
  branch->arguments[2] = condition;
  branch->arguments[3] = reinterpret_cast<Argument>(label);
  return label;
}

void Ahead::here(Label* label) {
  put(known.label, reinterpret_cast<Argument>(label));
}

}  // namespace whirl::qemu::tcg
