// A block of 32-bit registers: turns narrow accesses into word accesses as the bus does.
//
//   APB  a narrow write is replicated over the word by the bridge (RM0090 2.1.6): the block sees
//        the byte or half-word in every lane
//   AHB  byte lanes: the other bytes of the register keep their value
#pragma once
#include "io_bridges/qemu/stm32/peripheral.hpp"

namespace whirl::stm32 {

enum class Narrow : std::uint8_t { replicate, merge };

class WordBlock : public Peripheral {
 public:
  explicit WordBlock(std::string name, Narrow narrow = Narrow::replicate)
      : name_(std::move(name)), narrow_(narrow) {}

  const char* name() const final { return name_.c_str(); }
  std::uint32_t read(std::uint32_t offset, unsigned size) override {
    const std::uint32_t word = read_word(offset & ~3u);
    if (size == 4) return word;
    return (word >> (8 * (offset & 3))) & (size == 1 ? 0xFFu : 0xFFFFu);
  }
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override {
    if (size != 4) value = widen(offset, value, size);
    write_word(offset & ~3u, value);
  }

 protected:
  virtual std::uint32_t read_word(std::uint32_t offset) = 0;
  virtual void write_word(std::uint32_t offset, std::uint32_t value) = 0;

 private:
  std::uint32_t widen(std::uint32_t offset, std::uint32_t value, unsigned size) {
    const std::uint32_t mask = size == 1 ? 0xFFu : 0xFFFFu;
    if (narrow_ == Narrow::replicate) return (value & mask) * (size == 1 ? 0x01010101u : 0x10001u);
    const unsigned shift = 8 * (offset & 3);
    return (read_word(offset & ~3u) & ~(mask << shift)) | ((value & mask) << shift);
  }

  std::string name_;
  Narrow narrow_;
};

}  // namespace whirl::stm32
