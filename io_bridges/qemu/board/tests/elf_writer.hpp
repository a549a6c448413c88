// Writes small ELF files byte by byte, right and wrong ones, as no linker would.
#pragma once
#include <elf.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "base/scratch_folder.hpp"
#include "io_bridges/qemu/board/image.hpp"

namespace whirl::board {

struct Elf {
  struct Load {
    std::uint32_t address;
    std::vector<std::uint32_t> words;
  };
  std::vector<Load> loads = {{0x08000000, {0x20005000, 0x08000101}}};
  std::uint32_t entry = 0x08000101;
  std::vector<std::string> functions;  // symbols, all of them at the start of flash
  std::uint16_t symbol_tables = 1;     // so many sections name the one table of symbols
  std::string attributes;              // of .ARM.attributes
  std::size_t cut_off = 0;             // bytes at the end that are missing

  std::string bytes() const {
    const std::size_t headers = sizeof(Elf32_Ehdr) + loads.size() * sizeof(Elf32_Phdr);
    std::string body, programs, sections;
    for (const Load& load : loads) {
      Elf32_Phdr p{};
      p.p_type = PT_LOAD;
      p.p_offset = static_cast<Elf32_Off>(headers + body.size());
      p.p_paddr = p.p_vaddr = load.address;
      p.p_filesz = p.p_memsz = static_cast<Elf32_Word>(4 * load.words.size());
      append(programs, p);
      body.append(reinterpret_cast<const char*>(load.words.data()), p.p_filesz);
    }
    const auto add_section = [&](std::uint32_t type, const std::string& content, int times) {
      Elf32_Shdr section{};
      section.sh_type = type;
      section.sh_offset = static_cast<Elf32_Off>(headers + body.size());
      section.sh_size = static_cast<Elf32_Word>(content.size());
      section.sh_link = symbol_tables;  // their names come right behind them
      for (int i = 0; i < times; ++i) append(sections, section);
      body += content;
    };
    if (!functions.empty()) {
      add_section(SHT_SYMTAB, symbols(), symbol_tables);
      add_section(SHT_STRTAB, names(), 1);
    }
    add_section(0x70000003, attributes, 1);
    std::string file;
    append(file, head(headers + body.size(), sections.size() / sizeof(Elf32_Shdr)));
    file += programs + body + sections;
    return file.substr(0, file.size() - cut_off);
  }

 private:
  template <typename T>
  static void append(std::string& bytes, const T& what) {
    bytes.append(reinterpret_cast<const char*>(&what), sizeof what);
  }
  Elf32_Ehdr head(std::size_t section_headers_at, std::size_t sections) const {
    Elf32_Ehdr head{};
    std::memcpy(head.e_ident, ELFMAG, SELFMAG);
    head.e_ident[EI_CLASS] = ELFCLASS32;
    head.e_ident[EI_DATA] = ELFDATA2LSB;
    head.e_type = ET_EXEC;
    head.e_machine = EM_ARM;
    head.e_entry = entry;
    head.e_phoff = sizeof head;
    head.e_phnum = static_cast<Elf32_Half>(loads.size());
    head.e_shoff = static_cast<Elf32_Off>(section_headers_at);
    head.e_shnum = static_cast<Elf32_Half>(sections);
    return head;
  }
  std::string symbols() const {
    std::string all;
    std::size_t name_at = 1;
    for (const std::string& name : functions) {
      Elf32_Sym symbol{};
      symbol.st_name = static_cast<Elf32_Word>(name_at);
      symbol.st_value = 0x08000001;
      symbol.st_info = ELF32_ST_INFO(STB_GLOBAL, STT_FUNC);
      symbol.st_shndx = 1;
      append(all, symbol);
      name_at += name.size() + 1;
    }
    return all;
  }
  std::string names() const {
    std::string all(1, '\0');
    for (const std::string& name : functions) all += name + '\0';
    return all;
  }
};

inline Result<Image> load(const Elf& elf, const char* mcu = "stm32f405rg") {
  const ScratchFolder folder;
  const std::string path = folder.file("x.elf");
  std::ofstream(path, std::ios::binary) << elf.bytes();
  return load_image(path, *find_part(mcu));
}

}  // namespace whirl::board
