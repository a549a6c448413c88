// SPDX-License-Identifier: GPL-2.0-or-later
//
// Every exception that the core takes or leaves, in the moment when QEMU does it.
//
//   Method   QEMU's CPU class holds a table of the functions that its translator calls; the class gets
//            a copy in which "take an interrupt" is ours. It serves entry, return and tail-chaining.
//   Checked  the table is known by the exported function that it must hold; refused where it is not
//   Source   QEMU 7.2: include/hw/core/{cpu,tcg-cpu-ops}.h, target/arm/m_helper.c
#pragma once
#include <functional>

#include "base/result.hpp"
#include "io_bridges/qemu/plugin/qemu_api.hpp"

namespace whirl::qemu {

// From now on QEMU calls `take` where it would have called api.arm_v7m_cpu_do_interrupt(cpu).
Result<Done> hook_exceptions(const Api& api, Cpu* cpu, std::function<void()> take);

}  // namespace whirl::qemu
