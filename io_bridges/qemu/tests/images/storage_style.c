/* Memory parts as bare-metal drivers use them: everything polled, every wait counted. Board: PX4FMU's
   wiring. SD card on SPI3 (PC10, PC11, PB5), chip select PA4; EEPROM 24xx128 on I2C2 (PB10, PB11);
   MPU-6000 on SPI1 (PA5, PA6, PA7), chip select PB0; battery divider on PC0; terminal on USART2.
   The 8 MHz crystal without PLL. */
#include "f405.h"

typedef struct {
  reg32 CR1, CR2, SR, DR;
} spi_t;
#define SPI1 ((spi_t*)0x40013000)
#define SPI3 ((spi_t*)0x40003C00)
#define I2C2 ((i2c_t*)0x40005800)

static uint8_t block[512];

static void pin_mode(gpio_t* port, unsigned pin, uint32_t mode, uint32_t af) {
  port->AFR[pin >> 3] = (port->AFR[pin >> 3] & ~(0xFu << (pin & 7) * 4)) | af << (pin & 7) * 4;
  port->MODER = (port->MODER & ~(3u << pin * 2)) | mode << pin * 2;
}

static void set_up(void) {
  RCC->CR |= 1u << 16;
  while ((RCC->CR & 1u << 17) == 0) {
  }
  RCC->CFGR = 1;
  while ((RCC->CFGR & 0xCu) != 4) {
  }
  RCC->AHB1ENR |= 7;
  RCC->APB1ENR |= 1u << 15 | 1u << 17 | 1u << 22;
  RCC->APB2ENR |= 1u << 8 | 1u << 12;
  GPIOA->BSRR = 1u << 4;
  GPIOB->BSRR = 1;
  pin_mode(GPIOA, 2, 2, 7);
  pin_mode(GPIOA, 4, 1, 0);
  pin_mode(GPIOB, 0, 1, 0);
  for (unsigned pin = 5; pin <= 7; ++pin) pin_mode(GPIOA, pin, 2, 5);
  pin_mode(GPIOC, 10, 2, 6);
  pin_mode(GPIOC, 11, 2, 6);
  pin_mode(GPIOB, 5, 2, 6);
  GPIOB->OTYPER |= 3u << 10;
  pin_mode(GPIOB, 10, 2, 4);
  pin_mode(GPIOB, 11, 2, 4);
  pin_mode(GPIOC, 0, 3, 0);
  USART2->BRR = 69; /* 8 MHz / 115200 */
  USART2->CR1 = 1u << 13 | 1u << 3;
  DEMCR |= 1u << 24;
  DWT_CTRL |= 1;
}

void send(char c) {
  while ((USART2->SR & 0x80) == 0) {
  }
  USART2->DR = (uint8_t)c;
}

static void wait_us(uint32_t us) {
  const uint32_t from = DWT_CYCCNT;
  while (DWT_CYCCNT - from < us * 8) {
  }
}

/* Master, software NSS, mode 0 or 3. */
static void spi_init(spi_t* spi, uint32_t divider_code, uint32_t mode) {
  spi->CR1 = 0;
  spi->CR1 = 1u << 9 | 1u << 8 | 1u << 6 | divider_code << 3 | 1u << 2 | mode;
}

static uint8_t swap(spi_t* spi, uint8_t byte) {
  spi->DR = byte;
  while ((spi->SR & 1) == 0) {
  }
  return (uint8_t)spi->DR;
}

/* ---- Card */

static uint8_t command(uint8_t index, uint32_t argument, uint8_t crc) {
  swap(SPI3, 0xFF);
  swap(SPI3, 0x40 | index);
  for (int shift = 24; shift >= 0; shift -= 8) swap(SPI3, (uint8_t)(argument >> shift));
  swap(SPI3, crc);
  for (int i = 0; i < 9; ++i) {
    const uint8_t r1 = swap(SPI3, 0xFF);
    if ((r1 & 0x80) == 0) return r1;
  }
  return 0xFF;
}

static uint32_t four_bytes(void) {
  uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | swap(SPI3, 0xFF);
  return value;
}

