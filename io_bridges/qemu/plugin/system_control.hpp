// SPDX-License-Identifier: GPL-2.0-or-later
//
// The System Control Space (0xE000E000, 4 KiB) as the part has it, in front of QEMU's NVIC.
//
//   Here       SysTick (the board's own), DEMCR, SCR, four priority bits, SYSRESETREQ
//   Passed on  everything else, to QEMU's nvic_sysregs
//   Priority   the part stores the upper four bits. Stored with the lower ones set, a mask in
//              BASEPRI acts as on the part whether or not its own lower bits are set; reads mask
//   Left out   MRS of BASEPRI returns the lower bits as written
#pragma once
#include <cstdint>
#include <functional>

#include "io_bridges/qemu/board/board.hpp"
#include "io_bridges/qemu/plugin/qemu_api.hpp"

namespace whirl::qemu {

class SystemControl {
 public:
  SystemControl(const Api& api, board::Board& board, MemoryRegion* nvic,
                std::function<void()> reset_request,
                std::function<void(std::uint32_t address)> accessed);

  void map(MemoryRegion* parent, MemoryRegion& region);
  void core_was_reset();  // priorities back to the stored form of 0
  bool sleeps_deeply() const { return (scr_ & kSleep_deep) != 0; }
  void report_deep_sleep(io::Nanoseconds now);  // which is not modelled; once

  std::uint32_t word(std::uint32_t offset);  // of QEMU's NVIC, from 0xE000E000

 private:
  static constexpr std::uint32_t kSleep_deep = 1u << 2;  // of SCR

  void report_once(bool& reported, io::Nanoseconds now, const char* what);
  static std::uint32_t read_hook(void*, hwaddr, std::uint64_t*, unsigned, Attributes);
  static std::uint32_t write_hook(void*, hwaddr, std::uint64_t, unsigned, Attributes);
  std::uint32_t read(std::uint32_t offset, std::uint64_t& value, unsigned size, Attributes);
  std::uint32_t write(std::uint32_t offset, std::uint64_t value, unsigned size, Attributes);

  const Api& api_;
  board::Board& board_;
  MemoryRegion* nvic_;
  std::function<void()> reset_request_;
  std::function<void(std::uint32_t)> accessed_;
  std::uint32_t demcr_ = 0, scr_ = 0;
  bool deep_reported_ = false, on_exit_reported_ = false;
};

}  // namespace whirl::qemu
