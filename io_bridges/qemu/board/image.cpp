#include "io_bridges/qemu/board/image.hpp"

#include <cxxabi.h>
#include <elf.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>

#include "harness/base/digest.hpp"

namespace whirl::board {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::string hex(std::uint32_t value) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%08x", value);
  return text;
}

std::string demangle(const std::string& name) {
  int status = 0;
  char* text = abi::__cxa_demangle(name.c_str(), nullptr, nullptr, &status);
  std::string result = status == 0 && text != nullptr ? text : name;
  std::free(text);
  return result;
}

// The i-th entry of a table of T in the file, or nothing when the file ends before.
template <typename T>
std::optional<T> entry(const Bytes& file, std::uint64_t table, std::uint64_t i) {
  const std::uint64_t at = table + i * sizeof(T);
  if (at + sizeof(T) > file.size()) return std::nullopt;
  T value;
  std::memcpy(&value, file.data() + at, sizeof value);
  return value;
}

std::string text_at(const Bytes& file, std::uint64_t at) {
  std::string text;
  while (at < file.size() && file[at] != 0) text += static_cast<char>(file[at++]);
  return text;
}

Error bad(const std::string& path, const std::string& what, const std::string& cure = "") {
  return {ErrorKind::bad_input, path, what, cure};
}

Result<Elf32_Ehdr> check_head(const std::string& path, const Bytes& file, const Part& part) {
  if (file.size() < EI_NIDENT || std::memcmp(file.data(), ELFMAG, SELFMAG) != 0) {
    return bad(path, "not an ELF file", "give the .elf of the firmware's build");
  }
  if (file[EI_CLASS] != ELFCLASS32 || file[EI_DATA] != ELFDATA2LSB) {
    return bad(path, "not for a 32-bit little-endian CPU",
               "the part is an " + std::string(part.mcu));
  }
  const auto head = entry<Elf32_Ehdr>(file, 0, 0);
  if (!head) return bad(path, "cut off");
  if (head->e_machine != part.elf_machine) {
    return bad(path, "for another CPU (ELF machine " + std::to_string(head->e_machine) + ")",
               "the part is an " + std::string(part.mcu) + ", an ARM");
  }
  if (head->e_type != ET_EXEC) return bad(path, "not a linked image", "link it to an executable");
  if ((head->e_entry & 1u) == 0) {
    return bad(path, "its entry point is not Thumb code", "compile with -mthumb -mcpu=cortex-m4");
  }
  return *head;
}

bool inside(const MemoryBlock& block, std::uint64_t address, std::uint64_t size) {
  return address >= block.base && address + size <= std::uint64_t{block.base} + block.size;
}

Result<std::vector<Segment>> read_segments(const std::string& path, const Bytes& file,
                                           const Elf32_Ehdr& head, const Part& part) {
  std::vector<Segment> segments;
  for (unsigned i = 0; i < head.e_phnum; ++i) {
    const auto program = entry<Elf32_Phdr>(file, head.e_phoff, i);
    if (!program) return bad(path, "cut off in its program headers");
    if (program->p_type != PT_LOAD || program->p_filesz == 0) continue;
    const std::uint64_t end = std::uint64_t{program->p_paddr} + program->p_filesz;
    if (!inside(part.flash, program->p_paddr, program->p_filesz)) {
      return bad(path,
                 "does not fit into flash: " + std::to_string(program->p_filesz) + " bytes at " +
                     hex(program->p_paddr) + " end at " + hex(static_cast<std::uint32_t>(end)) +
                     ", flash is " + hex(part.flash.base) + " to " +
                     hex(part.flash.base + part.flash.size),
                 std::string(part.mcu) + " has " + std::to_string(part.flash.size / 1024) + " KiB");
    }
    if (std::uint64_t{program->p_offset} + program->p_filesz > file.size()) {
      return bad(path, "cut off");
    }
    const auto from = file.begin() + program->p_offset;
    segments.push_back({program->p_paddr, {from, from + program->p_filesz}});
  }
  if (segments.empty()) return bad(path, "has nothing to load into flash");
  return segments;
}

std::vector<Symbol> read_symbols(const Bytes& file, const Elf32_Ehdr& head) {
  std::vector<Symbol> symbols;
  for (unsigned i = 0; i < head.e_shnum; ++i) {
    const auto table = entry<Elf32_Shdr>(file, head.e_shoff, i);
    if (!table || table->sh_type != SHT_SYMTAB) continue;
    const auto names = entry<Elf32_Shdr>(file, head.e_shoff, table->sh_link);
    if (!names) continue;
    for (std::uint64_t n = 0; n < table->sh_size / sizeof(Elf32_Sym); ++n) {
      const auto symbol = entry<Elf32_Sym>(file, table->sh_offset, n);
      if (!symbol) break;
      const int type = ELF32_ST_TYPE(symbol->st_info);
      if ((type != STT_FUNC && type != STT_OBJECT) || symbol->st_shndx == SHN_UNDEF) continue;
      const std::string name = text_at(file, std::uint64_t{names->sh_offset} + symbol->st_name);
      const std::uint32_t thumb = type == STT_FUNC ? 1 : 0;
      symbols.push_back(
          {symbol->st_value & ~thumb, symbol->st_size, type == STT_FUNC, demangle(name), name});
    }
  }
  std::stable_sort(symbols.begin(), symbols.end(),
                   [](const Symbol& a, const Symbol& b) { return a.address < b.address; });
  return symbols;
}

}  // namespace

const Symbol* Image::function_at(std::uint32_t address) const {
  const Symbol* best = nullptr;
  for (const Symbol& symbol : symbols_) {
    if (symbol.address > address) break;
    if (!symbol.function) continue;
    if (address < symbol.address + std::max(symbol.size, 2u)) best = &symbol;
  }
  return best;
}

std::vector<const Symbol*> Image::functions_named(const std::string& name) const {
  std::vector<const Symbol*> found;
  for (const Symbol& symbol : symbols_) {
    if (!symbol.function) continue;
    if (symbol.mangled == name || symbol.name == name ||
        (symbol.name.compare(0, name.size(), name) == 0 && symbol.name[name.size()] == '(')) {
      found.push_back(&symbol);
    }
  }
  return found;
}

const Symbol* Image::object_named(const std::string& name) const {
  for (const Symbol& symbol : symbols_) {
    if (!symbol.function && (symbol.mangled == name || symbol.name == name)) return &symbol;
  }
  return nullptr;
}

std::string Image::describe(std::uint32_t address) const {
  const Symbol* symbol = function_at(address & ~1u);
  if (symbol == nullptr) return hex(address);
  char offset[16];
  std::snprintf(offset, sizeof offset, "+0x%x", (address & ~1u) - symbol->address);
  return symbol->name + offset;
}

Result<Image> load_image(const std::string& path, const Part& part) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return bad(path, "cannot be read", "is the path right, and has it been built?");
  std::stringstream whole;
  whole << stream.rdbuf();
  const std::string text = whole.str();
  const Bytes file(text.begin(), text.end());
  const auto head = check_head(path, file, part);
  if (!head) return head.error();
  auto segments = read_segments(path, file, head.value(), part);
  if (!segments) return segments.error();
  Image image;
  image.segments_ = std::move(segments.value());
  image.symbols_ = read_symbols(file, head.value());
  Digest digest;
  digest.add_bytes(file.data(), file.size());
  image.digest_ = digest.value();
  return image;
}

}  // namespace whirl::board
