#include "io_bridges/devices/register_file.hpp"

#include <cstdio>

namespace whirl::io {

RegisterFile::RegisterFile(std::span<const RegisterSpec> specs, std::string where,
                           FindingSink findings)
    : specs_(specs), where_(std::move(where)), findings_(std::move(findings)) {
  reset();
}

void RegisterFile::reset() {
  bytes_.fill(0);
  for (const RegisterSpec& r : specs_) bytes_[r.address] = r.reset;
}

const RegisterSpec* RegisterFile::spec(std::uint8_t address) const {
  for (const RegisterSpec& r : specs_) {
    if (r.address == address) return &r;
  }
  return nullptr;
}

void RegisterFile::report(Nanoseconds now, const std::string& what) {
  findings_.report({now, where_, what});
}

void RegisterFile::report_at(Nanoseconds now, std::uint8_t address, const char* what) {
  char text[120];
  const RegisterSpec* r = spec(address);
  std::snprintf(text, sizeof text, "register 0x%02X %s: %s", address, r == nullptr ? "" : r->name,
                what);
  report(now, text);
}

std::uint8_t RegisterFile::read(std::uint8_t address, Nanoseconds now) {
  const RegisterSpec* r = spec(address);
  if (r == nullptr) report_at(now, address, "read of a reserved address");
  return r == nullptr || r->access == Access::write_only ? 0 : bytes_[address];
}

bool RegisterFile::write(std::uint8_t address, std::uint8_t value, Nanoseconds now) {
  const RegisterSpec* r = spec(address);
  if (r == nullptr || r->access == Access::read_only) {
    report_at(now, address,
              r == nullptr ? "write to a reserved address" : "write to a read-only one");
    return false;
  }
  if (r->depth == Depth::stored_only && value != r->reset) {
    report_at(now, address, "setting stored, but this model does not act on it");
  }
  bytes_[address] = value;
  return true;
}

}  // namespace whirl::io
