// Test image: busy for ever, and never a word on any bus.
extern "C" void fw_main() {
  for (;;) {
    __asm volatile("nop");
  }
}
