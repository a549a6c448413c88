// The acceptance filters of bxCAN: 28 banks shared by CAN1 and CAN2 (14 for CAN1 alone on F103).
//
//   Source   RM0090 sec. 32.7.4: scales, list and mask modes, numbering per FIFO over all banks of
//            that FIFO whether active or not, priority rules
#pragma once
#include <array>
#include <cstdint>

#include "io_bridges/protocols/can_frame.hpp"

namespace whirl::stm32 {

class CanFilters {
 public:
  explicit CanFilters(int banks) : banks_(banks) {}

  struct Match {
    bool accepted = false;
    int fifo = 0;
    std::uint32_t index = 0;  // filter match index
  };
  Match match(const io::CanFrame& frame, bool second_can) const;

  // FMR, FM1R, FS1R, FFA1R, FA1R and the banks, at 0x200 .. 0x31C of CAN1.
  std::uint32_t read(std::uint32_t offset) const;
  void write(std::uint32_t offset, std::uint32_t value);
  void reset();

 private:
  struct Candidate {
    bool matched, wide, list;
    std::uint32_t index;
  };
  int filters_in(int bank) const;
  bool one_matches(int bank, int which, std::uint32_t wide, std::uint32_t narrow) const;
  int first_of_second() const;

  int banks_;
  std::uint32_t fmr_ = 0x2A1C0E01, mode_ = 0, scale_ = 0, fifo_ = 0, active_ = 0;
  std::array<std::array<std::uint32_t, 2>, 28> bank_{};
};

}  // namespace whirl::stm32
