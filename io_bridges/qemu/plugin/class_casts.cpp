// SPDX-License-Identifier: GPL-2.0-or-later
#include "io_bridges/qemu/plugin/class_casts.hpp"

namespace whirl::qemu {

// Put to the test: without the list the class has no interface, but is a CPU all the same.
bool ClassCasts::find(const Api& api, Cpu* cpu) {
  constexpr int kInterfaces = 1;  // word of ObjectClass
  void* const type = api.object_get_class(cpu);
  const auto is_a = [&](const char* name) {
    return api.object_class_dynamic_cast(type, name) != nullptr;
  };
  const auto has_interface = [&] { return is_a("vmstate-if") || is_a("resettable"); };
  if (!has_interface()) return false;
  interfaces_ = static_cast<void**>(type) + kInterfaces;
  list_ = *interfaces_;
  lighten();
  const bool lighter = !has_interface() && is_a("cpu");
  restore();
  return lighter && has_interface();
}

}  // namespace whirl::qemu
