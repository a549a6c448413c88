// The byte-wide registers of a part. Every address that the data sheet names is in the map; touching
// any other, writing what is read-only, or asking for what the model does not do is told to the
// witness. Silence is never an answer to strange firmware.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "io_bridges/devices/core/part.hpp"

namespace whirl::core {

enum class Access : std::uint8_t { reserved, read_only, read_write, write_only };
enum class Depth : std::uint8_t { modelled, stored_only };  // stored_only: remembers, no effect

struct RegisterSpec {
  const char* name = "";  // data sheet spelling
  Access access = Access::reserved;
  std::uint8_t reset = 0;
  Depth depth = Depth::modelled;
};

inline constexpr std::size_t kRegisters = 128;
using RegisterMap = std::array<RegisterSpec, kRegisters>;  // by address; beyond it all is reserved

class RegisterFile {
 public:
  // All 0 until the first reset().
  explicit constexpr RegisterFile(const RegisterMap& map) : map_(map) {}

  void reset();
  std::uint8_t read(std::uint8_t address, Witness& witness, Nanoseconds now) const;
  // True when the register took the value (and the part may have to act on it).
  bool write(std::uint8_t address, std::uint8_t value, Witness& witness, Nanoseconds now);

  // The part's own side: no checks, nothing told. Pre: address < kRegisters.
  std::uint8_t peek(std::uint8_t address) const { return bytes_[address]; }
  void poke(std::uint8_t address, std::uint8_t value) { bytes_[address] = value; }
  // What a read of each address answers: reserved and write-only ones hold 0.
  const std::uint8_t* image() const { return bytes_.data(); }

 private:
  const RegisterMap& map_;
  std::array<std::uint8_t, kRegisters> bytes_{};
};

}  // namespace whirl::core
