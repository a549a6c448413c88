// SPDX-License-Identifier: GPL-2.0-or-later
//
// QEMU's request that the CPU leave its loop, from the inside.
//
//   Why      each change of a timer asks for it, so that the loop looks at the new deadline. Where the
//            loop is about to look anyway (after a timer's callback, after work done between two runs)
//            the request costs one more turn of it, a microsecond, for nothing
//   When     drop() only there, and only while no other thread asks for anything (not under gdb)
//   Found    by what cpu_exit() changes in a copy of the CPU
//   Source   QEMU 7.2: hw/core/cpu-common.c, softmmu/cpu-timers.c, accel/tcg/tcg-accel-ops-rr.c
#pragma once
#include "io_bridges/qemu/plugin/qemu_api.hpp"

namespace whirl::qemu {

class ExitRequest {
 public:
  // False: cpu_exit() does not do what it does in 7.2.
  bool find(const Api& api, Cpu* cpu);
  void drop() { *flag_ = 0; }

 private:
  volatile std::uint8_t* flag_ = nullptr;
};

}  // namespace whirl::qemu
