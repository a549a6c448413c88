/* The sensors of a flight controller in the manner of other people's drivers: MPU-6000 as AutoQuad has it (settings
   repeated until they read back, a burst of 15 bytes by DMA on each data ready, 8 kHz), MS5611 on SPI by RXNE
   interrupts and on I2C by event interrupts (AN520's CRC, second order), HMC5883L on its DRDY (Betaflight's
   settings, the data sheet's self test). Board: 8 MHz crystal; MPU-6000 on SPI1, PB0, interrupt PC3; MS5611 on SPI2,
   PB12; a second one on I2C2, 0x77; HMC5883L on I2C2, DRDY PB1; a terminal on USART2. */
#include "f405.h"

typedef struct {
  reg32 CR1, CR2, SR, DR;
} spi_t;
#define SPI1 ((spi_t*)0x40013000)
#define SPI2 ((spi_t*)0x40003800)
#define I2C2 ((i2c_t*)0x40005800)
#define EXTI_FTSR REG(0x40013C0C)

static volatile uint32_t milliseconds;

void SysTick_Handler(void) {
  ++milliseconds;
}

static void wait_us(uint32_t us) {
  const uint32_t from = DWT_CYCCNT;
  while (DWT_CYCCNT - from < us * 168) {
  }
}

void send(char c) {
  while ((USART2->SR & 0x80) == 0) {
  }
  USART2->DR = (uint8_t)c;
}

static void say_signed(const char* name, int32_t value) {
  say(name, (uint32_t)(value + 1000000));
}

static void pin(gpio_t* port, unsigned n, uint32_t mode, uint32_t af) {
  port->AFR[n / 8] |= af << 4 * (n % 8);
  port->MODER = (port->MODER & ~(3u << 2 * n)) | mode << 2 * n;
}

static void pins(void) {
  GPIOB->BSRR = 1u << 0 | 1u << 12;
  pin(GPIOA, 2, 2, 7);
  for (unsigned n = 5; n <= 7; ++n) pin(GPIOA, n, 2, 5);
  for (unsigned n = 13; n <= 15; ++n) pin(GPIOB, n, 2, 5);
  pin(GPIOB, 0, 1, 0);
  pin(GPIOB, 12, 1, 0);
  GPIOB->OTYPER |= 3u << 10;
  pin(GPIOB, 10, 2, 4);
  pin(GPIOB, 11, 2, 4);
}

/* ---- MPU-6000: settings polled at 656 kHz, data by DMA at 10.5 MHz */

static uint8_t burst[15];
static const uint8_t question[15] = {0x80 | 0x3B};
static volatile uint32_t bursts;
static volatile int32_t sums[7];

static uint8_t swap(spi_t* spi, uint8_t byte) {
  spi->DR = byte;
  while ((spi->SR & 1) == 0) {
  }
  return (uint8_t)spi->DR;
}

static uint8_t imu(uint8_t address, uint8_t value) {
  GPIOB->BSRR = 1u << 16;
  swap(SPI1, address);
  const uint8_t answer = swap(SPI1, value);
  wait_us(2);
  GPIOB->BSRR = 1;
  wait_us(15);
  return answer;
}

static uint32_t imu_set(uint8_t address, uint8_t value) {
  uint32_t tries = 0;
  do {
    imu(address, value);
  } while (++tries < 100 && imu(0x80 | address, 0) != value);
  return tries;
}

void EXTI3_Handler(void) {
  EXTI_PR = 1u << 3;
  GPIOB->BSRR = 1u << 16;
  DMA2->S[0].NDTR = sizeof burst;
  DMA2->S[3].NDTR = sizeof burst;
  DMA2->S[0].CR |= 1;
  DMA2->S[3].CR |= 1;
}

void DMA2_Stream0_Handler(void) {
  GPIOB->BSRR = 1;
  DMA2->LIFCR = 0x3Fu | 0x3Fu << 22;
  for (unsigned i = 0; i < 7; ++i) {
    sums[i] += (int16_t)(burst[1 + 2 * i] << 8 | burst[2 + 2 * i]);
  }
  ++bursts;
}

