// SPDX-License-Identifier: GPL-2.0-or-later
#include "io_bridges/qemu/plugin/qemu_api.hpp"

#include <dlfcn.h>

namespace whirl::qemu {

std::vector<std::string> resolve(Api& api) {
  std::vector<std::string> missing;
  const auto find = [&missing](const char* name) {
    void* address = dlsym(RTLD_DEFAULT, name);
    if (address == nullptr) missing.emplace_back(name);
    return address;
  };
#define WHIRL_RESOLVE(name, result, parameters) \
  api.name = reinterpret_cast<decltype(api.name)>(find(#name));
  WHIRL_QEMU_FUNCTIONS(WHIRL_RESOLVE)
#undef WHIRL_RESOLVE
  api.address_space_memory = static_cast<AddressSpace*>(find("address_space_memory"));
  return missing;
}

Version version_of(const Api& api) {
  Version version;
  Error* error = nullptr;
  const VersionInfo* info = api.qmp_query_version(&error);
  if (info == nullptr) return version;
  const VersionTriple& n = *info->qemu;
  version.number =
      std::to_string(n.major) + "." + std::to_string(n.minor) + "." + std::to_string(n.micro);
  version.package = info->package == nullptr ? "" : info->package;
  version.tested = n.major == 7 && n.minor == 2;
  return version;
}

const char* tested_versions() {
  return "7.2 (Debian 12)";
}

}  // namespace whirl::qemu
