#include "io_bridges/qemu/stm32/part_tables.hpp"

namespace whirl::stm32 {
namespace {

// clang-format off
constexpr AlternateFunction kAlternateFunctions[] = {
    {'A', 0, 1, "TIM2_CH1"}, {'A', 0, 1, "TIM2_ETR"}, {'A', 0, 2, "TIM5_CH1"},
    {'A', 0, 3, "TIM8_ETR"}, {'A', 0, 7, "USART2_CTS"}, {'A', 0, 8, "UART4_TX"},
    {'A', 1, 1, "TIM2_CH2"}, {'A', 1, 2, "TIM5_CH2"}, {'A', 1, 7, "USART2_RTS"},
    {'A', 1, 8, "UART4_RX"}, {'A', 2, 1, "TIM2_CH3"}, {'A', 2, 2, "TIM5_CH3"},
    {'A', 2, 3, "TIM9_CH1"}, {'A', 2, 7, "USART2_TX"}, {'A', 3, 1, "TIM2_CH4"},
    {'A', 3, 2, "TIM5_CH4"}, {'A', 3, 3, "TIM9_CH2"}, {'A', 3, 7, "USART2_RX"},
    {'A', 4, 5, "SPI1_NSS"}, {'A', 4, 6, "SPI3_NSS"}, {'A', 5, 1, "TIM2_CH1"},
    {'A', 5, 1, "TIM2_ETR"}, {'A', 5, 3, "TIM8_CH1N"}, {'A', 5, 5, "SPI1_SCK"},
    {'A', 6, 1, "TIM1_BKIN"}, {'A', 6, 2, "TIM3_CH1"}, {'A', 6, 3, "TIM8_BKIN"},
    {'A', 6, 5, "SPI1_MISO"}, {'A', 6, 9, "TIM13_CH1"}, {'A', 7, 1, "TIM1_CH1N"},
    {'A', 7, 2, "TIM3_CH2"}, {'A', 7, 3, "TIM8_CH1N"}, {'A', 7, 5, "SPI1_MOSI"},
    {'A', 7, 9, "TIM14_CH1"}, {'A', 8, 1, "TIM1_CH1"}, {'A', 8, 4, "I2C3_SCL"},
    {'A', 9, 1, "TIM1_CH2"}, {'A', 9, 7, "USART1_TX"}, {'A', 10, 1, "TIM1_CH3"},
    {'A', 10, 7, "USART1_RX"}, {'A', 11, 1, "TIM1_CH4"}, {'A', 11, 7, "USART1_CTS"},
    {'A', 11, 9, "CAN1_RX"}, {'A', 12, 1, "TIM1_ETR"}, {'A', 12, 7, "USART1_RTS"},
    {'A', 12, 9, "CAN1_TX"}, {'A', 15, 1, "TIM2_CH1"}, {'A', 15, 1, "TIM2_ETR"},
    {'A', 15, 5, "SPI1_NSS"}, {'A', 15, 6, "SPI3_NSS"}, {'B', 0, 1, "TIM1_CH2N"},
    {'B', 0, 2, "TIM3_CH3"}, {'B', 0, 3, "TIM8_CH2N"}, {'B', 1, 1, "TIM1_CH3N"},
    {'B', 1, 2, "TIM3_CH4"}, {'B', 1, 3, "TIM8_CH3N"}, {'B', 3, 1, "TIM2_CH2"},
    {'B', 3, 5, "SPI1_SCK"}, {'B', 3, 6, "SPI3_SCK"}, {'B', 4, 2, "TIM3_CH1"},
    {'B', 4, 5, "SPI1_MISO"}, {'B', 4, 6, "SPI3_MISO"}, {'B', 5, 2, "TIM3_CH2"},
    {'B', 5, 5, "SPI1_MOSI"}, {'B', 5, 6, "SPI3_MOSI"}, {'B', 5, 9, "CAN2_RX"},
    {'B', 6, 2, "TIM4_CH1"}, {'B', 6, 4, "I2C1_SCL"}, {'B', 6, 7, "USART1_TX"},
    {'B', 6, 9, "CAN2_TX"}, {'B', 7, 2, "TIM4_CH2"}, {'B', 7, 4, "I2C1_SDA"},
    {'B', 7, 7, "USART1_RX"}, {'B', 8, 2, "TIM4_CH3"}, {'B', 8, 3, "TIM10_CH1"},
    {'B', 8, 4, "I2C1_SCL"}, {'B', 8, 9, "CAN1_RX"}, {'B', 9, 2, "TIM4_CH4"},
    {'B', 9, 3, "TIM11_CH1"}, {'B', 9, 4, "I2C1_SDA"}, {'B', 9, 5, "SPI2_NSS"},
    {'B', 9, 9, "CAN1_TX"}, {'B', 10, 1, "TIM2_CH3"}, {'B', 10, 4, "I2C2_SCL"},
    {'B', 10, 5, "SPI2_SCK"}, {'B', 10, 7, "USART3_TX"}, {'B', 11, 1, "TIM2_CH4"},
    {'B', 11, 4, "I2C2_SDA"}, {'B', 11, 7, "USART3_RX"}, {'B', 12, 1, "TIM1_BKIN"},
    {'B', 12, 5, "SPI2_NSS"}, {'B', 12, 9, "CAN2_RX"}, {'B', 13, 1, "TIM1_CH1N"},
    {'B', 13, 5, "SPI2_SCK"}, {'B', 13, 7, "USART3_CTS"}, {'B', 13, 9, "CAN2_TX"},
    {'B', 14, 1, "TIM1_CH2N"}, {'B', 14, 3, "TIM8_CH2N"}, {'B', 14, 5, "SPI2_MISO"},
    {'B', 14, 7, "USART3_RTS"}, {'B', 14, 9, "TIM12_CH1"}, {'B', 15, 1, "TIM1_CH3N"},
    {'B', 15, 3, "TIM8_CH3N"}, {'B', 15, 5, "SPI2_MOSI"}, {'B', 15, 9, "TIM12_CH2"},
    {'C', 2, 5, "SPI2_MISO"}, {'C', 3, 5, "SPI2_MOSI"}, {'C', 6, 2, "TIM3_CH1"},
    {'C', 6, 3, "TIM8_CH1"}, {'C', 6, 8, "USART6_TX"}, {'C', 7, 2, "TIM3_CH2"},
    {'C', 7, 3, "TIM8_CH2"}, {'C', 7, 8, "USART6_RX"}, {'C', 8, 2, "TIM3_CH3"},
    {'C', 8, 3, "TIM8_CH3"}, {'C', 9, 2, "TIM3_CH4"}, {'C', 9, 3, "TIM8_CH4"},
    {'C', 9, 4, "I2C3_SDA"}, {'C', 10, 6, "SPI3_SCK"}, {'C', 10, 7, "USART3_TX"},
    {'C', 10, 8, "UART4_TX"}, {'C', 11, 6, "SPI3_MISO"}, {'C', 11, 7, "USART3_RX"},
    {'C', 11, 8, "UART4_RX"}, {'C', 12, 6, "SPI3_MOSI"}, {'C', 12, 8, "UART5_TX"},
    {'D', 0, 9, "CAN1_RX"}, {'D', 1, 9, "CAN1_TX"}, {'D', 2, 2, "TIM3_ETR"},
    {'D', 2, 8, "UART5_RX"}, {'D', 3, 7, "USART2_CTS"}, {'D', 4, 7, "USART2_RTS"},
    {'D', 5, 7, "USART2_TX"}, {'D', 6, 7, "USART2_RX"}, {'D', 8, 7, "USART3_TX"},
    {'D', 9, 7, "USART3_RX"}, {'D', 11, 7, "USART3_CTS"}, {'D', 12, 2, "TIM4_CH1"},
    {'D', 12, 7, "USART3_RTS"}, {'D', 13, 2, "TIM4_CH2"}, {'D', 14, 2, "TIM4_CH3"},
    {'D', 15, 2, "TIM4_CH4"}, {'E', 0, 2, "TIM4_ETR"}, {'E', 5, 3, "TIM9_CH1"},
    {'E', 6, 3, "TIM9_CH2"}, {'E', 7, 1, "TIM1_ETR"}, {'E', 8, 1, "TIM1_CH1N"},
    {'E', 9, 1, "TIM1_CH1"}, {'E', 10, 1, "TIM1_CH2N"}, {'E', 11, 1, "TIM1_CH2"},
    {'E', 12, 1, "TIM1_CH3N"}, {'E', 13, 1, "TIM1_CH3"}, {'E', 14, 1, "TIM1_CH4"},
    {'E', 15, 1, "TIM1_BKIN"}, {'F', 0, 4, "I2C2_SDA"}, {'F', 1, 4, "I2C2_SCL"},
    {'F', 6, 3, "TIM10_CH1"}, {'F', 7, 3, "TIM11_CH1"}, {'F', 8, 9, "TIM13_CH1"},
    {'F', 9, 9, "TIM14_CH1"}, {'G', 8, 8, "USART6_RTS"}, {'G', 9, 8, "USART6_RX"},
    {'G', 12, 8, "USART6_RTS"}, {'G', 13, 8, "USART6_CTS"}, {'G', 14, 8, "USART6_TX"},
    {'G', 15, 8, "USART6_CTS"}, {'H', 4, 4, "I2C2_SCL"}, {'H', 5, 4, "I2C2_SDA"},
    {'H', 6, 9, "TIM12_CH1"}, {'H', 7, 4, "I2C3_SCL"}, {'H', 8, 4, "I2C3_SDA"},
    {'H', 9, 9, "TIM12_CH2"}, {'H', 10, 2, "TIM5_CH1"}, {'H', 11, 2, "TIM5_CH2"},
    {'H', 12, 2, "TIM5_CH3"}, {'H', 13, 3, "TIM8_CH1N"}, {'H', 13, 9, "CAN1_TX"},
    {'H', 14, 3, "TIM8_CH2N"}, {'H', 15, 3, "TIM8_CH3N"}, {'I', 0, 2, "TIM5_CH4"},
    {'I', 0, 5, "SPI2_NSS"}, {'I', 1, 5, "SPI2_SCK"}, {'I', 2, 3, "TIM8_CH4"},
    {'I', 2, 5, "SPI2_MISO"}, {'I', 3, 3, "TIM8_ETR"}, {'I', 3, 5, "SPI2_MOSI"},
    {'I', 4, 3, "TIM8_BKIN"}, {'I', 5, 3, "TIM8_CH1"}, {'I', 6, 3, "TIM8_CH2"},
    {'I', 7, 3, "TIM8_CH3"}, {'I', 9, 9, "CAN1_RX"},
};

constexpr DmaRoute kDmaRoutes[] = {
    {1, 0, 0, "SPI3_RX"}, {1, 2, 0, "SPI3_RX"}, {1, 3, 0, "SPI2_RX"}, {1, 4, 0, "SPI2_TX"},
    {1, 5, 0, "SPI3_TX"}, {1, 7, 0, "SPI3_TX"}, {1, 0, 1, "I2C1_RX"}, {1, 2, 1, "TIM7_UP"},
    {1, 4, 1, "TIM7_UP"}, {1, 5, 1, "I2C1_RX"}, {1, 6, 1, "I2C1_TX"}, {1, 7, 1, "I2C1_TX"},
    {1, 0, 2, "TIM4_CH1"}, {1, 3, 2, "TIM4_CH2"}, {1, 6, 2, "TIM4_UP"}, {1, 7, 2, "TIM4_CH3"},
    {1, 1, 3, "TIM2_UP"}, {1, 1, 3, "TIM2_CH3"}, {1, 2, 3, "I2C3_RX"}, {1, 4, 3, "I2C3_TX"},
    {1, 5, 3, "TIM2_CH1"}, {1, 6, 3, "TIM2_CH2"}, {1, 6, 3, "TIM2_CH4"}, {1, 7, 3, "TIM2_UP"},
    {1, 7, 3, "TIM2_CH4"}, {1, 0, 4, "UART5_RX"}, {1, 1, 4, "USART3_RX"}, {1, 2, 4, "UART4_RX"},
    {1, 3, 4, "USART3_TX"}, {1, 4, 4, "UART4_TX"}, {1, 5, 4, "USART2_RX"}, {1, 6, 4, "USART2_TX"},
    {1, 7, 4, "UART5_TX"}, {1, 2, 5, "TIM3_CH4"}, {1, 2, 5, "TIM3_UP"}, {1, 4, 5, "TIM3_CH1"},
    {1, 4, 5, "TIM3_TRIG"}, {1, 5, 5, "TIM3_CH2"}, {1, 7, 5, "TIM3_CH3"}, {1, 0, 6, "TIM5_CH3"},
    {1, 0, 6, "TIM5_UP"}, {1, 1, 6, "TIM5_CH4"}, {1, 1, 6, "TIM5_TRIG"}, {1, 2, 6, "TIM5_CH1"},
    {1, 3, 6, "TIM5_CH4"}, {1, 3, 6, "TIM5_TRIG"}, {1, 4, 6, "TIM5_CH2"}, {1, 6, 6, "TIM5_UP"},
    {1, 1, 7, "TIM6_UP"}, {1, 2, 7, "I2C2_RX"}, {1, 3, 7, "I2C2_RX"}, {1, 4, 7, "USART3_TX"},
    {1, 5, 7, "DAC1"}, {1, 6, 7, "DAC2"}, {1, 7, 7, "I2C2_TX"}, {2, 0, 0, "ADC1"},
    {2, 2, 0, "TIM8_CH1"}, {2, 2, 0, "TIM8_CH2"}, {2, 2, 0, "TIM8_CH3"}, {2, 4, 0, "ADC1"},
    {2, 6, 0, "TIM1_CH1"}, {2, 6, 0, "TIM1_CH2"}, {2, 6, 0, "TIM1_CH3"}, {2, 2, 1, "ADC2"},
    {2, 3, 1, "ADC2"}, {2, 0, 2, "ADC3"}, {2, 1, 2, "ADC3"}, {2, 0, 3, "SPI1_RX"},
    {2, 2, 3, "SPI1_RX"}, {2, 3, 3, "SPI1_TX"}, {2, 5, 3, "SPI1_TX"}, {2, 2, 4, "USART1_RX"},
    {2, 5, 4, "USART1_RX"}, {2, 7, 4, "USART1_TX"}, {2, 1, 5, "USART6_RX"},
    {2, 2, 5, "USART6_RX"}, {2, 6, 5, "USART6_TX"}, {2, 7, 5, "USART6_TX"},
    {2, 0, 6, "TIM1_TRIG"}, {2, 1, 6, "TIM1_CH1"}, {2, 2, 6, "TIM1_CH2"}, {2, 3, 6, "TIM1_CH1"},
    {2, 4, 6, "TIM1_CH4"}, {2, 4, 6, "TIM1_TRIG"}, {2, 4, 6, "TIM1_COM"}, {2, 5, 6, "TIM1_UP"},
    {2, 6, 6, "TIM1_CH3"}, {2, 1, 7, "TIM8_UP"}, {2, 2, 7, "TIM8_CH1"}, {2, 3, 7, "TIM8_CH2"},
    {2, 4, 7, "TIM8_CH3"}, {2, 7, 7, "TIM8_CH4"}, {2, 7, 7, "TIM8_TRIG"}, {2, 7, 7, "TIM8_COM"},
};

constexpr BlockClock kBlockClocks[] = {
    {"GPIOA", 0x40020000, 0x30, 0x00000001, 0x10, 0x00000001},
    {"GPIOB", 0x40020400, 0x30, 0x00000002, 0x10, 0x00000002},
    {"GPIOC", 0x40020800, 0x30, 0x00000004, 0x10, 0x00000004},
    {"GPIOD", 0x40020C00, 0x30, 0x00000008, 0x10, 0x00000008},
    {"GPIOE", 0x40021000, 0x30, 0x00000010, 0x10, 0x00000010},
    {"GPIOF", 0x40021400, 0x30, 0x00000020, 0x10, 0x00000020},
    {"GPIOG", 0x40021800, 0x30, 0x00000040, 0x10, 0x00000040},
    {"GPIOH", 0x40021C00, 0x30, 0x00000080, 0x10, 0x00000080},
    {"GPIOI", 0x40022000, 0x30, 0x00000100, 0x10, 0x00000100},
    {"CRC", 0x40023000, 0x30, 0x00001000, 0x10, 0x00001000},
    {"BKPSRAM", 0x40024000, 0x30, 0x00040000, 0x10, 0x00040000},
    {"DMA1", 0x40026000, 0x30, 0x00200000, 0x10, 0x00200000},
    {"DMA2", 0x40026400, 0x30, 0x00400000, 0x10, 0x00400000},
    {"OTG_HS", 0x40040000, 0x30, 0x20000000, 0x10, 0x20000000},
    {"DCMI", 0x50050000, 0x34, 0x00000001, 0x14, 0x00000001},
    {"RNG", 0x50060800, 0x34, 0x00000040, 0x14, 0x00000040},
    {"OTG_FS", 0x50000000, 0x34, 0x00000080, 0x14, 0x00000080},
    {"FSMC", 0xA0000000, 0x38, 0x00000001, 0x18, 0x00000001},
    {"TIM2", 0x40000000, 0x40, 0x00000001, 0x20, 0x00000001},
    {"TIM3", 0x40000400, 0x40, 0x00000002, 0x20, 0x00000002},
    {"TIM4", 0x40000800, 0x40, 0x00000004, 0x20, 0x00000004},
    {"TIM5", 0x40000C00, 0x40, 0x00000008, 0x20, 0x00000008},
    {"TIM6", 0x40001000, 0x40, 0x00000010, 0x20, 0x00000010},
    {"TIM7", 0x40001400, 0x40, 0x00000020, 0x20, 0x00000020},
    {"TIM12", 0x40001800, 0x40, 0x00000040, 0x20, 0x00000040},
    {"TIM13", 0x40001C00, 0x40, 0x00000080, 0x20, 0x00000080},
    {"TIM14", 0x40002000, 0x40, 0x00000100, 0x20, 0x00000100},
    {"WWDG", 0x40002C00, 0x40, 0x00000800, 0x20, 0x00000800},
    {"SPI2", 0x40003800, 0x40, 0x00004000, 0x20, 0x00004000},
    {"SPI3", 0x40003C00, 0x40, 0x00008000, 0x20, 0x00008000},
    {"USART2", 0x40004400, 0x40, 0x00020000, 0x20, 0x00020000},
    {"USART3", 0x40004800, 0x40, 0x00040000, 0x20, 0x00040000},
    {"UART4", 0x40004C00, 0x40, 0x00080000, 0x20, 0x00080000},
    {"UART5", 0x40005000, 0x40, 0x00100000, 0x20, 0x00100000},
    {"I2C1", 0x40005400, 0x40, 0x00200000, 0x20, 0x00200000},
    {"I2C2", 0x40005800, 0x40, 0x00400000, 0x20, 0x00400000},
    {"I2C3", 0x40005C00, 0x40, 0x00800000, 0x20, 0x00800000},
    {"CAN1", 0x40006400, 0x40, 0x02000000, 0x20, 0x02000000},
    {"CAN2", 0x40006800, 0x40, 0x04000000, 0x20, 0x04000000},
    {"PWR", 0x40007000, 0x40, 0x10000000, 0x20, 0x10000000},
    {"DAC", 0x40007400, 0x40, 0x20000000, 0x20, 0x20000000},
    {"TIM1", 0x40010000, 0x44, 0x00000001, 0x24, 0x00000001},
    {"TIM8", 0x40010400, 0x44, 0x00000002, 0x24, 0x00000002},
    {"USART1", 0x40011000, 0x44, 0x00000010, 0x24, 0x00000010},
    {"USART6", 0x40011400, 0x44, 0x00000020, 0x24, 0x00000020},
    {"SDIO", 0x40012C00, 0x44, 0x00000800, 0x24, 0x00000800},
    {"SPI1", 0x40013000, 0x44, 0x00001000, 0x24, 0x00001000},
    {"SYSCFG", 0x40013800, 0x44, 0x00004000, 0x24, 0x00004000},
    {"TIM9", 0x40014000, 0x44, 0x00010000, 0x24, 0x00010000},
    {"TIM10", 0x40014400, 0x44, 0x00020000, 0x24, 0x00020000},
    {"TIM11", 0x40014800, 0x44, 0x00040000, 0x24, 0x00040000},
    {"ADC", 0x40012000, 0x44, 0x00000700, 0x24, 0x00000100},  // one reset bit for all three
};

// Datasheet table 7.
constexpr AnalogPin kAnalogPins[] = {
    {"PA0", 0, 0},    {"PA1", 1, 1},    {"PA2", 2, 2},    {"PA3", 3, 3},    {"PA4", 4, -1},
    {"PA5", 5, -1},   {"PA6", 6, -1},   {"PA7", 7, -1},   {"PB0", 8, -1},   {"PB1", 9, -1},
    {"PC0", 10, 10},  {"PC1", 11, 11},  {"PC2", 12, 12},  {"PC3", 13, 13},  {"PC4", 14, -1},
    {"PC5", 15, -1},  {"PF6", -1, 4},   {"PF7", -1, 5},   {"PF8", -1, 6},   {"PF9", -1, 7},
    {"PF10", -1, 8},  {"PF3", -1, 9},   {"PF4", -1, 14},  {"PF5", -1, 15}};

// RM0090 table 62.
constexpr SerialPort kSerialPorts[] = {
    {SerialKind::spi, 1, "SPI1", 35, true},      {SerialKind::spi, 2, "SPI2", 36, false},
    {SerialKind::spi, 3, "SPI3", 51, false},     {SerialKind::usart, 1, "USART1", 37, true},
    {SerialKind::usart, 2, "USART2", 38, false}, {SerialKind::usart, 3, "USART3", 39, false},
    {SerialKind::usart, 4, "UART4", 52, false},  {SerialKind::usart, 5, "UART5", 53, false},
    {SerialKind::usart, 6, "USART6", 71, true},  {SerialKind::i2c, 1, "I2C1", 31, false},
    {SerialKind::i2c, 2, "I2C2", 33, false},     {SerialKind::i2c, 3, "I2C3", 72, false}};
// clang-format on

}  // namespace

std::span<const AlternateFunction> f405_alternate_functions() {
  return kAlternateFunctions;
}
std::span<const DmaRoute> f405_dma_routes() {
  return kDmaRoutes;
}
const PartTables& f405_tables() {
  static const PartTables tables{kBlockClocks, kSerialPorts, kAnalogPins};
  return tables;
}

}  // namespace whirl::stm32