static void imu_set_up(void) {
  SPI1->CR1 = 1u << 9 | 1u << 8 | 1u << 6 | 6u << 3 | 1u << 2 | 3; /* 84 MHz / 128 */
  imu(0x6B, 0x80);
  wait_us(100000);
  say("imu_reset", imu(0x80 | 0x6B, 0));
  say("imu_tries", imu_set(0x6B, 0x03) + imu_set(0x6A, 0x10));
  say("imu_who", imu(0x80 | 0x75, 0));
  say("imu_settings", imu_set(0x1B, 0x10) + imu_set(0x1C, 0x10) + imu_set(0x19, 0) +
                          imu_set(0x1A, 0) + imu_set(0x37, 0x10) + imu_set(0x38, 0x01));
}

static void imu_burst(void) {
  SPI1->CR1 = 1u << 9 | 1u << 8 | 2u << 3 | 1u << 2 | 3; /* 84 MHz / 8 */
  SPI1->CR2 = 3;
  SPI1->CR1 |= 1u << 6;
  DMA2->S[0].PAR = DMA2->S[3].PAR = (uint32_t)&SPI1->DR;
  DMA2->S[0].M0AR = (uint32_t)burst;
  DMA2->S[3].M0AR = (uint32_t)question;
  DMA2->S[0].CR = 3u << 25 | 3u << 16 | 1u << 10 | 1u << 4;
  DMA2->S[3].CR = 3u << 25 | 2u << 16 | 1u << 10 | 1u << 6;
  SYSCFG_EXTICR(0) = (SYSCFG_EXTICR(0) & ~(15u << 12)) | 2u << 12;
  EXTI_RTSR |= 1u << 3;
  EXTI_IMR |= 1u << 3;
  NVIC_ISER(1) = 1u << (56 - 32);
  NVIC_ISER(0) = 1u << 9;
  wait_us(50000); /* the PLL's gyro has started */
  bursts = 0;
  for (unsigned i = 0; i < 7; ++i) sums[i] = 0;
  wait_us(200000);
  EXTI_IMR &= ~(1u << 3);
  wait_us(100);
  say("imu_bursts", bursts);
  for (unsigned i = 0; i < 7; ++i) say_signed("imu_mean", sums[i] / (int32_t)bursts);
}

/* ---- MS5611: what both buses share */

typedef uint32_t command_t(uint8_t command, unsigned answer); /* the answer's bytes, MSB first */

static unsigned an520_crc4(const uint16_t* prom) {
  uint32_t remainder = 0;
  for (unsigned i = 0; i < 16; ++i) {
    const uint32_t word = i == 15 ? prom[7] & 0xFF00u : prom[i / 2];
    remainder ^= i % 2 == 0 ? word >> 8 : word & 0xFF;
    for (unsigned bit = 0; bit < 8; ++bit) {
      remainder = (remainder & 0x8000) != 0 ? remainder << 1 ^ 0x3000 : remainder << 1;
    }
  }
  return remainder >> 12 & 15;
}

static void compensate(const uint16_t* c, uint32_t d1, uint32_t d2) {
  const int32_t dt = (int32_t)d2 - (c[5] << 8);
  int32_t temp = 2000 + (int32_t)((int64_t)dt * c[6] / 8388608);
  int64_t off = ((int64_t)c[2] << 16) + (int64_t)c[4] * dt / 128;
  int64_t sens = ((int64_t)c[1] << 15) + (int64_t)c[3] * dt / 256;
  if (temp < 2000) {
    const int64_t square = (int64_t)(temp - 2000) * (temp - 2000);
    off -= 5 * square / 2;
    sens -= 5 * square / 4;
    temp -= (int32_t)((int64_t)dt * dt >> 31);
  }
  say_signed("baro_temperature", temp);
  say("baro_pressure", (uint32_t)((((int64_t)d1 * sens >> 21) - off) >> 15));
}

static uint32_t converted(command_t* command, uint8_t convert) {
  command(convert, 0);
  wait_us(9040);
  return command(0, 3);
}

