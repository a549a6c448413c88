/* A GPS and two radio-control receivers in the manner of Betaflight and ArduPilot: the GPS's baud rate
   found by version polls, set by an NMEA sentence, NAV-PVT tried first; the sum signal by input capture
   on TIM1 channel 3; SBUS by a UART with even parity, a frame by its pause. Board: 8 MHz crystal, GPS on
   USART6 (PC6, PC7), sum signal on PA10, SBUS on UART4 (PA1), a terminal on USART2. */
#include "f405.h"

#define UART4 ((usart_t*)0x40004C00)
#define USART6 ((usart_t*)0x40011400)
#define CYCLES_PER_MS 168000u

static void clocks(void) {
  clock_168_MHz();
  RCC->APB1ENR |= 1u << 17 | 1u << 19;
  RCC->APB2ENR |= 1u << 0 | 1u << 5;
  RCC->AHB1ENR |= 7;
  SYSTICK_LOAD = CYCLES_PER_MS - 1;
  SYSTICK_VAL = 0;
  SYSTICK_CTRL = 7;
}

static void pin(gpio_t* port, unsigned n, uint32_t af) {
  port->AFR[n / 8] |= af << 4 * (n % 8);
  port->MODER = (port->MODER & ~(3u << 2 * n)) | 2u << 2 * n;
}

static volatile uint32_t milliseconds;

void SysTick_Handler(void) {
  ++milliseconds;
}

static void wait_ms(uint32_t ms) {
  const uint32_t start = milliseconds;
  while (milliseconds - start < ms) wait_for_interrupt();
}

void send(char c) {
  while ((USART2->SR & 0x80) == 0) {
  }
  USART2->DR = (uint8_t)c;
}

/* ---- GPS */

static volatile uint8_t payload[100];
static volatile uint8_t step, class_, id_, a_, b_;
static volatile uint16_t length_, at_;
static volatile uint32_t acks, naks, sols, versions, hardware, bad;
static volatile uint32_t fix, satellites, latitude, longitude, north_cmps, first_itow, last_itow;

static uint32_t word(unsigned at) {
  return payload[at] | (uint32_t)payload[at + 1] << 8 | (uint32_t)payload[at + 2] << 16 |
         (uint32_t)payload[at + 3] << 24;
}

static void message(void) {
  if (class_ == 5) {
    if (id_ == 1) ++acks;
    if (id_ == 0) ++naks;
  } else if (class_ == 0x0A && id_ == 4) {
    ++versions;
    hardware = 0;
    for (unsigned i = 30; i < 38; ++i) hardware = hardware * 10 + payload[i] - '0';
  } else if (class_ == 1 && id_ == 2) {
    longitude = word(4);
    latitude = word(8);
  } else if (class_ == 1 && id_ == 0x12) {
    north_cmps = word(4);
  } else if (class_ == 1 && id_ == 6) {
    fix = payload[10];
    satellites = payload[47];
    last_itow = word(0);
    if (sols++ == 0) first_itow = last_itow;
  }
}

/* One state per byte of the header, as Betaflight's gpsNewFrameUBLOX. */
void USART6_Handler(void) {
  const uint32_t sr = USART6->SR;
  const uint8_t byte = (uint8_t)USART6->DR;
  if ((sr & 0x20) == 0) return;
  switch (step) {
    case 0:
      step = byte == 0xB5;
      return;
    case 1:
      step = byte == 0x62 ? 2 : 0;
      return;
    case 2:
      class_ = a_ = b_ = byte;
      break;
    case 3:
      id_ = byte;
      break;
    case 4:
      length_ = byte;
      break;
    case 5:
      length_ |= (uint16_t)(byte << 8);
      at_ = 0;
      break;
    case 6:
      if (at_ < sizeof payload) payload[at_] = byte;
      break;
    case 7:
      step = byte == a_ ? 8 : 0;
      if (step == 0) ++bad;
      return;
    default:
      step = 0;
      if (byte == b_) message();
      return;
  }
  if (step != 2) {
    a_ += byte;
    b_ += a_;
  }
  if (step < 6) {
    ++step;
    if (step == 6 && length_ == 0) step = 7;
    if (step == 6 && length_ > 200) step = 0;
  } else if (++at_ == length_) {
    step = 7;
  }
}

