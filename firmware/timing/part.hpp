// What the timing images need of their part. Both run from their reset clock (HSI: 16 MHz on the
// STM32F405, 8 MHz on the STM32F103), where the flash may have any number of wait states, none included,
// and where no crystal matters.
//
//   Serial  115200 8N1: USART2 on PA2 of the STM32F405, USART1 on PA9 of the STM32F103; polled
//   Source  RM0090 3.5.1 and PM0075 (wait states), RM0090 3.8.1 and RM0008 3.3.3 (FLASH_ACR)
#pragma once
#include <cstdint>
#include <string_view>

namespace fw::timing {

enum class FlashAid : std::uint8_t {
  none,
  prefetch,
  cache,
  all
};  // without caches: all = prefetch

extern const std::string_view kPartName;
extern const std::uint32_t kMost_wait_states;
extern const bool kHas_flash_cache;
// Memory that only the data bus reaches, so that fetching from it faults; nullptr: the part has none.
std::uint16_t* not_executable();

void start_part();
void send(std::string_view text);  // returns when the last stop bit has gone out
void set_flash(std::uint32_t wait_states, FlashAid aid);  // caches come up empty
void divide_apb1_by_4(bool on);

}  // namespace fw::timing
