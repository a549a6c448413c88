// Test image: sleeps for ever, with nothing that could wake it.
extern "C" void fw_main() {
  for (;;) __asm volatile("wfi");
}