static void gps_baud(uint32_t baud) {
  while ((USART6->SR & 0x40) == 0) {
  }
  USART6->CR1 = 0;
  USART6->BRR = (84000000 + baud / 2) / baud;
  USART6->CR1 = 1u << 13 | 1u << 5 | 1u << 3 | 1u << 2;
  step = 0;
}

static void gps_byte(uint8_t byte) {
  while ((USART6->SR & 0x80) == 0) {
  }
  USART6->DR = byte;
}

static void gps_message(uint8_t class, uint8_t id, const uint8_t* data, uint8_t length) {
  const uint8_t head[4] = {class, id, length, 0};
  uint8_t a = 0, b = 0;
  gps_byte(0xB5);
  gps_byte(0x62);
  for (unsigned i = 0; i < 4u + length; ++i) {
    const uint8_t byte = i < 4 ? head[i] : data[i - 4];
    gps_byte(byte);
    a += byte;
    b += a;
  }
  gps_byte(a);
  gps_byte(b);
}

static void gps_sentence(const char* body) {
  static const char digits[] = "0123456789ABCDEF";
  uint8_t sum = 0;
  gps_byte('$');
  for (; *body != 0; ++body) {
    sum ^= (uint8_t)*body;
    gps_byte((uint8_t)*body);
  }
  gps_byte('*');
  gps_byte((uint8_t)digits[sum >> 4]);
  gps_byte((uint8_t)digits[sum & 15]);
  gps_byte('\r');
  gps_byte('\n');
}

/* 1: acknowledged, 0: refused, 2: no answer in 250 ms. */
static uint32_t configure(uint8_t id, const uint8_t* data, uint8_t length) {
  const uint32_t acks_before = acks, naks_before = naks;
  gps_message(6, id, data, length);
  for (unsigned k = 0; k < 250; ++k) {
    wait_ms(1);
    if (acks != acks_before) return 1;
    if (naks != naks_before) return 0;
  }
  return 2;
}

static void gps(void) {
  static const uint32_t bauds[4] = {57600, 38400, 115200, 9600};
  static const uint8_t pvt[] = {1, 7, 1}, posllh[] = {1, 2, 1}, velned[] = {1, 0x12, 1},
                       sol[] = {1, 6, 1}, rate_200[] = {200, 0, 1, 0, 0, 0},
                       rate_100[] = {100, 0, 1, 0, 0, 0};
  unsigned k = 0;
  while (versions == 0) {
    gps_baud(bauds[k]);
    gps_message(0x0A, 4, 0, 0);
    wait_ms(1200); /* behind a second of NMEA */
    if (versions == 0) k = (k + 1) % 4;
  }
  say("gps_baud", bauds[k]);
  say("gps_hardware", hardware);
  gps_sentence("PUBX,41,1,0003,0001,38400,0");
  wait_ms(500);
  gps_baud(38400);
  say("gps_pvt", configure(1, pvt, 3));
  say("gps_messages",
      configure(1, posllh, 3) + configure(1, velned, 3) * 10 + configure(1, sol, 3) * 100);
  say("gps_rate_200", configure(8, rate_200, 6));
  say("gps_rate_100", configure(8, rate_100, 6));
  for (unsigned i = 0; i < 9000 && fix != 3; ++i) wait_ms(1);
  sols = 0;
  wait_ms(2000);
  say("gps_solutions", sols);
  say("gps_span_ms", last_itow - first_itow);
  say("gps_fix", fix);
  say("gps_satellites", satellites);
  say("gps_latitude", latitude);
  say("gps_longitude", longitude);
  say("gps_north_cmps", north_cmps);
  say("gps_bad", bad);
}

