// SPDX-License-Identifier: GPL-2.0-or-later
//
// Which instructions of the guest are instrumented, and what happens there.
//
//   Every block       its time is counted (core_clock.hpp), mostly without a call
//   WFI               exact sleep (machine.hpp)
//   Watched function  its first instruction; and the addresses to which it returns: those behind a BL
//                     by the translation of that, others (calls by register, tail calls) at run time,
//                     where a new one throws all translated code away once, so that it is seen
//   Stack pointer     in thread mode every instruction that loads it: MSR, LDR and MOV
//   Cost              a call of about 10 ns at each of these; nothing elsewhere
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <set>
#include <vector>

#include "io_bridges/qemu/board/watch.hpp"
#include "io_bridges/qemu/plugin/machine.hpp"
#include "io_bridges/qemu/plugin/plugin_api.hpp"

namespace whirl::qemu {

class Instruments {
 public:
  explicit Instruments(Machine& machine);

  void translated(qemu_plugin_tb* block);
  void code_thrown_away();

 private:
  enum class Kind : std::uint8_t { sleep, function, return_site, stack_load, stack_move };
  struct Site {
    Instruments* owner;
    Kind kind;
    std::uint16_t number;   // of the watched function
    std::uint32_t address;  // without the Thumb bit
    std::uint32_t place;    // in its block, in instructions
    std::int64_t time;      // for CoreClock::at
  };

  void report_unreachable_code(std::uint32_t address);
  void find_at_start(std::uint32_t address);
  void find_in(const qemu_plugin_insn* insn, std::uint32_t place);
  void learn_return_site(const Code& code, std::uint32_t address);
  void put(qemu_plugin_insn* insn, const Site& site);
  void reached(const Site& site);
  void enter_function(const Site& site);
  board::CoreState core_at(const Site& site) const;

  Machine& machine_;
  std::multimap<std::uint32_t, std::uint16_t> functions_;  // address, watch number
  std::set<std::uint32_t> return_sites_;
  std::set<std::uint32_t> starts_;  // of the blocks that are translated
  std::vector<Site> found_;         // in the block that is being translated
  std::deque<Site> sites_;          // translated code points at them
  bool handler_mode_ = false;
  bool ccm_reported_ = false;
};

}  // namespace whirl::qemu
