// A block that is not modelled but answers a driver which only probes: reset values of the manual,
// plain storage where the manual has storage, request bits that fall back by themselves.
//
//   Finding  its first touch, once: the firmware uses what nobody models
#pragma once
#include <initializer_list>
#include <map>
#include <string>

#include "io_bridges/qemu/stm32/peripheral.hpp"

namespace whirl::stm32 {

struct StubRegister {
  std::uint32_t offset = 0;
  std::uint32_t reset_value = 0;
  std::uint32_t writable = 0xFFFFFFFF;
  std::uint32_t self_clearing = 0;  // request bits that hardware takes back
};

class ProbeStub : public Peripheral {
 public:
  ProbeStub(const Chip& chip, std::string name, std::uint32_t base,
            std::initializer_list<StubRegister> registers);

  const char* name() const override { return name_.c_str(); }
  std::uint32_t read(std::uint32_t offset, unsigned size) override;
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override;
  void reset() override;

 private:
  struct Cell {
    StubRegister shape;
    std::uint32_t value = 0;
  };
  void report(std::uint32_t offset);

  Chip chip_;
  std::string name_;
  std::uint32_t base_;
  std::map<std::uint32_t, Cell> cells_;
  bool reported_ = false;
};

}  // namespace whirl::stm32