/* ---- The sum signal */

static volatile uint16_t widths[16], channels[16];
static volatile uint16_t last_edge;
static volatile uint8_t width_count, channel_count;
static volatile uint32_t frames;

void TIM1_CC_Handler(void) {
  if ((TIM1->SR & 1u << 3) == 0) return;
  const uint16_t edge = (uint16_t)TIM1->CCR3;
  const uint16_t width = (uint16_t)(edge - last_edge);
  last_edge = edge;
  if (width > 2700) {
    if (width_count >= 4) {
      for (unsigned i = 0; i < width_count; ++i) channels[i] = widths[i];
      channel_count = width_count;
      ++frames;
    }
    width_count = 0;
  } else if (width > 750 && width < 2250 && width_count < 16) {
    widths[width_count++] = width;
  }
}

static void capture(void) {
  pin(GPIOA, 10, 1);
  TIM1->PSC = 167;
  TIM1->ARR = 0xFFFF;
  TIM1->EGR = 1;
  TIM1->CCMR2 = 1 | 3u << 4; /* IC3 from TI3, eight samples */
  TIM1->CCER = 1u << 8;
  TIM1->DIER = 1u << 3;
  TIM1->CR1 = 1;
  NVIC_ISER(0) = 1u << 27;
}

/* ---- SBUS */

static volatile uint8_t frame[25];
static volatile uint8_t have;
static volatile uint32_t last_byte, sbus_frames, line_errors, sbus_values[16], flags;

static void unpack(void) {
  for (unsigned i = 0; i < 16; ++i) {
    uint32_t value = 0;
    for (unsigned bit = 0; bit < 11; ++bit) {
      const unsigned n = i * 11 + bit;
      value |= (uint32_t)(frame[1 + n / 8] >> n % 8 & 1) << bit;
    }
    sbus_values[i] = value;
  }
  flags = frame[23];
  ++sbus_frames;
}

void UART4_Handler(void) {
  const uint32_t sr = UART4->SR, now = DWT_CYCCNT;
  const uint8_t byte = (uint8_t)UART4->DR;
  if ((sr & 0x20) == 0) return;
  if ((sr & 3) != 0) ++line_errors;
  if (now - last_byte > 3 * CYCLES_PER_MS) have = 0;
  last_byte = now;
  if (have == 0 && byte != 0x0F) return;
  if (have < 25) frame[have++] = byte;
  if (have == 25) {
    have = 26;
    if ((sr & 3) == 0) unpack();
  }
}

static void sbus(void) {
  pin(GPIOA, 1, 8);
  UART4->BRR = 420;
  UART4->CR2 = 2u << 12;
  UART4->CR1 = 1u << 13 | 1u << 12 | 1u << 10 | 1u << 5 | 1u << 2;
  NVIC_ISER(1) = 1u << (52 - 32);
}

int main(void) {
  clocks();
  pin(GPIOA, 2, 7);
  USART2->BRR = 42000000 / 115200;
  USART2->CR1 = 1u << 13 | 1u << 3;
  pin(GPIOC, 6, 8);
  pin(GPIOC, 7, 8);
  NVIC_ISER(2) = 1u << (71 - 64);
  capture();
  sbus();
  gps();
  const uint32_t frames_before = frames, sbus_before = sbus_frames;
  wait_ms(900);
  say("cppm_frames", frames - frames_before);
  say("cppm_count", channel_count);
  for (unsigned i = 0; i < 5; ++i) say("cppm", channels[i]);
  say("sbus_frames", sbus_frames - sbus_before);
  for (unsigned i = 0; i < 5; ++i) say("sbus", sbus_values[i]);
  say("sbus_flags", flags);
  say("line_errors", line_errors);
  say("done", 1);
  for (;;) {
  }
}
