// SPDX-License-Identifier: GPL-2.0-or-later
#include "io_bridges/qemu/plugin/instruments.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace whirl::qemu {
namespace {

constexpr int kSp = 13, kLr = 14, kXpsr = 25;
constexpr std::uint32_t kIpsr = 0x1FF;
constexpr std::uint32_t kExcReturn = 0xFFFFFFE0u;
constexpr std::size_t kVectors = 16 + 82;
constexpr std::uint32_t kStackedXpsr = 28;  // offset in the exception frame

struct Code {
  std::uint16_t first = 0, second = 0;
  bool wide = false;
};

Code code_of(const qemu_plugin_insn* insn) {
  Code code;
  const std::size_t size = qemu_plugin_insn_size(insn);
  std::memcpy(&code.first, qemu_plugin_insn_data(insn), 2);
  if (size == 4) {
    std::memcpy(&code.second, static_cast<const char*>(qemu_plugin_insn_data(insn)) + 2, 2);
  }
  code.wide = size == 4;
  return code;
}

bool is_wfi(const Code& code) {
  return !code.wide && code.first == 0xBF30;
}

// Instructions that may load EXC_RETURN into PC (ARMv7-M ARM B1.5.8): BX, POP, LDM, LDR.
bool may_return(const Code& code) {
  if (!code.wide) return (code.first & 0xFF87) == 0x4700 || (code.first & 0xFF00) == 0xBD00;
  const bool ldm = (code.first & 0xFFD0) == 0xE890 || (code.first & 0xFFD0) == 0xE910;
  if (ldm) return (code.second & 0x8000) != 0;
  return (code.first & 0xFF70) == 0xF850 && (code.second >> 12) == 15;
}

}  // namespace

Instruments::Instruments(Machine& machine) : machine_(machine) {
  const auto& watched = machine.board().config().watch;
  for (std::size_t i = 0; i < watched.size(); ++i) {
    for (const board::Symbol* symbol : machine.board().image().functions_named(watched[i])) {
      functions_.emplace(symbol->address, static_cast<std::uint16_t>(i));
    }
  }
}

bool Instruments::is_handler(std::uint32_t address) const {
  std::array<std::uint32_t, kVectors> table{};
  const std::uint32_t base = machine_.system_control().vector_table();
  if (!machine_.look(base, table.data(), sizeof table)) return false;
  return std::any_of(table.begin() + 2, table.end(),
                     [&](std::uint32_t entry) { return (entry & ~1u) == address; });
}

void Instruments::translated(qemu_plugin_tb* block) {
  const std::size_t length = qemu_plugin_tb_n_insns(block);
  const auto start = static_cast<std::uint32_t>(qemu_plugin_tb_vaddr(block));
  qemu_plugin_register_vcpu_tb_exec_inline(block, 0, &machine_.timeline().instructions, length);
  machine_.note_block(start, static_cast<std::uint32_t>(qemu_plugin_insn_vaddr(
                                 qemu_plugin_tb_get_insn(block, length - 1))));
  handler_mode_ = (machine_.core_register(kXpsr) & kIpsr) != 0;
  put_block_start(qemu_plugin_tb_get_insn(block, 0), start, static_cast<std::uint32_t>(length));
  for (std::size_t i = 0; i < length; ++i) {
    put_instruction(qemu_plugin_tb_get_insn(block, i), static_cast<std::uint32_t>(length - i));
  }
}

void Instruments::put_block_start(qemu_plugin_insn* insn, std::uint32_t address,
                                  std::uint32_t length) {
  if (handler_mode_ && is_handler(address)) put(insn, {this, Kind::handler, 0, address, length});
  if (return_sites_.count(address) != 0) {
    put(insn, {this, Kind::return_site, 0, address, length});
  }
  const auto [first, last] = functions_.equal_range(address);
  for (auto it = first; it != last; ++it) {
    put(insn, {this, Kind::function, it->second, address, length});
  }
}

void Instruments::put_instruction(qemu_plugin_insn* insn, std::uint32_t behind) {
  const Code code = code_of(insn);
  if (is_wfi(code)) put(insn, {this, Kind::sleep, 0, 0, behind});
  if (handler_mode_ && may_return(code)) put(insn, {this, Kind::handler_exit, 0, 0, behind});
}

void Instruments::put(qemu_plugin_insn* insn, const Site& site) {
  sites_.push_back(site);
  qemu_plugin_register_vcpu_insn_exec_cb(
      insn,
      [](unsigned, void* data) {
        const Site& reached_site = *static_cast<Site*>(data);
        reached_site.owner->reached(reached_site);
      },
      0, &sites_.back());
}

board::CoreState Instruments::core_at(const Site& site) const {
  return {machine_.timeline().at(site.behind), machine_.core_register(kXpsr) & kIpsr,
          machine_.core_register(kSp), machine_.core_register(kLr)};
}

void Instruments::reached(const Site& site) {
  switch (site.kind) {
    case Kind::sleep:
      return machine_.before_sleep();
    case Kind::function:
      return enter_function(site);
    case Kind::return_site:
      return machine_.board().watch().return_site(site.address, core_at(site));
    case Kind::handler:
      return enter_handler(site);
    case Kind::handler_exit:
      return machine_.board().watch().may_leave_exception(machine_.timeline().at(site.behind - 1));
  }
}

void Instruments::enter_function(const Site& site) {
  const board::CoreState core = core_at(site);
  machine_.board().watch().enter_function(site.number, core);
  if (core.lr >= kExcReturn) return;
  if (return_sites_.insert(core.lr & ~1u).second) machine_.throw_code_away();
}

void Instruments::enter_handler(const Site& site) {
  const board::CoreState core = core_at(site);
  if (core.lr < kExcReturn) return;  // an ordinary call of that function
  const std::uint32_t frame = (core.lr & 4u) != 0 ? machine_.process_stack_pointer() : core.sp;
  std::uint32_t xpsr = 0;
  machine_.look(frame + kStackedXpsr, &xpsr, sizeof xpsr);
  machine_.board().exception_entered(xpsr & kIpsr, frame, core,
                                     [this](int number) { return machine_.core_register(number); });
}

}  // namespace whirl::qemu
