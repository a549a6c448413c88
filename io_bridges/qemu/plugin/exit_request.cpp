// SPDX-License-Identifier: GPL-2.0-or-later
#include "io_bridges/qemu/plugin/exit_request.hpp"

#include <cstring>
#include <vector>

namespace whirl::qemu {
namespace {

// cpu_exit() follows one pointer; no byte of any may be touched.
bool is_pointer(std::uint64_t word) {
  return (word >> 48) == 0 && (word >> 32) != 0;
}

}  // namespace

// A request may stand already. So each byte that is 1 is put to the test, in a copy of the CPU: whether
// cpu_exit() sets it again.
bool ExitRequest::find(const Api& api, Cpu* cpu) {
  constexpr std::size_t kSearched = 2048, kWord_B = sizeof(std::uint64_t);
  api.cpu_exit(cpu);
  std::vector<std::uint64_t> copy(api.object_type_get_instance_size(api.object_get_typename(cpu)) /
                                  kWord_B);
  std::memcpy(copy.data(), cpu, copy.size() * kWord_B);
  auto* const bytes = reinterpret_cast<std::uint8_t*>(copy.data());
  for (std::size_t at = 0; at < kSearched; ++at) {
    if (bytes[at] != 1 || is_pointer(copy[at / kWord_B])) continue;
    bytes[at] = 0;
    api.cpu_exit(reinterpret_cast<Cpu*>(copy.data()));
    if (bytes[at] == 1) {
      if (flag_ != nullptr) return false;
      flag_ = reinterpret_cast<std::uint8_t*>(cpu) + at;
    }
    bytes[at] = 1;
  }
  return flag_ != nullptr;
}

}  // namespace whirl::qemu