static void baro(command_t* command) {
  uint16_t prom[8];
  command(0x1E, 0);
  wait_us(2800);
  for (uint8_t n = 0; n < 8; ++n) prom[n] = (uint16_t)command((uint8_t)(0xA0 + 2 * n), 2);
  say("baro_crc", an520_crc4(prom) == (prom[7] & 15));
  say("baro_unasked", command(0, 3));
  const uint32_t d1 = converted(command, 0x48);
  say("baro_again", command(0, 3));
  const uint32_t d2 = converted(command, 0x58);
  say("baro_d1", d1);
  say("baro_d2", d2);
  compensate(prom, d1, d2);
  command(0x48, 0);
  wait_us(5000);
  say("baro_too_early", command(0, 3));
  wait_us(5000);
}

/* ---- MS5611 on SPI: a byte an interrupt */

static volatile uint32_t spi_answer;
static volatile unsigned spi_left;

void SPI2_Handler(void) {
  spi_answer = spi_answer << 8 | (SPI2->DR & 0xFF);
  if (--spi_left != 0) SPI2->DR = 0;
}

static uint32_t spi_command(uint8_t command, unsigned answer) {
  spi_answer = 0;
  spi_left = 1 + answer;
  GPIOB->BSRR = 1u << (16 + 12);
  SPI2->DR = command;
  while (spi_left != 0) {
  }
  if (command == 0x1E) wait_us(2800); /* selected until the PROM is loaded, as the sheet draws it */
  GPIOB->BSRR = 1u << 12;
  return spi_answer & ((1u << 8 * answer) - 1);
}

static void spi_baro(void) {
  SPI2->CR1 = 1u << 9 | 1u << 8 | 2u << 3 | 1u << 2; /* 42 MHz / 8, mode 0 */
  SPI2->CR2 = 1u << 6;
  SPI2->CR1 |= 1u << 6;
  NVIC_ISER(1) = 1u << (36 - 32);
  baro(spi_command);
}

/* ---- I2C: start, address and bytes by the event interrupt */

static volatile uint8_t i2c_out[2], i2c_in[6], i2c_address;
static volatile unsigned i2c_to_write, i2c_written, i2c_to_read, i2c_got, i2c_errors;
static volatile int i2c_busy;

static void i2c_stop(void) {
  I2C2->CR1 |= 1u << 9;
  I2C2->CR2 &= ~(1u << 10);
  i2c_busy = 0;
}

static void i2c_received(void) {
  i2c_in[i2c_got++] = (uint8_t)I2C2->DR;
  if (i2c_got + 1 == i2c_to_read) I2C2->CR1 = (I2C2->CR1 & ~(1u << 10)) | 1u << 9;
  if (i2c_got == i2c_to_read) {
    I2C2->CR2 &= ~(1u << 10);
    i2c_busy = 0;
  }
}

static void i2c_sent(void) {
  if (i2c_written < i2c_to_write) {
    I2C2->DR = i2c_out[i2c_written++];
    return;
  }
  I2C2->CR2 &= ~(1u << 10); /* the next event is BTF */
  if ((I2C2->SR1 & 1u << 2) == 0) return;
  if (i2c_to_read == 0) {
    i2c_stop();
    return;
  }
  i2c_to_write = 0;
  I2C2->CR1 |= 1u << 8 | 1u << 10;
}

void I2C2_EV_Handler(void) {
  const uint32_t sr1 = I2C2->SR1;
  if ((sr1 & 1) != 0) {
    I2C2->DR = (uint32_t)i2c_address << 1 | (i2c_to_write == 0);
  } else if ((sr1 & 2) != 0) {
    (void)I2C2->SR2;
    I2C2->CR2 |= 1u << 10;
  } else if ((sr1 & 1u << 6) != 0) {
    i2c_received();
  } else if ((sr1 & (1u << 7 | 1u << 2)) != 0) {
    i2c_sent();
  }
}

void I2C2_ER_Handler(void) {
  ++i2c_errors;
  I2C2->SR1 = 0;
  i2c_stop();
}

