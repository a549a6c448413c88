// The firmware image: an ELF file for the part, checked before anything runs.
//
//   Out     what goes into flash (program headers with file content, at their load addresses), the
//           function and object symbols, names demangled
//   Errors  bad_input: missing, not ELF, not 32-bit little-endian ARM, not Thumb at entry, beyond
//           the part's flash, cut off
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "harness/base/result.hpp"
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
  std::uint64_t digest() const { return digest_; }                 // FNV-1a of the file

  const Symbol* function_at(std::uint32_t address) const;  // the one that contains it, or null
  // By mangled name, demangled name, or demangled name up to its parenthesis.
  std::vector<const Symbol*> functions_named(const std::string& name) const;
  const Symbol* object_named(const std::string& name) const;
  // "fw::attitude_task()+0x12" or "0x08001234".
  std::string describe(std::uint32_t address) const;

 private:
  friend Result<Image> load_image(const std::string& path, const Part& part);
  std::vector<Segment> segments_;
  std::vector<Symbol> symbols_;
  std::uint64_t digest_ = 0;
};

Result<Image> load_image(const std::string& path, const Part& part);

}  // namespace whirl::board
