// SPDX-License-Identifier: GPL-2.0-or-later
#include "io_bridges/qemu/plugin/instruments.hpp"

#include <optional>

#include "base/text.hpp"

namespace whirl::qemu {
namespace {

constexpr int kXpsr = 25;
constexpr std::uint32_t kIpsr = 0x1FF;
constexpr std::uint32_t kLongest = 4;  // instruction, bytes

bool is_wfi(const Code& code) {
  return !code.wide && code.first == 0xBF30;
}

// MOV SP, Rm: ARMv7-M ARM A7.7.77.
bool moves_to_sp(const Code& code) {
  if (!code.wide) return (code.first & 0xFF87) == 0x4685;
  return code.first == 0xEA4F && (code.second & 0xFFF0) == 0x0D00;
}

// LDR SP, [..] (A7.7.43 to 45), MSR of MSP, PSP or CONTROL (B5.2.3).
bool loads_sp(const Code& code) {
  if (!code.wide) return false;
  const bool ldr = (code.first & 0xFF70) == 0xF850 && (code.second >> 12) == 13;
  const int special = code.second & 0xFF;
  const bool msr = (code.first & 0xFFF0) == 0xF380 && (code.second & 0xFF00) == 0x8800;
  return ldr || (msr && (special == 8 || special == 9 || special == 20));
}

// BL (A7.7.18, encoding T1): where it goes.
std::optional<std::uint32_t> called_by(const Code& code, std::uint32_t address) {
  if (!code.wide || (code.first & 0xF800) != 0xF000 || (code.second & 0xD000) != 0xD000) return {};
  const std::uint32_t sign = (code.first >> 10) & 1;
  const std::uint32_t i1 = ~((code.second >> 13) ^ sign) & 1,
                      i2 = ~((code.second >> 11) ^ sign) & 1;
  const std::uint32_t offset = (0u - sign) << 24 | i1 << 23 | i2 << 22 |
                               (code.first & 0x3FFu) << 12 | (code.second & 0x7FFu) << 1;
  return address + kLongest + offset;
}

}  // namespace

Instruments::Instruments(Machine& machine) : machine_(machine) {
  const auto& watched = machine.board().description().watch;
  for (std::size_t i = 0; i < watched.size(); ++i) {
    for (const board::Symbol* symbol : machine.board().image().functions_named(watched[i])) {
      functions_.emplace(symbol->address, static_cast<std::uint16_t>(i));
    }
  }
}

void Instruments::translated(qemu_plugin_tb* block) {
  const std::size_t length = qemu_plugin_tb_n_insns(block);
  handler_mode_ = (machine_.core_register(kXpsr) & kIpsr) != 0;
  found_.clear();
  const auto start = static_cast<std::uint32_t>(qemu_plugin_tb_vaddr(block));
  starts_.insert(start);
  report_unreachable_code(start);
  machine_.code_translated(start, start + kLongest * static_cast<std::uint32_t>(length));
  find_at_start(start);
  for (std::size_t i = 0; i < length; ++i) {
    find_in(qemu_plugin_tb_get_insn(block, i), static_cast<std::uint32_t>(i));
  }
  std::vector<std::uint32_t> places;
  for (const Site& site : found_) places.push_back(site.place);
  const std::vector<std::int64_t> times = machine_.clock().translated(block, places);
  for (std::size_t n = 0; n < found_.size(); ++n) {
    found_[n].time = times[n];
    put(qemu_plugin_tb_get_insn(block, found_[n].place), found_[n]);
  }
  machine_.keep_room_for_code(length);
}

// CCM hangs on the data bus alone (RM0090 2.3.1): on the part this fetch is a bus fault. QEMU takes code
// from any memory.
void Instruments::report_unreachable_code(std::uint32_t address) {
  const board::MemoryBlock& ccm = machine_.board().part().ccm;
  if (ccm_reported_ || address - ccm.base >= ccm.size) return;
  ccm_reported_ = true;
  machine_.board().report(
      {machine_.clock().core_now(), "core",
       "code is fetched from CCM at " + hex(address) + ": on the part, a bus fault"});
}

void Instruments::code_thrown_away() {
  sites_.clear();
  starts_.clear();
  machine_.code_thrown_away();
}

void Instruments::find_at_start(std::uint32_t address) {
  if (return_sites_.count(address) != 0) {
    found_.push_back({this, Kind::return_site, 0, address, 0, 0});
  }
  const auto [first, last] = functions_.equal_range(address);
  for (auto it = first; it != last; ++it) {
    found_.push_back({this, Kind::function, it->second, address, 0, 0});
  }
}

void Instruments::find_in(const qemu_plugin_insn* insn, std::uint32_t place) {
  const Code code = code_of(insn);
  learn_return_site(code, static_cast<std::uint32_t>(qemu_plugin_insn_vaddr(insn)));
  if (is_wfi(code)) found_.push_back({this, Kind::sleep, 0, 0, place, 0});
  if (handler_mode_) return;  // where a handler leaves its thread is seen at its return
  if (loads_sp(code)) found_.push_back({this, Kind::stack_load, 0, 0, place, 0});
  if (moves_to_sp(code)) found_.push_back({this, Kind::stack_move, 0, 0, place, 0});
}

// Behind a call that is seen before anything behind it is translated, no code need be thrown away.
void Instruments::learn_return_site(const Code& code, std::uint32_t address) {
  const auto function = called_by(code, address);
  const std::uint32_t behind = address + kLongest;
  if (function && functions_.contains(*function) && !starts_.contains(behind))
    return_sites_.insert(behind);
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
  return machine_.core_at(machine_.clock().at(site.time));
}

void Instruments::reached(const Site& site) {
  switch (site.kind) {
    case Kind::sleep:
      return machine_.before_sleep(site.time);
    case Kind::function:
      return enter_function(site);
    case Kind::return_site:
      return machine_.board().watch().return_site(site.address, core_at(site));
    case Kind::stack_load:
    case Kind::stack_move:
      return machine_.board().watch().stack_pointer_loads(core_at(site),
                                                          site.kind == Kind::stack_load);
  }
}

void Instruments::enter_function(const Site& site) {
  const board::CoreState core = core_at(site);
  machine_.board().watch().enter_function(site.number, core);
  if (core.lr >= board::kExc_return) return;
  if (return_sites_.insert(core.lr & ~1u).second) machine_.throw_code_away();
}

}  // namespace whirl::qemu
