// 72 MHz from an 8 MHz crystal: HCLK 72, PCLK1 36 (timers 72), PCLK2 72, converters 12 MHz.
#pragma once

namespace fw::esc {

void start_clock();  // without a crystal the image stays here, motor off, and the watchdog is not yet on
void start_watchdog();  // about 0.2 s on the 40 kHz oscillator: longer than saving takes

}  // namespace fw::esc
