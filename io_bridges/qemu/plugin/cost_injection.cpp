// SPDX-License-Identifier: GPL-2.0-or-later
#include "io_bridges/qemu/plugin/cost_injection.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "base/check.hpp"
#include "io_bridges/qemu/plugin/operand_cost.hpp"
#include "io_bridges/qemu/plugin/tcg.hpp"

namespace whirl::qemu {
namespace {

using tcg::Argument;
using tcg::Operation;

constexpr std::uint32_t kCount_flags = 0x1FF;  // CF_COUNT_MASK
// As cpu_io_recompile() has it: CF_LAST_IO, CF_MEMI_ONLY, one instruction.
constexpr std::uint32_t kDone_again = 0x18001;
constexpr std::int32_t kFirst_register = 0x40000000;  // from there on there is no memory
constexpr int kPc = 15;
constexpr Argument kMost_temporaries = 512, kRoom_for_exit = 256;  // TCG_MAX_TEMPS
constexpr std::string_view kLazy_save = "v7m_preserve_fp_state";
constexpr std::string_view kUdiv = "udiv", kSdiv = "sdiv";

// Where what is counted when: a place for each instruction, and one behind the last.
std::vector<std::int64_t> places_of(const BlockCost& cost) {
  const std::size_t length = cost.each.size();
  std::vector<std::int64_t> places(length + 1, 0);
  std::size_t place = 0;
  for (std::size_t n = 0; n < length; ++n) {
    const bool last = n + 1 == length;
    // A block of one instruction is what QEMU does again; a branch has left before a place behind it.
    if (cost.kinds[n].memory && length > 1 && !(last && cost.ends_in_branch)) place = n + 1;
    places[place] += cost.each[n] - kUnits_per_ns;
  }
  return places;
}

}  // namespace

// Walks over the operations of one block.
class CostInjection::Writer {
 public:
  Writer(CostInjection& owner, qemu_plugin_tb* block, const BlockCost& cost, bool keep_stalls)
      : owner_(owner),
        block_(block),
        cost_(cost),
        keep_stalls_(keep_stalls),
        places_(places_of(cost)),
        operations_(tcg::operations()),
        spare_(operations_) {}

  void write() {
    const tcg::Numbers& op = tcg::numbers();
    const auto first = std::find_if(
        operations_.begin(), operations_.end(),
        [&](const Operation* o) { return static_cast<int>(o->number) == op.instruction; });
    // Inside an IT block the translator clears its state in memory at the block's start.
    it_state_ = first == operations_.end() ? 0 : static_cast<std::int32_t>((*first)->arguments[1]);
    std::size_t begun = 0;
    std::size_t mark = 0;  // of the instruction whose operations follow
    for (std::size_t k = 0; k < operations_.size(); ++k) {
      Operation& o = *operations_[k];
      const int number = static_cast<int>(o.number);
      const std::string_view helper = tcg::helper_name(o);
      if (number == op.st16 && !stored_) {
        take_off_budget(o);
      } else if (number == op.st32 && begun == 0 && stored_ && enough_ == nullptr) {
        it_store_ = ++stores_ == 2 ? &o : nullptr;
      } else if (number == op.callback && begun == 0 && enough_ == nullptr && stored_) {
        if (it_state_ == 0 || it_store_ != nullptr) guard(o);
      } else if (number == op.callback_end && begun == 0 && enough_ != nullptr && !placed_) {
        go_on(*operations_[k + 1]);
        placed_ = true;
      } else if (number == op.instruction) {
        if (begun > 0) owe(*operations_[k + 1], places_[begun]);
        ++begun;
        mark = k;
      } else if (begun > 0 && (number == op.load32 || number == op.load64)) {
        pay_by_address(o, true, cost_.kinds[begun - 1]);
        expect_register(mark, begun - 1);
      } else if (begun > 0 && number == op.store32) {
        pay_by_address(o, false, cost_.kinds[begun - 1]);
        expect_register(mark, begun - 1);
      } else if (begun > 0 && cost_.kinds[begun - 1].long_multiply &&
                 (number == op.multiply_long || number == op.multiply_long_signed)) {
        pay_for_product(o, number == op.multiply_long_signed);
      } else if (helper == kLazy_save) {
        owe(o, cost_.lazy_frame);
      } else if (helper == kUdiv || helper == kSdiv) {
        pay_for_quotient(o, helper == kSdiv);
      } else if (begun == cost_.each.size() && !left_ &&
                 (number == op.goto_block || number == op.exit_block ||
                  number == op.goto_pointer)) {
        leave(o);
      }
    }
    add_exit();
  }

 private:
  Argument debt_place() { return tcg::address(&owner_.state_.debt); }

