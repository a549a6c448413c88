// Nothing but the page of settings of motor ESC_MOTOR_NUMBER, with the image's own defaults: flashed beside the
// unmodified image (esc_motor_2.elf), as a maker would on a vehicle that has four controllers.
#include "firmware/esc/image/settings_page.hpp"

namespace fw::esc::settings {

constexpr PageBytes kPageBytes({.motor_number = ESC_MOTOR_NUMBER, .calibration = {}});
static_assert(kPageBytes.whole());

extern constinit const std::array<std::uint8_t, PageBytes::kSize> settings_page;
[[gnu::section(".settings"), gnu::used]] constinit const std::array<std::uint8_t, PageBytes::kSize>
    settings_page = kPageBytes.bytes();

}  // namespace fw::esc::settings
