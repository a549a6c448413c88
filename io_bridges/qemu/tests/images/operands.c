/* Accesses that are not aligned, and long multiplications, a hundred of each: tells what each takes more
   than its plainest form, and last how many results were wrong. */
#include "part.h"

#ifdef F4
#define CLOCK 16000000u
#else
#define CLOCK 8000000u
#endif
#define WORDS 0x20000400u

/* A function each, with all addresses given: a pool of literals would lie out of reach behind so much. */
#define FORM(name, code)                                                                      \
  __attribute__((noinline)) static uint32_t name(volatile uint32_t* counter, uint32_t a,      \
                                                 uint32_t b) {                                \
    uint32_t from, to;                                                                        \
    __asm volatile(".balign 16\n ldr %0, [%2]\n .rept 100\n" code "\n .endr\n ldr %1, [%2]\n" \
                   : "=&r"(from), "=&r"(to)                                                   \
                   : "r"(counter), "r"(a), "r"(b)                                             \
                   : "r4", "r5", "memory");                                                   \
    return to - from;                                                                         \
  }
FORM(load_word, "ldr r4, [%3]")
FORM(store_word, "str r4, [%3]")
FORM(load_half, "ldrh r4, [%3]")
FORM(load_signed_half, "ldrsh r4, [%3]")
FORM(store_half, "strh r4, [%3]")
FORM(load_byte, "ldrb r4, [%3]")
FORM(multiply, "umull r4, r5, %3, %4")
FORM(multiply_signed, "smull r4, r5, %3, %4")
FORM(accumulate, "umlal r4, r5, %3, %4")
FORM(accumulate_signed, "smlal r4, r5, %3, %4")

typedef uint32_t form(volatile uint32_t*, uint32_t, uint32_t);

static void more(form* dearer, uint32_t a, uint32_t b, form* plain, uint32_t plain_a,
                 uint32_t plain_b) {
  say(dearer(&CYCCNT, a, b) - plain(&CYCCNT, plain_a, plain_b));
}

static void accesses(void) {
  form* const forms[] = {load_word, store_word, load_half, load_signed_half, store_half, load_byte};
  for (uint32_t place = 1; place < 4; ++place) {
    for (int n = 0; n < 6; ++n) more(forms[n], WORDS + place, 0, forms[n], WORDS, 0);
  }
}

static void products(void) {
  more(multiply, 0x10000, 7, multiply, 5, 7);
  more(multiply, 0xFFFFFFFF, 0x10000, multiply, 0xFFFF, 0xFFFF);
  more(multiply_signed, (uint32_t)-5, (uint32_t)-7, multiply_signed, 5, 7);
  more(multiply_signed, (uint32_t)-40000, 40000, multiply_signed, (uint32_t)-32768, 32767);
  more(accumulate, 5, 7, multiply, 5, 7);
  more(accumulate_signed, 5, 7, multiply_signed, 5, 7);
}

static uint32_t wrong_results(void) {
  volatile uint8_t* const bytes = (volatile uint8_t*)WORDS;
  uint32_t a = 1, b = 3, wrong = 0;
  for (uint32_t n = 0; n < 64; ++n) bytes[n] = (uint8_t)(37 * n + 11);
  for (uint32_t n = 0; n < 32; ++n) {
    uint32_t word, half;
    __asm volatile("ldr %0, [%2]\n ldrh %1, [%2]" : "=&r"(word), "=&r"(half) : "r"(bytes + n));
    const uint32_t low = bytes[n] | (uint32_t)bytes[n + 1] << 8;
    wrong += half != low;
    wrong += word != (low | (uint32_t)bytes[n + 2] << 16 | (uint32_t)bytes[n + 3] << 24);
    uint32_t back;
    __asm volatile("str %1, [%2]\n ldr %0, [%2]" : "=&r"(back) : "r"(word), "r"(bytes + n));
    wrong += back != word;
  }
  for (int n = 0; n < 500; ++n) {
    a = a * 1664525u + 1013904223u;
    b = (b * 22695477u + 1u) >> (n & 15);
    const uint32_t cross = (a >> 16) * (b & 0xFFFF), other = (a & 0xFFFF) * (b >> 16);
    const uint32_t low = (a & 0xFFFF) * (b & 0xFFFF), middle = cross + (low >> 16);
    const uint32_t carried = other + (middle & 0xFFFF);
    const uint32_t high = (a >> 16) * (b >> 16) + (middle >> 16) + (carried >> 16);
    uint32_t got_low, got_high, signed_low, signed_high;
    __asm volatile("umull %0, %1, %2, %3" : "=&r"(got_low), "=&r"(got_high) : "r"(a), "r"(b));
    __asm volatile("smull %0, %1, %2, %3" : "=&r"(signed_low), "=&r"(signed_high) : "r"(a), "r"(b));
    wrong += got_low != a * b || got_high != high;
    wrong += signed_low != a * b || signed_high != high - (a >> 31 ? b : 0) - (b >> 31 ? a : 0);
  }
  return wrong;
}

int main(void) {
  open_terminal((CLOCK + 57600) / 115200);
  DEMCR |= 1u << 24;
  DWT_CTRL |= 1;
  FLASH_ACR &= ~7u; /* no wait states: only the core counts */
  accesses();
  products();
  say(wrong_results());
  for (;;) __asm volatile("wfi");
}