  void owe(Operation& place, std::int64_t amount) {
    if (amount == 0) return;
    const tcg::Numbers& op = tcg::numbers();
    tcg::Ahead ahead(&place, spare_);
    const Argument where = debt_place();
    ahead.put(op.st64, ahead.op64(op.add64, ahead.op64(op.ld64, where), tcg::number64(amount)),
              where);
  }

  void owe(tcg::Ahead& ahead, Argument amount) {
    const tcg::Numbers& op = tcg::numbers();
    const Argument where = debt_place();
    ahead.put(op.st64, ahead.op64(op.add64, ahead.op64(op.ld64, where), amount), where);
  }

  Argument times_cycle(tcg::Ahead& ahead, Argument count) {
    return ahead.op64(tcg::numbers().multiply64, count, tcg::number64(cost_.cycle));
  }

  void pay_by_address(Operation& access, bool loads, const BlockCost::Kind& kind) {
    const tcg::Numbers& op = tcg::numbers();
    const bool waits = loads && kind.reads_flash && cost_.flash_wait != 0;
    const bool unaligned = kind.unaligned && tcg::size_log2(access) > 0;
    if (!waits && !unaligned) return;
    tcg::Ahead ahead(&access, spare_);
    FlashLines* cache = cost_.data_cache ? &owner_.state_.data : nullptr;
    Argument cost = 0;
    if (waits) cost = flash_wait(ahead, cache, access.arguments[1], cost_.flash_wait);
    if (unaligned) {
      const Argument more = times_cycle(ahead, unaligned_cycles(ahead, access));
      cost = waits ? ahead.op64(op.add64, cost, more) : more;
    }
    owe(ahead, cost);
  }

  void pay_for_quotient(Operation& call, bool with_sign) {
    const auto [dividend, divisor] = tcg::last_inputs(call);
    tcg::Ahead ahead(&call, spare_);
    owe(ahead, times_cycle(ahead, quotient_steps(ahead, dividend, divisor, with_sign)));
  }

  void pay_for_product(Operation& multiply, bool with_sign) {
    tcg::Ahead ahead(&multiply, spare_);
    const Argument a = multiply.arguments[2], b = multiply.arguments[3];  // behind two results
    owe(ahead, times_cycle(ahead, long_multiply_steps(ahead, a, b, with_sign)));
  }

  // Adds what a line costs that is not among the last 64 fetched, and counts it as fetched.
  void look_up(Operation& place, Argument debt, const BlockCost::Line& line, Argument when) {
    const tcg::Numbers& op = tcg::numbers();
    tcg::Ahead ahead(&place, spare_);
    FlashLines& lines = owner_.state_.code;
    const Argument where = tcg::address(&lines.filled[line.number % FlashLines::kLines]);
    const Argument missed = missed_line(ahead, lines, where, when);
    ahead.put(op.add64, debt, debt, ahead.op64(op.and64, missed, tcg::number64(line.missed)));
  }

  void add_fetches(Operation& place, Argument debt, Argument entered) {
    const tcg::Numbers& op = tcg::numbers();
    tcg::Ahead ahead(&place, spare_);
    const Argument before = keep_stalls_ ? ahead.op64(op.move64, debt) : 0;
    if (cost_.entry != 0) {
      const Argument entry = ahead.op64(op.and64, entered, tcg::number64(cost_.entry));
      ahead.put(op.add64, debt, debt, entry);
    }
    for (const BlockCost::Line& line : cost_.lines) {
      look_up(place, debt, line, &line == &cost_.lines.front() ? entered : 0);
    }
    if (keep_stalls_) {
      ahead.put(op.st64, ahead.op64(op.sub64, debt, before), tcg::address(&owner_.state_.stalled));
    }
  }

