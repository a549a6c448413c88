// SPDX-License-Identifier: GPL-2.0-or-later
//
// How QEMU casts the class of its CPU, which it does several times at each register access, exception
// and sleep.
//
//   Why      as Debian builds it, a cast of a class is left unchecked, unless the class has interfaces:
//            then it goes by name, through a hash table. A CPU has those of every device, for its reset
//            and its migration, which nothing asks for while the core runs
//   What     lighten() puts the list of the class's interfaces aside, restore() puts it back. It must be
//            there at a reset of the devices: QEMU's own one before the core runs, and any that gdb's
//            monitor may ask for
//   Source   QEMU 7.2: qom/object.c, include/qom/object.h (struct ObjectClass)
#pragma once
#include "io_bridges/qemu/plugin/qemu_api.hpp"

namespace whirl::qemu {

class ClassCasts {
 public:
  // False: the class is not laid out as in 7.2.
  bool find(const Api& api, Cpu* cpu);
  void lighten() { *interfaces_ = nullptr; }
  void restore() { *interfaces_ = list_; }

 private:
  void** interfaces_ = nullptr;
  void* list_ = nullptr;
};

}  // namespace whirl::qemu
