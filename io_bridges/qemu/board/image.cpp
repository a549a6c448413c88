#include "io_bridges/qemu/board/image.hpp"

#include <cxxabi.h>
#include <elf.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include "base/text.hpp"

namespace whirl::board {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr int kArmv7_m = 10, kArmv7e_m = 13;

constexpr std::uintmax_t kLargest_file_B = 256u << 20;
constexpr std::size_t kLongest_name_B = 1024;
constexpr std::size_t kAll_names_B = 64u << 20;
constexpr int kMost_references = 24;

// A name of 240 characters can stand for one of 285 MB: what it refers back to ("S1_", "T_") is
// repeated, and repeated within what is repeated. With k references a name grows by 3^(k/3) at most.
bool is_tame(const std::string& name) {
  int references = 0;
  for (std::size_t i = 0; i + 1 < name.size(); ++i) {
    const char next = name[i + 1];
    const bool number = next == '_' || (next >= '0' && next <= '9') || (next >= 'A' && next <= 'Z');
    if ((name[i] == 'S' || name[i] == 'T') && number) ++references;
  }
  return references <= kMost_references && name.size() <= kLongest_name_B;
}

std::string demangle(const std::string& name) {
  if (!is_tame(name)) return name;
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
  while (at < file.size() && file[at] != 0 && text.size() < kLongest_name_B) {
    text += static_cast<char>(file[at++]);
  }
  return text;
}

Error bad(const std::string& path, const std::string& what, const std::string& cure = "") {
  return {ErrorKind::bad_input, path, what, cure};
}

// With its debug information an image has tens of MB: they are in memory once.
Bytes read_all(std::ifstream& stream, std::uintmax_t size) {
  Bytes file(size == static_cast<std::uintmax_t>(-1) ? 0 : size);
  stream.read(reinterpret_cast<char*>(file.data()), static_cast<std::streamsize>(file.size()));
  file.resize(static_cast<std::size_t>(stream.gcount()));
  return file;
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
  const std::uint64_t sections = std::uint64_t{head->e_shoff} + head->e_shnum * sizeof(Elf32_Shdr);
  if (head->e_shnum > 0 && sections > file.size()) {
    return bad(path, "cut off behind its segments: its symbols are missing",
               "build or copy it anew");
  }
  return *head;
}

bool inside(const MemoryBlock& block, std::uint64_t address, std::uint64_t size) {
  return address >= block.base && address + size <= std::uint64_t{block.base} + block.size;
}

// The first address that two segments claim.
std::optional<std::uint32_t> overlap(std::vector<Segment> segments) {
  std::sort(segments.begin(), segments.end(),
            [](const Segment& a, const Segment& b) { return a.address < b.address; });
  for (std::size_t i = 1; i < segments.size(); ++i) {
    const Segment& below = segments[i - 1];
    if (segments[i].address - below.address < below.bytes.size()) return segments[i].address;
  }
  return std::nullopt;
}

Result<std::vector<Segment>> read_segments(const std::string& path, const Bytes& file,
                                           const Elf32_Ehdr& head, const Part& part) {
  std::vector<Segment> segments;
  for (unsigned i = 0; i < head.e_phnum; ++i) {
    const auto program = entry<Elf32_Phdr>(file, head.e_phoff, i);
    if (!program) return bad(path, "cut off in its program headers");
    if (program->p_type != PT_LOAD || program->p_filesz == 0) continue;
    const std::uint64_t end = std::uint64_t{program->p_paddr} + program->p_filesz;
    const bool in_ram = inside(part.sram, program->p_paddr, program->p_filesz) ||
                        inside(part.ccm, program->p_paddr, program->p_filesz);
    if (in_ram) continue;
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
  if (const auto twice = overlap(segments)) {
    return bad(path, "two of its segments overlap at " + hex(*twice));
  }
  return segments;
}

// Tag_CPU_arch of the build attributes (ABI addenda 3.3): 10 ARMv7-M, 13 ARMv7E-M; 0: not told.
class Attributes {
 public:
  explicit Attributes(const std::uint8_t* begin, const std::uint8_t* end) : at_(begin), end_(end) {}

  int cpu_arch() {
    if (at_ >= end_ || *at_++ != 'A') return 0;
    skip(4);
    if (text() != "aeabi" || number() != kFile) return 0;
    skip(4);
    while (at_ < end_) {
      const std::uint32_t tag = number();
      if (tag == kCpu_arch) return static_cast<int>(number());
      const bool is_text = tag == kCpu_raw_name || tag == kCpu_name || (tag > 32 && tag % 2 != 0);
      if (is_text) {
        text();
      } else {
        number();
      }
    }
    return 0;
  }

 private:
  static constexpr std::uint32_t kFile = 1, kCpu_raw_name = 4, kCpu_name = 5, kCpu_arch = 6;

  void skip(std::ptrdiff_t bytes) { at_ += std::min(bytes, end_ - at_); }
  std::uint32_t number() {  // ULEB128
    std::uint32_t value = 0;
    for (unsigned shift = 0; at_ < end_ && shift < 32; shift += 7) {
      value |= (*at_ & 0x7Fu) << shift;
      if ((*at_++ & 0x80u) == 0) break;
    }
    return value;
  }
  std::string text() {
    std::string value;
    while (at_ < end_ && *at_ != 0) value += static_cast<char>(*at_++);
    skip(1);
    return value;
  }

  const std::uint8_t *at_, *end_;
};

int cpu_arch(const Bytes& file, const Elf32_Ehdr& head) {
  constexpr std::uint32_t kArm_attributes = 0x70000003;
  for (unsigned i = 0; i < head.e_shnum; ++i) {
    const auto section = entry<Elf32_Shdr>(file, head.e_shoff, i);
    if (!section || section->sh_type != kArm_attributes) continue;
    const std::uint64_t end = std::uint64_t{section->sh_offset} + section->sh_size;
    if (end > file.size()) return 0;
    return Attributes(file.data() + section->sh_offset, file.data() + end).cpu_arch();
  }
  return 0;
}

// Tables may lie over each other, and so may names: an image of 1 MB could hold 4e9 symbols.
Result<std::vector<Symbol>> read_symbols(const std::string& path, const Bytes& file,
                                         const Elf32_Ehdr& head) {
  std::vector<Symbol> symbols;
  std::size_t entries = 0, names_B = 0;
  for (unsigned i = 0; i < head.e_shnum; ++i) {
    const auto table = entry<Elf32_Shdr>(file, head.e_shoff, i);
    if (!table || table->sh_type != SHT_SYMTAB) continue;
    const auto names = entry<Elf32_Shdr>(file, head.e_shoff, table->sh_link);
    if (!names) continue;
    for (std::uint64_t n = 0; n < table->sh_size / sizeof(Elf32_Sym); ++n) {
      const auto symbol = entry<Elf32_Sym>(file, table->sh_offset, n);
      if (!symbol) break;
      if (++entries * sizeof(Elf32_Sym) > file.size()) return bad(path, "has overlapping symbols");
      const int type = ELF32_ST_TYPE(symbol->st_info);
      if ((type != STT_FUNC && type != STT_OBJECT) || symbol->st_shndx == SHN_UNDEF) continue;
      const std::string name = text_at(file, std::uint64_t{names->sh_offset} + symbol->st_name);
      const std::uint32_t thumb = type == STT_FUNC ? 1 : 0;
      symbols.push_back(
          {symbol->st_value & ~thumb, symbol->st_size, type == STT_FUNC, demangle(name), name});
      names_B += name.size() + symbols.back().name.size();
      if (names_B > kAll_names_B) return bad(path, "has more than 64 MiB of names");
    }
  }
  std::stable_sort(symbols.begin(), symbols.end(),
                   [](const Symbol& a, const Symbol& b) { return a.address < b.address; });
  return symbols;
}

}  // namespace

Result<Done> Image::add(Image other, const std::string& path) {
  segments_.insert(segments_.end(), std::make_move_iterator(other.segments_.begin()),
                   std::make_move_iterator(other.segments_.end()));
  if (const auto twice = overlap(segments_)) {
    return bad(path, "it and the image overlap at " + hex(*twice));
  }
  symbols_.insert(symbols_.end(), other.symbols_.begin(), other.symbols_.end());
  std::stable_sort(symbols_.begin(), symbols_.end(),
                   [](const Symbol& a, const Symbol& b) { return a.address < b.address; });
  oddities_.insert(oddities_.end(), other.oddities_.begin(), other.oddities_.end());
  return Done{};
}

std::optional<std::uint32_t> Image::word_at(std::uint32_t address) const {
  for (const Segment& segment : segments_) {
    const std::uint32_t offset = address - segment.address;
    if (offset >= segment.bytes.size() || segment.bytes.size() - offset < 4) continue;
    std::uint32_t word = 0;
    std::memcpy(&word, segment.bytes.data() + offset, sizeof word);
    return word;
  }
  return std::nullopt;
}

const Symbol* Image::function_at(std::uint32_t address) const {
  const Symbol* best = nullptr;
  for (const Symbol& symbol : symbols_) {
    if (symbol.address > address) break;
    if (!symbol.function) continue;
    if (address < symbol.address + std::max(symbol.size, 2u)) best = &symbol;
  }
  return best;
}

const Symbol* Image::object_at(std::uint32_t address) const {
  const auto holds = [address](const Symbol& symbol) {
    return !symbol.function && address >= symbol.address && address - symbol.address < symbol.size;
  };
  const auto found = std::find_if(symbols_.begin(), symbols_.end(), holds);
  return found == symbols_.end() ? nullptr : &*found;
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
  std::error_code status;
  if (std::filesystem::exists(path, status) &&
      (!std::filesystem::is_regular_file(path, status) ||
       std::filesystem::file_size(path, status) > kLargest_file_B)) {
    return bad(path, "is no plain file up to 256 MiB");
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return bad(path, "cannot be read", "is the path right, and has it been built?");
  const Bytes file = read_all(stream, std::filesystem::file_size(path, status));
  const auto head = check_head(path, file, part);
  if (!head) return head.error();
  auto segments = read_segments(path, file, head.value(), part);
  if (!segments) return segments.error();
  const int arch = cpu_arch(file, head.value());
  if (arch == kArmv7e_m && !part.is_m4) {
    return bad(path, "built for a Cortex-M4 or M7", std::string(part.mcu) + " is a Cortex-M3");
  }
  Image image;
  if (arch == kArmv7_m && part.is_m4) {
    image.oddities_.push_back(path + " is built for a Cortex-M3, " + std::string(part.mcu) +
                              " is a Cortex-M4: is it an image for another part?");
  }
  image.segments_ = std::move(segments.value());
  auto symbols = read_symbols(path, file, head.value());
  if (!symbols) return symbols.error();
  image.symbols_ = std::move(symbols.value());
  return image;
}

Result<Done> check_start(const Image& image, const std::string& path, std::uint32_t start) {
  const auto reset = image.word_at(start + 4);
  if (!reset) {
    return bad(path, "has no vector table at " + hex(start),
               "name the boot loader (boot_image) or where it starts (start) in the board file");
  }
  if ((*reset & 1u) == 0) {
    return bad(path,
               "its reset vector " + hex(*reset) + " at " + hex(start + 4) + " is not Thumb code");
  }
  return Done{};
}

}  // namespace whirl::board
