// The firmware image: one or two ELF files for the part, checked before anything runs.
//
//   Out     what goes into flash (program headers with file content, at their load addresses), the
//           function and object symbols, names demangled; what is odd about it, in words
//   Start   the core starts from the vector table, as the part does; an ELF's entry point is for
//           debuggers. What lies in RAM is not loaded: no flasher does
//   Errors  bad_input: missing, not ELF, not 32-bit little-endian ARM, for a larger core than the
//           part's, beyond the part's flash, overlapping, cut off, no vector table where it starts
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "io_bridges/qemu/board/parts.hpp"

namespace whirl::board {

struct Segment {
  std::uint32_t address = 0;
  std::vector<std::uint8_t> bytes;
};

struct Symbol {
  std::uint32_t address = 0;  // without the Thumb bit
  std::uint32_t size = 0;
  bool function = false;
  std::string name;  // demangled
  std::string mangled;
};

class Image {
 public:
  const std::vector<Segment>& segments() const { return segments_; }
  const std::vector<Symbol>& symbols() const { return symbols_; }  // sorted by address

  const std::vector<std::string>& oddities() const { return oddities_; }

  // A second file beside this one (a boot loader). The error names what is in each other's way.
  Result<Done> add(Image other, const std::string& path);
  // A word of what is loaded; null: nothing is there.
  std::optional<std::uint32_t> word_at(std::uint32_t address) const;

  const Symbol* function_at(std::uint32_t address) const;  // the one that contains it, or null
  const Symbol* object_at(std::uint32_t address) const;
  // By mangled name, demangled name, or demangled name up to its parenthesis.
  std::vector<const Symbol*> functions_named(const std::string& name) const;
  const Symbol* object_named(const std::string& name) const;
  // "fw::attitude_task()+0x12" or "0x08001234".
  std::string describe(std::uint32_t address) const;

 private:
  friend Result<Image> load_image(const std::string& path, const Part& part);
  std::vector<Segment> segments_;
  std::vector<Symbol> symbols_;
  std::vector<std::string> oddities_;
};

Result<Image> load_image(const std::string& path, const Part& part);
// Is there a vector table at the address from which the core starts?
Result<Done> check_start(const Image& image, const std::string& path, std::uint32_t start);

}  // namespace whirl::board
