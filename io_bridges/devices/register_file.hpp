// The byte-wide registers of a simulated part. Every address that the datasheet names is in the
// spec; touching any other, writing what is read-only, or asking for what the model does not do is
// a finding, told once per register. Silence is never an answer to strange firmware.
#pragma once
#include <array>
#include <cstdint>
#include <set>
#include <span>
#include <string>

#include "io_bridges/devices/bus.hpp"

namespace whirl::io {

enum class Access : std::uint8_t { read_only, read_write, write_only };
enum class Depth : std::uint8_t { modelled, stored_only };  // stored_only: remembers, no effect

struct RegisterSpec {
  std::uint8_t address;
  const char* name;  // datasheet spelling
  Access access;
  std::uint8_t reset;
  Depth depth;
};

class RegisterFile {
 public:
  RegisterFile(std::span<const RegisterSpec> specs, std::string where, FindingSink findings);

  void reset();
  std::uint8_t read(std::uint8_t address, Nanoseconds now);
  // True when the register took the value (and the part may have to act on it).
  bool write(std::uint8_t address, std::uint8_t value, Nanoseconds now);

  // The part's own side: no checks, no findings.
  std::uint8_t peek(std::uint8_t address) const { return bytes_[address]; }
  void poke(std::uint8_t address, std::uint8_t value) { bytes_[address] = value; }

  // A finding about this part, told once per text.
  void report(Nanoseconds now, const std::string& what);

 private:
  const RegisterSpec* spec(std::uint8_t address) const;
  void report_at(Nanoseconds now, std::uint8_t address, const char* what);

  std::span<const RegisterSpec> specs_;
  std::array<std::uint8_t, 256> bytes_{};
  std::string where_;
  OnceFindings findings_;
};

}  // namespace whirl::io
