/* Sleeps for ever: nothing wakes it. */
int main(void) {
  for (;;) __asm volatile("wfi");
}
