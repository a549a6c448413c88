// ELF files written here byte by byte: what is taken, what is refused, and why.
#include "io_bridges/qemu/board/image.hpp"

#include <elf.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "harness/base/scratch_folder.hpp"

namespace whirl::board {
namespace {

using Words = std::vector<std::uint32_t>;

struct Load {
  std::uint32_t address;
  Words words;
};

struct Elf {
  std::vector<Load> loads = {{0x08000000, {0x20005000, 0x08000101}}};
  std::uint32_t entry = 0x08000101;
  std::string attributes;   // of .ARM.attributes; empty: none
  std::size_t cut_off = 0;  // bytes at the end that are missing

  std::string bytes() const {
    const std::size_t headers = sizeof(Elf32_Ehdr) + loads.size() * sizeof(Elf32_Phdr);
    std::string body;
    std::vector<Elf32_Phdr> programs;
    for (const Load& load : loads) {
      Elf32_Phdr p{};
      p.p_type = PT_LOAD;
      p.p_offset = static_cast<Elf32_Off>(headers + body.size());
      p.p_paddr = p.p_vaddr = load.address;
      p.p_filesz = p.p_memsz = static_cast<Elf32_Word>(4 * load.words.size());
      programs.push_back(p);
      body.append(reinterpret_cast<const char*>(load.words.data()), p.p_filesz);
    }
    Elf32_Shdr section{};
    section.sh_type = 0x70000003;
    section.sh_offset = static_cast<Elf32_Off>(headers + body.size());
    section.sh_size = static_cast<Elf32_Word>(attributes.size());
    body += attributes;
    Elf32_Ehdr head{};
    std::memcpy(head.e_ident, ELFMAG, SELFMAG);
    head.e_ident[EI_CLASS] = ELFCLASS32;
    head.e_ident[EI_DATA] = ELFDATA2LSB;
    head.e_type = ET_EXEC;
    head.e_machine = EM_ARM;
    head.e_entry = entry;
    head.e_phoff = sizeof head;
    head.e_phnum = static_cast<Elf32_Half>(loads.size());
    head.e_shoff = static_cast<Elf32_Off>(headers + body.size());
    head.e_shnum = 1;
    std::string file(reinterpret_cast<const char*>(&head), sizeof head);
    file.append(reinterpret_cast<const char*>(programs.data()),
                programs.size() * sizeof programs[0]);
    file += body;
    file.append(reinterpret_cast<const char*>(&section), sizeof section);
    return file.substr(0, file.size() - cut_off);
  }
};

Result<Image> load(const Elf& elf, const char* mcu = "stm32f405rg") {
  const ScratchFolder folder;
  const std::string path = folder.file("x.elf");
  std::ofstream(path, std::ios::binary) << elf.bytes();
  return load_image(path, *find_part(mcu));
}
std::string refusal(const Elf& elf, const char* mcu = "stm32f405rg") {
  const auto image = load(elf, mcu);
  return image ? "" : image.error().message();
}
// Build attributes with one CPU architecture, as the ABI's addenda lay them out.
std::string built_for(char arch) {
  const std::string tags = {6, arch, 7, 'M'};
  const auto length = [](std::size_t n) { return std::string{static_cast<char>(n), 0, 0, 0}; };
  const std::string file = std::string(1, 1) + length(tags.size() + 5) + tags;
  const std::string vendor = std::string("aeabi") + '\0' + file;
  return "A" + length(vendor.size() + 4) + vendor;
}

TEST(ImageFile, AnEvenEntryPointIsNoFault) {
  Elf elf;
  elf.entry = 0x08000100;
  EXPECT_EQ(refusal(elf), "");
}

TEST(ImageFile, WhatLiesInRamIsLeftOutAsByAFlasher) {
  Elf elf;
  elf.loads.push_back({0x20000000, {1, 2, 3}});
  elf.loads.push_back({0x10000000, {4}});
  const auto image = load(elf);
  ASSERT_TRUE(image) << image.error().message();
  EXPECT_EQ(image.value().segments().size(), 1u);
}

TEST(ImageFile, OverlappingSegmentsAreRefused) {
  Elf elf;
  elf.loads.push_back({0x08000004, {7}});
  EXPECT_NE(refusal(elf).find("overlap at 0x08000004"), std::string::npos) << refusal(elf);
  elf.loads.back().address = 0x08000008;
  EXPECT_EQ(refusal(elf), "");
}

TEST(ImageFile, AFileThatIsCutBehindItsSegmentsIsRefused) {
  Elf elf;
  elf.cut_off = 4;
  EXPECT_NE(refusal(elf).find("cut off behind its segments"), std::string::npos);
}

TEST(ImageFile, AnotherCoreIsRefusedOrSaid) {
  Elf elf;
  elf.attributes = built_for(13);  // ARMv7E-M
  EXPECT_EQ(refusal(elf), "");
  EXPECT_NE(refusal(elf, "stm32f103cb").find("stm32f103cb is a Cortex-M3"), std::string::npos);
  elf.attributes = built_for(10);  // ARMv7-M
  EXPECT_EQ(load(elf, "stm32f103cb").value().oddities().size(), 0u);
  ASSERT_EQ(load(elf).value().oddities().size(), 1u);
  EXPECT_NE(load(elf).value().oddities()[0].find("built for a Cortex-M3"), std::string::npos);
}

TEST(ImageFile, ASecondFileLiesBesideTheFirst) {
  Elf image, boot;
  image.loads[0].address = 0x08004000;
  auto both = load(image);
  ASSERT_TRUE(both);
  EXPECT_FALSE(check_start(both.value(), "x.elf", 0x08000000));
  EXPECT_TRUE(check_start(both.value(), "x.elf", 0x08004000));
  ASSERT_TRUE(both.value().add(load(boot).value(), "boot.elf"));
  EXPECT_TRUE(check_start(both.value(), "x.elf", 0x08000000));
  EXPECT_FALSE(both.value().add(load(boot).value(), "boot.elf"));  // in its own way now
}

TEST(ImageFile, AnEvenResetVectorIsNoCode) {
  Elf elf;
  elf.loads[0].words[1] = 0x08000100;
  const auto start = check_start(load(elf).value(), "x.elf", 0x08000000);
  ASSERT_FALSE(start);
  EXPECT_NE(start.error().what.find("not Thumb code"), std::string::npos);
}

}  // namespace
}  // namespace whirl::board