static void card_start(void) {
  spi_init(SPI3, 4, 0); /* 8 MHz / 32 = 250 kHz */
  wait_us(2000);
  for (int i = 0; i < 10; ++i) swap(SPI3, 0xFF);
  GPIOA->BSRR = 1u << 20;
  say("cmd0", command(0, 0, 0x95));
  say("cmd8", command(8, 0x1AA, 0x87));
  say("echo", four_bytes());
  uint32_t tries = 0, r1 = 1;
  while (r1 != 0 && ++tries < 1000) {
    command(55, 0, 0x65);
    r1 = command(41, 0x40000000, 0x77);
  }
  say("acmd41", r1);
  say("waited", tries > 1);
  say("cmd58", command(58, 0, 0xFD));
  say("ocr", four_bytes());
  spi_init(SPI3, 0, 0); /* 4 MHz */
}

static uint32_t wait_token(void) {
  for (uint32_t i = 0; i < 200000; ++i) {
    const uint8_t token = swap(SPI3, 0xFF);
    if (token != 0xFF) return token;
  }
  return 0xFF;
}

static void card_capacity(void) {
  uint8_t csd[16];
  command(9, 0, 0xAF);
  say("csd_token", wait_token());
  for (int i = 0; i < 16; ++i) csd[i] = swap(SPI3, 0xFF);
  swap(SPI3, 0xFF);
  swap(SPI3, 0xFF);
  say("mebibytes", (((csd[7] & 0x3Fu) << 16 | csd[8] << 8 | csd[9]) + 1) / 2);
}

static uint8_t pattern(uint32_t at, uint32_t i) {
  return (uint8_t)(at * 31 + i * 7 + (i >> 8));
}

static uint32_t wait_ready(void) {
  const uint32_t from = DWT_CYCCNT;
  while (swap(SPI3, 0xFF) == 0) {
  }
  return (DWT_CYCCNT - from) / 8;
}

static void card_write(uint32_t first, uint32_t count) {
  say("cmd25", command(25, first, 0x01));
  uint32_t accepted = 0;
  for (uint32_t n = 0; n < count; ++n) {
    swap(SPI3, 0xFF);
    swap(SPI3, 0xFC);
    for (uint32_t i = 0; i < 512; ++i) swap(SPI3, pattern(first + n, i));
    swap(SPI3, 0);
    swap(SPI3, 0);
    accepted += (swap(SPI3, 0xFF) & 0x1F) == 0x05;
    wait_ready();
  }
  swap(SPI3, 0xFD);
  swap(SPI3, 0xFF);
  say("stop_us", wait_ready());
  say("accepted", accepted);
}

static uint32_t card_read(uint32_t at) {
  if (command(17, at, 0x01) != 0 || wait_token() != 0xFE) return 0;
  uint32_t right = 0;
  for (uint32_t i = 0; i < 512; ++i) {
    block[i] = swap(SPI3, 0xFF);
    right += block[i] == pattern(at, i);
  }
  swap(SPI3, 0xFF);
  swap(SPI3, 0xFF);
  return right;
}

/* ---- EEPROM */

static void i2c_init(void) {
  I2C2->CR1 = 1u << 15;
  I2C2->CR1 = 0;
  I2C2->CR2 = 8;
  I2C2->CCR = 1u << 15 | 7; /* 8 MHz / (3 x 7) = 381 kHz */
  I2C2->TRISE = 3;
  I2C2->CR1 = 1;
}

/* 1: the address was acknowledged. */
static int i2c_begin(uint8_t control) {
  I2C2->CR1 |= 1u << 8;
  while ((I2C2->SR1 & 1) == 0) {
  }
  I2C2->DR = control;
  while ((I2C2->SR1 & (1u << 1 | 1u << 10)) == 0) {
  }
  if ((I2C2->SR1 & 1u << 10) == 0) return 1;
  I2C2->SR1 &= ~(1u << 10);
  I2C2->CR1 |= 1u << 9;
  while ((I2C2->CR1 & 1u << 9) != 0) {
  }
  return 0;
}

static void i2c_put(uint8_t byte) {
  while ((I2C2->SR1 & 1u << 7) == 0) {
  }
  I2C2->DR = byte;
}

static void i2c_end(void) {
  while ((I2C2->SR1 & 1u << 2) == 0) {
  }
  I2C2->CR1 |= 1u << 9;
  while ((I2C2->CR1 & 1u << 9) != 0) {
  }
}

