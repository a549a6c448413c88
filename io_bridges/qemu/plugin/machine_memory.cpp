// SPDX-License-Identifier: GPL-2.0-or-later
//
// The memories and register blocks of the part, over those of QEMU's machine.
#include <cstdlib>
#include <cstring>
#include <utility>

#include "io_bridges/qemu/board/post_mortem.hpp"
#include "io_bridges/qemu/plugin/machine.hpp"

namespace whirl::qemu {
namespace {

// Over the machine (0), under nothing: gaps first, then blocks.
constexpr int kGaps = 5, kBlocks = 10, kMemories = 10;
constexpr std::size_t kHostPage = 4096;
constexpr std::uint32_t kCode_page = 1024;  // a write by DMA moves at most a word
constexpr int kSp = 13, kPc = 15;
using board::kUntouched;  // RAM is not 0 at power-up; the stack watch counts on it

bool nobody_answers(void*, hwaddr, unsigned, bool, Attributes) {
  return false;
}
std::uint64_t read_nothing(void*, hwaddr, unsigned) {
  return 0;
}
void write_nothing(void*, hwaddr, std::uint64_t, unsigned) {}

const RegionOps kBarred = {read_nothing, write_nothing, nullptr,
                           nullptr,      kLittleEndian, {1, 4, true, nobody_answers},
                           {1, 4, true}};

std::uint64_t read_flash(void*, hwaddr, unsigned) {
  return 0;
}  // never called: reads go to memory

std::uint32_t store_into_flash(void* self, hwaddr offset, std::uint64_t value, unsigned size,
                               Attributes) {
  auto& machine = *static_cast<Machine*>(self);
  board::Board& board = machine.board();
  const auto address = board.part().flash.base + static_cast<std::uint32_t>(offset);
  machine.accessed(address);
  return board.flash_store(address, size, static_cast<std::uint32_t>(value)) ? kOk : kBusError;
}

const RegionOps kFlashOps = {read_flash,       nullptr,       nullptr,
                             store_into_flash, kLittleEndian, {1, 4, false, nullptr},
                             {1, 4, false}};

}  // namespace

// No register may be a place on the stack. An exception's frame that would go there must be stopped
// before the clock is read: in the middle of an exception's entry QEMU has none, and gives up.
void Machine::accessed(std::uint32_t address) {
  if (moves_by_dma_) return;
  constexpr std::uint32_t kFrame = 0x6C;  // the largest: with floating point, aligned
  const std::uint32_t sp = core_registers_[kSp];
  if (address - (sp - kFrame) < 2 * kFrame) {
    core_stopped(board::StoppedCore::frame_among_registers);
  }
  anchor();
  const std::uint32_t pc = core_registers_[kPc];
  if (clock_->reached_register(pc)) forget_code_at(pc);
}

std::uint64_t Machine::read_window(void* window, hwaddr offset, unsigned size) {
  auto& [machine, block, base] = *static_cast<Window*>(window);
  machine->accessed(base + static_cast<std::uint32_t>(offset));
  machine->begin_access();
  const std::uint32_t value = block->read(static_cast<std::uint32_t>(offset), size);
  machine->waits_for_bus(base, false);
  machine->end_access();
  return value;
}

void Machine::write_window(void* window, hwaddr offset, std::uint64_t value, unsigned size) {
  auto& [machine, block, base] = *static_cast<Window*>(window);
  machine->accessed(base + static_cast<std::uint32_t>(offset));
  machine->begin_access();
  block->write(static_cast<std::uint32_t>(offset), static_cast<std::uint32_t>(value), size);
  machine->waits_for_bus(base, true);
  machine->end_access();
}

MemoryRegion& Machine::new_region() {
  regions_.push_back(std::make_unique<MemoryRegion>());
  return *regions_.back();
}

void Machine::map_block(MemoryRegion* parent, const stm32::Region& block, int priority) {
  // Aligned accesses of 1, 2 and 4 bytes reach the block as they are.
  static const RegionOps kOps = {read_window,   write_window,           nullptr,      nullptr,
                                 kLittleEndian, {1, 4, false, nullptr}, {1, 4, false}};
  MemoryRegion& region = new_region();
  windows_.push_back(std::make_unique<Window>(Window{this, block.block, block.base}));
  api_.memory_region_init_io(&region, nullptr, &kOps, windows_.back().get(), block.block->name(),
                             block.size);
  api_.memory_region_add_subregion_overlap(parent, block.base, &region, priority);
}

std::uint8_t* Machine::map_ram(MemoryRegion* parent, const char* name,
                               const board::MemoryBlock& block) {
  if (block.size == 0) return nullptr;
  void* memory = std::aligned_alloc(kHostPage, block.size);  // lives as long as the process
  std::memset(memory, kUntouched, block.size);
  MemoryRegion& region = new_region();
  api_.memory_region_init_ram_ptr(&region, nullptr, name, block.size, memory);
  api_.memory_region_add_subregion_overlap(parent, block.base, &region, kMemories);
  return static_cast<std::uint8_t*>(memory);
}

// Null: not all of it is SRAM.
std::uint8_t* Machine::sram_at(std::uint32_t address, std::size_t size) const {
  const board::MemoryBlock& block = board_.part().sram;
  const std::uint32_t offset = address - block.base;
  return offset < block.size && size <= block.size - offset ? sram_ + offset : nullptr;
}

void Machine::code_thrown_away() {
  clock_->code_thrown_away();
  const bool ours = std::exchange(throws_code_away_, false);
  if (ours || full_buffer_told_ || board().run().gdb_port != 0) return;
  full_buffer_told_ = true;
  board().report({clock_->core_now(), "core",
                  "QEMU's buffer for translated code was full: from here on times are not "
                  "proven to be exact, and another run may differ"});
}

// When its buffer is full QEMU throws all code away in the midst of making a block, and with it what it was
// to make (tb_gen_code(), accel/tcg/translate-all.c: the flags of the next block are used up by then). Where
// one instruction was to be done again by itself, the whole block from there on is begun instead, and left
// again: it has paid for lines of flash by then that are paid otherwise in the block ahead of it, which has
// had the time to fetch them. So code is thrown away while there is room, where QEMU makes a whole block:
// it leaves that at its start, before anything is paid. Not at one instruction: nobody tells why it is one.
void Machine::keep_room_for_code(std::size_t instructions) {
  const bool part = clock_->asked_for_part() || instructions == 1;
  if (part || throws_code_away_) return;
  if (api_.tcg_code_size() > api_.tcg_code_capacity() / 4 * 3) throw_code_away();
}

void Machine::code_translated(std::uint32_t from, std::uint32_t to) {
  const board::MemoryBlock& block = board_.part().sram;
  for (std::uint32_t at = from & ~(kCode_page - 1); at < to; at += kCode_page) {
    if (at - block.base < block.size) sram_holds_code_[(at - block.base) / kCode_page] = true;
  }
}

// By QEMU's address spaces each byte that DMA moves would cost more than all else that it takes.
bool Machine::read_bus(std::uint32_t address, void* to, std::size_t size) {
  if (const std::uint8_t* memory = sram_at(address, size)) {
    std::memcpy(to, memory, size);
    return true;
  }
  return move_by_dma(address, to, size, false);
}

bool Machine::move_by_dma(std::uint32_t address, void* bytes, std::size_t size, bool write) {
  const bool outer = std::exchange(moves_by_dma_, true);
  const std::uint32_t result =
      api_.address_space_rw(api_.address_space_memory, address, kPrivileged, bytes, size, write);
  moves_by_dma_ = outer;
  return result == kOk;
}

// Code that has been translated must be known to be stale: QEMU sees to it.
bool Machine::write_bus(std::uint32_t address, const void* from, std::size_t size) {
  std::uint8_t* memory = sram_at(address, size);
  const auto holds_code = [&](std::uint32_t at) {
    return sram_holds_code_[(at - board_.part().sram.base) / kCode_page];
  };
  if (memory != nullptr && size > 0 && !holds_code(address) &&
      !holds_code(address + static_cast<std::uint32_t>(size) - 1)) {
    std::memcpy(memory, from, size);
    return true;
  }
  return move_by_dma(address, const_cast<void*>(from), size, true);
}

// No code is in CCM.
void Machine::lose_memories() {
  const board::Part& part = board_.part();
  const std::vector<std::uint8_t> untouched(part.sram.size, kUntouched);
  write_cells(part.sram.base, untouched.data(), untouched.size());
  if (ccm_ != nullptr) std::memset(ccm_, kUntouched, part.ccm.size);
}

// The machine has memory here, the part has not: a bus fault.
void Machine::bar(std::uint32_t from, std::uint32_t to) {
  if (to <= from) return;
  MemoryRegion& region = new_region();
  api_.memory_region_init_io(&region, nullptr, &kBarred, nullptr, "whirl.no_memory", to - from);
  api_.memory_region_add_subregion_overlap(api_.get_system_memory(), from, &region, kMemories);
}

void Machine::map_memories() {
  const board::Part& part = board_.part();
  MemoryRegion* system = api_.get_system_memory();

  MemoryRegion& flash = new_region();
  api_.memory_region_init_rom_device_nomigrate(&flash, nullptr, &kFlashOps, this, "whirl.flash",
                                               part.flash.size, nullptr);
  api_.memory_region_add_subregion_overlap(system, part.flash.base, &flash, kMemories);
  MemoryRegion& alias = new_region();
  // A start behind the start of flash: as a boot loader leaves the core that is not there.
  const std::uint32_t start = board_.description().start;
  const std::uint32_t skipped = start != 0 ? start - part.flash.base : 0;
  const std::uint32_t aliased = part.flash.size - skipped;
  api_.memory_region_init_alias(&alias, nullptr, "whirl.boot", &flash, skipped, aliased);
  api_.memory_region_add_subregion_overlap(system, 0, &alias, kMemories);

  MemoryRegion& rom = new_region();
  api_.memory_region_init_rom_device_nomigrate(&rom, nullptr, &kBarred, nullptr, "whirl.system_rom",
                                               part.system_rom.size, nullptr);
  api_.memory_region_add_subregion_overlap(system, part.system_rom.base, &rom, kMemories);
  sram_ = map_ram(system, "whirl.sram", part.sram);
  sram_holds_code_.assign(part.sram.size / kCode_page + 1, false);
  ccm_ = map_ram(core_memory_, "whirl.ccm", part.ccm);

  bar(part.sram.base + part.sram.size, part.machine_sram.base + part.machine_sram.size);
  bar(part.flash.base + part.flash.size, part.machine_flash.base + part.machine_flash.size);
  bar(aliased, part.machine_flash.size);  // its alias at 0

  map_block(system, board_.unanswered_region(), kGaps);
  for (const stm32::Region& block : board_.regions()) map_block(system, block, kBlocks);
  for (const stm32::Region& block : board_.core_regions()) map_block(core_memory_, block, kBlocks);
  system_control_->map(core_memory_, new_region());
}

void Machine::load_image() {
  const board::Part& part = board_.part();
  const std::vector<std::uint8_t> blank(part.flash.size, 0xFF);
  write_cells(part.flash.base, blank.data(), blank.size());
  for (const board::Segment& segment : board_.image().segments()) {
    write_cells(segment.address, segment.bytes.data(), segment.bytes.size());
  }
  const std::vector<std::uint8_t> rom = board_.system_rom();
  write_cells(part.system_rom.base, rom.data(), rom.size());
}

}  // namespace whirl::qemu