  // `store` puts QEMU's budget back, already less the block's instructions: less the debt as well, but
  // not below 0. Nor is it given any back for a debt below 0: it may be full, in its 16 bits.
  void take_off_budget(Operation& store) {
    const tcg::Numbers& op = tcg::numbers();
    owner_.find_budget(static_cast<std::intptr_t>(store.arguments[2]));
    environment_ = store.arguments[1];
    tcg::Ahead ahead(&store, spare_);
    const Argument where = debt_place(), flag = tcg::address(&owner_.state_.entered);
    const Argument debt =
        ahead.op64(op.add64, ahead.op64(op.ld64, where), tcg::number64(places_[0]));
    add_fetches(store, debt, ahead.op64(op.ld64, flag));
    const auto below_0 = [&](Argument x) {
      return ahead.op64(op.and64, ahead.op64(op.sar64, x, tcg::number64(63)), x);
    };
    const Argument whole = ahead.op64(op.sar64, debt, tcg::number64(kUnit_shift));
    const Argument ns = ahead.op64(op.sub64, whole, below_0(whole));
    left_ns_ = store.arguments[0];  // a local of QEMU's: it lives on behind the next branch
    const Argument left = ahead.op64(op.sub64, ahead.op64(op.widen, left_ns_), ns);
    const Argument beyond = below_0(left);
    const Argument kept = ahead.op64(op.sub64, left, beyond);
    ahead.put(op.move32, left_ns_, kept);
    const Argument paid =
        ahead.op64(op.shl64, ahead.op64(op.add64, ns, beyond), tcg::number64(kUnit_shift));
    ahead.put(op.st64, ahead.op64(op.sub64, debt, paid), where);
    ahead.put(op.st64, tcg::number64(0), flag);
    stored_ = true;
  }

  // Around the block's public callback: past it when the budget lasts for all that is still to come.
  void guard(Operation& place) {
    const std::int64_t charged =
        places_[0] + static_cast<std::int64_t>(cost_.each.size()) * kUnits_per_ns;
    const std::int64_t later =
        std::accumulate(cost_.each.begin(), cost_.each.end(), std::int64_t{0}) - charged;
    // One more: a budget of 0 may be one that did not last.
    const auto enough = static_cast<std::int32_t>((later >> kUnit_shift) + 1);
    enough_ = tcg::Ahead(&place, spare_).branch_if_at_least(left_ns_, tcg::number32(enough));
    set_it_state(place, it_state_);
    owner_.blocks_.push_back(std::make_unique<Block>(Block{&owner_, charged, cost_.each}));
    qemu_plugin_register_vcpu_tb_exec_cb(
        block_,
        [](unsigned, void* data) {
          const Block& block = *static_cast<const Block*>(data);
          block.owner->too_short(block);
        },
        0, owner_.blocks_.back().get());
  }

  // The callback came back: the block runs.
  void go_on(Operation& place) {
    set_it_state(place, 0);
    tcg::Ahead(&place, spare_).here(enough_);
  }

  void set_it_state(Operation& place, std::int32_t state) {
    if (it_state_ == 0) return;
    tcg::Ahead(&place, spare_)
        .put(tcg::numbers().st32, tcg::number32(state), it_store_->arguments[1],
             it_store_->arguments[2]);
  }

  // QEMU leaves a block where it comes to a register and has that instruction done again by itself, so
  // that the clock may be read there. It finds out late; where it is to be expected, the block is left
  // as QEMU would leave it, but ahead of the instruction. Not within an IT block, whose state would
  // have to be put back. Behind the first such place a block hardly ever goes on. A block of one
  // instruction is what is done again.
  void expect_register(std::size_t mark, std::size_t n) {
    if (exit_ || cost_.each.size() == 1 || cost_.kinds[n].leads_to_register < 0) return;
    if (!stored_ || it_state_ != 0 || operations_[mark]->arguments[1] != 0) return;
    const Argument pc = global(kPc);
    for (std::size_t k = 0; k < mark; ++k) {
      if (tcg::writes(*operations_[k], pc)) return;
    }
    exit_ = Exit{n, behind_callbacks(mark)};
  }

  Argument global(int core_register) const {
    return tcg::global_at(environment_, core_register * 4);
  }

  // The first operation of an instruction's own.
  std::size_t behind_callbacks(std::size_t mark) const {
    const auto is = [this](std::size_t k, int number) {
      return static_cast<int>(operations_[k]->number) == number;
    };
    std::size_t k = mark + 1;
    while (is(k, tcg::numbers().callback)) {
      while (!is(k, tcg::numbers().callback_end)) ++k;
      ++k;
    }
    return k;
  }

  // A block of too many temporaries would be translated in parts, and its time be another.
  bool has_room_for_exit() const {
    const Argument first = global(0), size = global(1) - first;
    if (first == 0 || global(kPc) == 0) return false;
    const Argument end = environment_ + kMost_temporaries * size;
    Argument last = 0;
    for (const Operation* operation : tcg::operations()) {
      for (const Argument argument : tcg::arguments_of(*operation)) {
        if (argument >= environment_ && argument < end) last = std::max(last, argument);
      }
    }
    return last + kRoom_for_exit * size < end;
  }

