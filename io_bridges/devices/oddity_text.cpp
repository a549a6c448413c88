#include "io_bridges/devices/oddity_text.hpp"

#include <array>
#include <cstdio>

#include "base/check.hpp"

namespace whirl::io {
namespace {

using core::Oddity;

// In the order of the enumeration; %u is the detail.
constexpr std::array<const char*, core::kOddities> kTexts{
    "read of a reserved address",
    "write to a reserved address",
    "write to a read-only one",
    "setting stored, but this model does not act on it",
    "written while starting up: the write is lost",
    "CONFIG.EXT_SYNC_SET is not modelled",
    "gyro self test is not modelled",
    "accelerometer self test and high-pass are not modelled",
    "FIFO of auxiliary slaves is not modelled",
    "FSYNC, I2C bypass and CLKOUT are not modelled",
    "interrupts other than DATA_RDY and FIFO_OFLOW are not modelled",
    "DMP and auxiliary I2C master are not modelled",
    "cycle mode and TEMP_DIS are not modelled",
    "DLPF_CFG 7 is reserved",
    "CLKSEL 4..7: there is no external clock here, sampling stops",
    "FIFO_R_W while USER_CTRL.FIFO_EN is 0: no byte passes",
    "SPI mode %u: the part needs 0 or 3",
    "SCK of %u kHz where 1 MHz is the limit",
    "SCK of %u kHz where 20 MHz is the limit",
    "command 0x%02X during the reload: it is lost",
    "unknown command 0x%02X",
    "conversion started during another one: its result is wrong",
    "ADC read while it converts: it reads 0, and the result to come is wrong",
    "ADC read with no result waiting: it reads 0",
    "PROM read while it converts",
    "a second byte after a command: it is ignored",
    "CONF_A bit 7 is reserved",
    "DO 7 is reserved: the rate stays",
    "MS 3 is reserved: the measurement stays",
    "CONF_B bits 4..0 must be 0",
    "MODE bits 7..2 (7: HS) are not modelled",
    "several registers in one write: no source says what it does",
};
static_assert(kTexts.back() != nullptr);

}  // namespace

std::string oddity_text(Oddity what, std::uint32_t detail, const core::RegisterMap* map) {
  const auto number = static_cast<std::size_t>(what);
  WHIRL_CHECK(number < kTexts.size(), number);
  char text[120];
  std::snprintf(text, sizeof text, kTexts[number], detail);
  if (what > Oddity::stored_only) return text;
  const bool known = map != nullptr && detail < map->size();
  char whole[160];
  std::snprintf(whole, sizeof whole, "register 0x%02X %s: %s", detail,
                known ? (*map)[detail].name : "", text);
  return whole;
}

}  // namespace whirl::io
