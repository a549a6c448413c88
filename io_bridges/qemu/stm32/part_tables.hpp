// The parts as tables: which signal reaches which pin, which request which DMA stream, where a block
// sits and which RCC bits belong to it.
//
//   Source  F405: datasheet tables 7 and 9, RM0090 tables 1, 42, 43, 62, chapter 7
//           F103: datasheet table 5, RM0008 tables 3, 63, 78, chapters 7 and 9.3
#pragma once
#include <cstdint>
#include <span>

#include "io_bridges/qemu/stm32/gpio_f1.hpp"

namespace whirl::stm32 {

struct AlternateFunction {
  char port;
  std::uint8_t pin, af;
  const char* signal;
};
struct DmaRoute {
  std::uint8_t controller, stream, channel;  // F103: stream is the channel, channel is 0
  const char* request;
};
// RCC registers by offset; reset 0: the block has no reset bit.
struct BlockClock {
  const char* name;
  std::uint32_t base;
  std::uint32_t enable, enable_mask;
  std::uint32_t reset, reset_mask;
};
// The analog inputs and their channels; -1: not on this converter.
struct AnalogPin {
  const char* pin;
  int adc12, adc3;
};
enum class SerialKind : std::uint8_t { spi, usart, i2c };
struct SerialPort {
  SerialKind kind;
  int number;
  const char* name;
  int irq;  // I2C: of the events; the errors' is the next
  bool on_apb2;
};

// What every part has, for the shared half of the assembly (part.hpp).
struct PartTables {
  std::span<const BlockClock> clocks;
  std::span<const SerialPort> serial_ports;
  std::span<const AnalogPin> analog_pins;
};

const PartTables& f405_tables();
std::span<const AlternateFunction> f405_alternate_functions();
std::span<const DmaRoute> f405_dma_routes();

const PartTables& f103_tables();
std::span<const RemapRow> f103_remaps();
std::span<const DmaRoute> f103_dma_routes();

}  // namespace whirl::stm32
