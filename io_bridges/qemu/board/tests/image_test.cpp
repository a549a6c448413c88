// Images that nobody's linker made. Each test writes a small ELF file of its own.
#include "io_bridges/qemu/board/image.hpp"

#include <elf.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "harness/base/scratch_folder.hpp"

namespace whirl::board {
namespace {

// Two words of flash, and these functions; the table of symbols is named by so many sections.
std::string elf_with(const std::vector<std::string>& names, std::uint16_t tables = 1) {
  std::string symbols, texts(1, '\0');
  for (const std::string& name : names) {
    Elf32_Sym symbol{};
    symbol.st_name = static_cast<std::uint32_t>(texts.size());
    symbol.st_value = 0x08000001;
    symbol.st_info = ELF32_ST_INFO(STB_GLOBAL, STT_FUNC);
    symbol.st_shndx = 1;
    symbols.append(reinterpret_cast<const char*>(&symbol), sizeof symbol);
    texts += name + '\0';
  }
  Elf32_Ehdr head{};
  std::memcpy(head.e_ident, ELFMAG, SELFMAG);
  head.e_ident[EI_CLASS] = ELFCLASS32;
  head.e_ident[EI_DATA] = ELFDATA2LSB;
  head.e_type = ET_EXEC;
  head.e_machine = EM_ARM;
  head.e_entry = 0x08000001;
  head.e_phoff = sizeof head;
  head.e_phnum = 1;
  Elf32_Phdr load{};
  load.p_type = PT_LOAD;
  load.p_offset = sizeof head + sizeof load;
  load.p_paddr = 0x08000000;
  load.p_filesz = 8;
  Elf32_Shdr table{}, strings{};
  table.sh_type = SHT_SYMTAB;
  table.sh_offset = load.p_offset + load.p_filesz;
  table.sh_size = static_cast<std::uint32_t>(symbols.size());
  table.sh_link = tables;
  strings.sh_type = SHT_STRTAB;
  strings.sh_offset = table.sh_offset + table.sh_size;
  strings.sh_size = static_cast<std::uint32_t>(texts.size());
  head.e_shoff = strings.sh_offset + strings.sh_size;
  head.e_shnum = static_cast<std::uint16_t>(tables + 1);
  std::string file(reinterpret_cast<const char*>(&head), sizeof head);
  file.append(reinterpret_cast<const char*>(&load), sizeof load);
  file += std::string(8, '\0') + symbols + texts;
  for (int i = 0; i < tables; ++i) {
    file.append(reinterpret_cast<const char*>(&table), sizeof table);
  }
  return file.append(reinterpret_cast<const char*>(&strings), sizeof strings);
}

Result<Image> load(const std::string& bytes) {
  const ScratchFolder folder;
  std::ofstream(folder.file("x.elf"), std::ios::binary) << bytes;
  return load_image(folder.file("x.elf"), *find_part("stm32f405rg"));
}

TEST(Image, NamesAreDemangled) {
  const auto image = load(elf_with({"_ZN2fw8imu_taskEv", "main"}));
  ASSERT_TRUE(image.ok()) << image.error().message();
  EXPECT_EQ(image.value().functions_named("fw::imu_task").size(), 1u);
  EXPECT_EQ(image.value().functions_named("main").size(), 1u);
}

// A<A<...>, A<...>>, each S_ twice the one before: 2^30 arguments when it is written out.
TEST(Image, ANameThatWouldFillTheMemoryStaysMangled) {
  const std::string digits = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ";
  std::string name = "_Z1f1AIiiE";
  for (int i = 0; i < 30; ++i) {
    const std::string last = std::string("S") + digits[static_cast<std::size_t>(i)] + "_";
    name += "S_I" + last + last + "E";
  }
  const auto image = load(elf_with({name}));
  ASSERT_TRUE(image.ok());
  EXPECT_EQ(image.value().symbols()[0].name, name);
}

TEST(Image, TablesThatLieOverEachOtherAreRefused) {
  EXPECT_TRUE(load(elf_with({"a", "b"}, 2)).ok());
  const auto image = load(elf_with(std::vector<std::string>(1000, "a"), 1000));
  ASSERT_FALSE(image.ok());
  EXPECT_NE(image.error().what.find("overlapping symbols"), std::string::npos);
}

TEST(Image, AnEndlessFileIsRefused) {
  const auto image = load_image("/dev/zero", *find_part("stm32f405rg"));
  ASSERT_FALSE(image.ok());
  EXPECT_NE(image.error().what.find("no plain file"), std::string::npos);
}

}  // namespace
}  // namespace whirl::board
