// SPDX-License-Identifier: GPL-2.0-or-later
#include "io_bridges/qemu/plugin/exception_hook.hpp"

#include <link.h>
#include <malloc.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace whirl::qemu {
namespace {

constexpr std::size_t kTable = 32;  // pointers; TCGCPUOps of 7.2 has fewer

std::function<void()> take_exception;  // QEMU's table carries no pointer of ours

// Is [from, from + size) in the program's own file? (The first object that the loader names.)
bool in_program(std::uintptr_t from, std::size_t size) {
  struct Range {
    std::uintptr_t from;
    std::size_t size;
    bool inside;
  } range{from, size, false};
  dl_iterate_phdr(
      [](dl_phdr_info* object, std::size_t, void* data) {
        auto& asked = *static_cast<Range*>(data);
        for (int i = 0; i < object->dlpi_phnum; ++i) {
          const ElfW(Phdr)& part = object->dlpi_phdr[i];
          const std::uintptr_t begin = object->dlpi_addr + part.p_vaddr;
          asked.inside |= part.p_type == PT_LOAD && asked.from >= begin &&
                          asked.from + asked.size <= begin + part.p_memsz;
        }
        return 1;  // no further object
      },
      &range);
  return range.inside;
}

std::size_t place_of(std::span<void* const> table, const void* function) {
  return static_cast<std::size_t>(std::find(table.begin(), table.end(), function) - table.begin());
}

}  // namespace

Result<Done> hook_exceptions(const Api& api, Cpu* cpu, std::function<void()> take) {
  const auto* original = reinterpret_cast<const void*>(api.arm_v7m_cpu_do_interrupt);
  void** const members = static_cast<void**>(api.object_get_class(cpu));
  for (void*& member : std::span(members, malloc_usable_size(members) / sizeof *members)) {
    if (reinterpret_cast<std::uintptr_t>(member) % alignof(void*) != 0) continue;
    if (!in_program(reinterpret_cast<std::uintptr_t>(member), kTable * sizeof(void*))) continue;
    const std::span<void* const> table(static_cast<void* const*>(member), kTable);
    const std::size_t place = place_of(table, original);
    if (place == kTable) continue;
    static std::vector<void*> copy;
    copy.assign(table.begin(), table.end());
    take_exception = std::move(take);
    copy[place] = reinterpret_cast<void*>(+[](Cpu*) { take_exception(); });
    member = copy.data();
    return Done{};
  }
  return whirl::Error{ErrorKind::host, "QEMU",
                      "its CPU class takes exceptions by no function known",
                      std::string("use QEMU ") + tested_versions()};
}

}  // namespace whirl::qemu