static void page_write(uint16_t at, uint32_t count, uint8_t first) {
  say("ee_found", (uint32_t)i2c_begin(0xA0));
  (void)I2C2->SR2;
  i2c_put((uint8_t)(at >> 8));
  i2c_put((uint8_t)at);
  for (uint32_t i = 0; i < count; ++i) i2c_put((uint8_t)(first + i));
  i2c_end();
}

static void poll_acknowledge(void) {
  const uint32_t from = DWT_CYCCNT;
  uint32_t refused = 0;
  while (!i2c_begin(0xA0)) ++refused;
  say("ee_cycle_us", (DWT_CYCCNT - from) / 8);
  say("ee_refused", refused > 10);
  (void)I2C2->SR2;
  I2C2->CR1 |= 1u << 9;
  while ((I2C2->CR1 & 1u << 9) != 0) {
  }
}

static uint8_t byte_read(uint16_t at) {
  i2c_begin(0xA0);
  (void)I2C2->SR2;
  i2c_put((uint8_t)(at >> 8));
  i2c_put((uint8_t)at);
  while ((I2C2->SR1 & 1u << 2) == 0) {
  }
  I2C2->CR1 &= ~(1u << 10);
  i2c_begin(0xA1);
  (void)I2C2->SR2;
  I2C2->CR1 |= 1u << 9;
  while ((I2C2->SR1 & 1u << 6) == 0) {
  }
  return (uint8_t)I2C2->DR;
}

/* ---- IMU */

static void imu_write(uint8_t address, uint8_t value) {
  GPIOB->BSRR = 1u << 16;
  swap(SPI1, address);
  swap(SPI1, value);
  GPIOB->BSRR = 1;
}

static uint32_t imu_word(uint8_t address) {
  GPIOB->BSRR = 1u << 16;
  swap(SPI1, 0x80 | address);
  uint32_t word = swap(SPI1, 0);
  word = word << 8 | swap(SPI1, 0);
  GPIOB->BSRR = 1;
  return word;
}

static void imu_fifo(void) {
  spi_init(SPI1, 2, 3); /* 1 MHz */
  wait_us(50000);
  imu_write(0x6B, 0x01);
  imu_write(0x6A, 0x10);
  imu_write(0x1A, 0x01);
  wait_us(50000);
  imu_write(0x23, 0x08);
  imu_write(0x6A, 0x54);
  wait_us(10200);
  const uint32_t bytes = imu_word(0x72);
  GPIOB->BSRR = 1u << 16;
  swap(SPI1, 0x80 | 0x74);
  uint32_t near_g = 0;
  for (uint32_t i = 0; i + 6 <= bytes; i += 6) {
    uint8_t sample[6];
    for (int k = 0; k < 6; ++k) sample[k] = swap(SPI1, 0);
    const int z = (int16_t)(sample[4] << 8 | sample[5]);
    near_g += z > 15000 && z < 17800; /* 16384 a g, and the part's errors */
  }
  GPIOB->BSRR = 1;
  const uint32_t rest = imu_word(0x72);
  say("fifo_bytes", bytes);
  say("fifo_samples_near_g", near_g);
  say("fifo_rest", rest <= 6); /* of the millisecond that reading took */
}

int main(void) {
  set_up();
  card_start();
  card_capacity();
  card_write(5000, 4);
  uint32_t right = 0;
  for (uint32_t n = 0; n < 4; ++n) right += card_read(5000 + n);
  say("right_bytes", right);
  say("blank_bytes", card_read(5004));
  i2c_init();
  page_write(0x0120, 32, 0x40);
  poll_acknowledge();
  say("ee_first", byte_read(0x0120));
  say("ee_last", byte_read(0x013F));
  say("ee_beyond", byte_read(0x0140));
  imu_fifo();
  ADC1->SQR3 = 10;
  ADC1->SMPR1 = 3;
  ADC1->CR2 = 1;
  wait_us(10);
  ADC1->CR2 |= 1u << 30;
  while ((ADC1->SR & 2) == 0) {
  }
  say("battery", ADC1->DR);
  say("done", 1);
  for (;;) wait_for_interrupt();
}
