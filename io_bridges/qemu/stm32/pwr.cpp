#include "io_bridges/qemu/stm32/pwr.hpp"

namespace whirl::stm32 {
namespace {

constexpr std::uint32_t CWUF = 1u << 2, CSBF = 1u << 3, PVDE = 1u << 4, VOS = 1u << 14;
constexpr std::uint32_t WUF = 1u << 0, SBF = 1u << 1, PVDO = 1u << 2, BRR = 1u << 3, EWUP = 1u << 8,
                        BRE = 1u << 9, VOSRDY = 1u << 14;

}  // namespace

void Pwr::reset() {
  cr_ = f4_ ? VOS : 0;
  csr_ = 0;
  detect();
}

void Pwr::set_vdd(double volts) {
  vdd_V_ = volts;
  detect();
}

void Pwr::detect() {
  // Datasheet, falling edge: 2.0 V and 0.1 V steps on F4; 2.1 V and 0.1 V steps on F1 (typical).
  const double threshold_V = (f4_ ? 1.98 : 2.08) + 0.1 * ((cr_ >> 5) & 7);
  const bool below = (cr_ & PVDE) != 0 && vdd_V_ < threshold_V;
  if (below == below_) return;
  below_ = below;
  if (pvd_) pvd_(below);
}

std::uint32_t Pwr::read_word(std::uint32_t offset) {
  if (offset == 0x00) return cr_;
  if (offset != 0x04) return 0;
  std::uint32_t value = csr_ | (below_ ? PVDO : 0);
  if (f4_) value |= VOSRDY | ((csr_ & BRE) != 0 ? BRR : 0);  // both regulators settle at once
  return value;
}

void Pwr::write_word(std::uint32_t offset, std::uint32_t value) {
  if (offset == 0x04) csr_ = (csr_ & (WUF | SBF)) | (value & (f4_ ? EWUP | BRE : EWUP));
  if (offset != 0x00) return;
  if ((value & CWUF) != 0) csr_ &= ~WUF;
  if ((value & CSBF) != 0) csr_ &= ~SBF;
  cr_ = value & (f4_ ? 0x43F3u : 0x1F3u);  // CWUF, CSBF read 0
  detect();
}

}  // namespace whirl::stm32
