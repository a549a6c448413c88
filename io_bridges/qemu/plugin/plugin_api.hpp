// SPDX-License-Identifier: GPL-2.0-or-later
//
// The part of QEMU's public plug-in interface (version 1) that the board uses, declared by hand:
// Debian ships no header for it. Source: QEMU 7.2, docs/devel/tcg-plugins.rst.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>

extern "C" {
using qemu_plugin_id_t = std::uint64_t;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
using qemu_plugin_insn_callback = void (*)(unsigned cpu, void* userdata);

std::size_t qemu_plugin_tb_n_insns(const qemu_plugin_tb*);
std::uint64_t qemu_plugin_tb_vaddr(const qemu_plugin_tb*);
qemu_plugin_insn* qemu_plugin_tb_get_insn(const qemu_plugin_tb*, std::size_t);
const void* qemu_plugin_insn_data(const qemu_plugin_insn*);
std::size_t qemu_plugin_insn_size(const qemu_plugin_insn*);
std::uint64_t qemu_plugin_insn_vaddr(const qemu_plugin_insn*);
void qemu_plugin_register_vcpu_insn_exec_cb(qemu_plugin_insn*, qemu_plugin_insn_callback, int flags,
                                            void* userdata);
void qemu_plugin_register_vcpu_tb_exec_cb(qemu_plugin_tb*, qemu_plugin_insn_callback, int flags,
                                          void* userdata);
// operation 0: add `number` to the 64-bit word at `where`
void qemu_plugin_register_vcpu_tb_exec_inline(qemu_plugin_tb*, int operation, void* where,
                                              std::uint64_t number);
void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t,
                                           void (*)(qemu_plugin_id_t, qemu_plugin_tb*));
void qemu_plugin_register_flush_cb(qemu_plugin_id_t, void (*)(qemu_plugin_id_t));
}

namespace whirl::qemu {

// An instruction's half-words; `second` is 0 in a narrow one.
struct Code {
  std::uint16_t first = 0, second = 0;
  bool wide = false;
};

inline Code code_of(const qemu_plugin_insn* insn) {
  Code code;
  const char* bytes = static_cast<const char*>(qemu_plugin_insn_data(insn));
  code.wide = qemu_plugin_insn_size(insn) == 4;
  std::memcpy(&code.first, bytes, 2);
  if (code.wide) std::memcpy(&code.second, bytes + 2, 2);
  return code;
}

}  // namespace whirl::qemu