  void add_exit() {
    if (!exit_ || !has_room_for_exit()) return;
    const tcg::Numbers& op = tcg::numbers();
    const std::uint32_t flags = owner_.api_.curr_cflags(owner_.api_.qemu_get_cpu(0)) | kDone_again;
    const Argument again = tcg::number32(static_cast<std::int32_t>(flags));
    const Argument base = global(cost_.kinds[exit_->n].leads_to_register), pc = global(kPc);
    tcg::Label* const out = tcg::Ahead(operations_[exit_->place], spare_)
                                .branch_if_not_below(base, tcg::number32(kFirst_register));
    Operation* const end = tcg::add_instruction_mark();
    {
      tcg::Ahead ahead(end, spare_);
      ahead.here(out);
      const Argument low = tcg::address(owner_.count_.low());
      const auto undone = static_cast<std::int32_t>(cost_.each.size() - exit_->n);
      const Argument left =
          ahead.op32(op.add32, ahead.op32(op.load_half32, low), tcg::number32(undone));
      ahead.put(op.st16, left, low);
      ahead.put(op.st32, again, tcg::address(owner_.count_.next_flags()));
      ahead.put(op.add32, pc, pc,
                tcg::number32(static_cast<std::int32_t>(cost_.offsets[exit_->n])));
      ahead.put(op.exit_block, 0);
    }
    tcg::remove(end);
  }

  // The first way out behind the last instruction is that of a taken branch, or of running on.
  void leave(Operation& place) {
    left_ = true;
    owe(place, places_.back());
    if (!cost_.ends_in_branch) return;
    owe(place, cost_.taken);
    tcg::Ahead(&place, spare_)
        .put(tcg::numbers().st64, tcg::number64(-1), tcg::address(&owner_.state_.entered));
  }

  struct Exit {
    std::size_t n = 0;      // instruction that is to be done by itself
    std::size_t place = 0;  // operation ahead of which the block is left
  };

  CostInjection& owner_;
  qemu_plugin_tb* block_;
  const BlockCost& cost_;
  const bool keep_stalls_;
  const std::vector<std::int64_t> places_;
  const std::vector<Operation*> operations_;
  tcg::Spare spare_;
  Argument left_ns_ = 0;
  std::int32_t it_state_ = 0;            // of the IT block that the block begins in
  const Operation* it_store_ = nullptr;  // where the translator clears it: behind that of can_do_io
  int stores_ = 0;
  tcg::Label* enough_ = nullptr;
  std::optional<Exit> exit_;
  Argument environment_ = 0;  // points to the CPU's: R0 to R15 are its first words
  bool stored_ = false, placed_ = false, left_ = false;
};

Result<Done> CostInjection::find_qemu() {
  if (auto found = tcg::find(); !found) return found;
  return count_.find_timers();
}

void CostInjection::find_budget(std::intptr_t decrementer) {
  if (count_.found()) return;
  if (!count_.find_budget(api_.qemu_get_cpu(0), decrementer)) refuse_();
}

void CostInjection::put(qemu_plugin_tb* block, const BlockCost& cost, bool keep_stalls) {
  Writer(*this, block, cost, keep_stalls).write();
}

std::int64_t CostInjection::ahead_at(const BlockCost& cost, std::size_t n) {
  const std::vector<std::int64_t> places = places_of(cost);
  const auto at = [](const std::vector<std::int64_t>& v, std::size_t count) {
    return std::accumulate(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(count),
                           std::int64_t{0});
  };
  return at(places, n + 1) + static_cast<std::int64_t>(cost.each.size()) * kUnits_per_ns -
         at(cost.each, n);
}

void CostInjection::settle() {
  if (!count_.found() || state_.debt <= 0) return;
  state_.debt -= count_.take_ns(state_.debt >> kUnit_shift) << kUnit_shift;
}

// Called, rarely, when the budget may not last for the whole block. Gives back what was taken off, and
// has the block done again up to the instruction in which the deadline falls.
void CostInjection::too_short(const Block& block) {
  Cpu* cpu = api_.qemu_get_cpu(0);
  const std::uint32_t flags = api_.curr_cflags(cpu);
  if ((flags & kCount_flags) != 0) return;  // gdb steps
  const std::int64_t had = (count_.left_ns() << kUnit_shift) - state_.debt + block.charged;
  std::size_t fit = 0;
  for (std::int64_t spent = 0; fit < block.each.size() && spent < had; ++fit)
    spent += block.each[fit];
  if (fit == block.each.size()) return;
  const std::int64_t left = had <= 0 ? 0 : (had + kUnits_per_ns - 1) >> kUnit_shift;
  count_.set_left_ns(left);
  state_.debt = (left << kUnit_shift) - had;
  asked_for_part_ = fit > 0;
  if (fit > 0) count_.limit_next_block(flags | static_cast<std::uint32_t>(fit));
  api_.cpu_loop_exit_noexc(cpu);
}

}  // namespace whirl::qemu