static void i2c_begin(uint8_t address, unsigned write, unsigned read) {
  while (i2c_busy || (I2C2->SR2 & 2) != 0) {
  }
  i2c_address = address;
  i2c_to_write = write;
  i2c_to_read = read;
  i2c_written = i2c_got = 0;
  i2c_busy = 1;
  I2C2->CR1 |= 1u << 8 | 1u << 10;
}

static void i2c_wait(void) {
  while (i2c_busy) {
  }
}

static void i2c_set_up(void) {
  I2C2->CR1 = 1u << 15;
  I2C2->CR1 = 0;
  I2C2->CR2 = 42 | 1u << 9 | 1u << 8;
  I2C2->CCR = 1u << 15 | 35; /* 400 kHz */
  I2C2->TRISE = 13;
  I2C2->CR1 = 1;
  NVIC_ISER(1) = 1u << (33 - 32) | 1u << (34 - 32);
}

/* The part wants a stop between command and answer. */
static uint32_t i2c_command(uint8_t command, unsigned answer) {
  i2c_out[0] = command;
  i2c_begin(0x77, 1, 0);
  i2c_wait();
  if (answer == 0) return 0;
  i2c_begin(0x77, 0, answer);
  i2c_wait();
  uint32_t value = 0;
  for (unsigned i = 0; i < answer; ++i) value = value << 8 | i2c_in[i];
  return value;
}

/* ---- HMC5883L */

static volatile uint32_t ready;

void EXTI1_Handler(void) {
  EXTI_PR = 1u << 1;
  ++ready;
}

static void mag_set(uint8_t address, uint8_t value) {
  i2c_out[0] = address;
  i2c_out[1] = value;
  i2c_begin(0x1E, 2, 0);
  i2c_wait();
}

static void mag_read(uint8_t address, unsigned count) {
  i2c_out[0] = address;
  i2c_begin(0x1E, 1, count);
  i2c_wait();
}

static void mag_next(uint32_t count) {
  const uint32_t from = ready;
  while (ready - from < count) wait_for_interrupt();
  mag_read(3, 6);
}

static void mag_say(const char* name) { /* X, Z, Y */
  for (unsigned i = 0; i < 6; i += 2) say_signed(name, (int16_t)(i2c_in[i] << 8 | i2c_in[i + 1]));
}

static void magnetometer(void) {
  SYSCFG_EXTICR(0) = (SYSCFG_EXTICR(0) & ~(15u << 4)) | 1u << 4;
  EXTI_FTSR |= 1u << 1;
  EXTI_IMR |= 1u << 1;
  NVIC_ISER(0) = 1u << 7;
  mag_read(10, 3);
  say("mag_identity", (uint32_t)i2c_in[0] << 16 | (uint32_t)i2c_in[1] << 8 | i2c_in[2]);
  mag_set(0, 0x78);
  mag_set(1, 0x20);
  mag_set(2, 0);
  mag_next(2);
  const uint32_t before = ready, since = milliseconds;
  while (milliseconds - since < 400) wait_for_interrupt();
  say("mag_ready", ready - before);
  mag_next(1);
  mag_say("mag");
  mag_set(0, 0x71); /* the sheet's self test */
  mag_set(1, 0xA0);
  mag_set(2, 0);
  mag_next(1);
  mag_next(1);
  mag_say("mag_test");
}

int main(void) {
  clock_168_MHz();
  RCC->AHB1ENR |= 7 | 1u << 22;
  RCC->APB1ENR |= 1u << 14 | 1u << 17 | 1u << 22;
  RCC->APB2ENR |= 1u << 12 | 1u << 14;
  SYSTICK_LOAD = 168000 - 1;
  SYSTICK_VAL = 0;
  SYSTICK_CTRL = 7;
  pins();
  USART2->BRR = 42000000 / 115200;
  USART2->CR1 = 1u << 13 | 1u << 3;
  wait_us(60000); /* the slowest of the three is up */
  imu_set_up();
  imu_burst();
  spi_baro();
  i2c_set_up();
  baro(i2c_command);
  magnetometer();
  say("i2c_errors", i2c_errors);
  say("done", 1);
  for (;;) wait_for_interrupt();
}
