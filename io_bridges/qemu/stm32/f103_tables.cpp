#include "io_bridges/qemu/stm32/part_tables.hpp"

namespace whirl::stm32 {
namespace {

// clang-format off
// Port, pin, signal, heard in input mode, MAPR field, and the field's values as bits.
constexpr RemapRow kRemaps[] = {
    {'A', 4, "SPI1_NSS", false, 0, 1, 1}, {'A', 15, "SPI1_NSS", false, 0, 1, 2},
    {'A', 5, "SPI1_SCK", false, 0, 1, 1}, {'B', 3, "SPI1_SCK", false, 0, 1, 2},
    {'A', 6, "SPI1_MISO", true, 0, 1, 1}, {'B', 4, "SPI1_MISO", true, 0, 1, 2},
    {'A', 7, "SPI1_MOSI", false, 0, 1, 1}, {'B', 5, "SPI1_MOSI", false, 0, 1, 2},
    {'B', 6, "I2C1_SCL", false, 1, 1, 1}, {'B', 8, "I2C1_SCL", false, 1, 1, 2},
    {'B', 7, "I2C1_SDA", false, 1, 1, 1}, {'B', 9, "I2C1_SDA", false, 1, 1, 2},
    {'A', 9, "USART1_TX", false, 2, 1, 1}, {'B', 6, "USART1_TX", false, 2, 1, 2},
    {'A', 10, "USART1_RX", true, 2, 1, 1}, {'B', 7, "USART1_RX", true, 2, 1, 2},
    {'A', 0, "USART2_CTS", true, 3, 1, 1}, {'D', 3, "USART2_CTS", true, 3, 1, 2},
    {'A', 1, "USART2_RTS", false, 3, 1, 1}, {'D', 4, "USART2_RTS", false, 3, 1, 2},
    {'A', 2, "USART2_TX", false, 3, 1, 1}, {'D', 5, "USART2_TX", false, 3, 1, 2},
    {'A', 3, "USART2_RX", true, 3, 1, 1}, {'D', 6, "USART2_RX", true, 3, 1, 2},
    {'B', 10, "USART3_TX", false, 4, 3, 1}, {'C', 10, "USART3_TX", false, 4, 3, 2},
    {'D', 8, "USART3_TX", false, 4, 3, 8}, {'B', 11, "USART3_RX", true, 4, 3, 1},
    {'C', 11, "USART3_RX", true, 4, 3, 2}, {'D', 9, "USART3_RX", true, 4, 3, 8},
    {'B', 13, "USART3_CTS", true, 4, 3, 3}, {'D', 11, "USART3_CTS", true, 4, 3, 8},
    {'B', 14, "USART3_RTS", false, 4, 3, 3}, {'D', 12, "USART3_RTS", false, 4, 3, 8},
    {'A', 12, "TIM1_ETR", true, 6, 3, 3}, {'E', 7, "TIM1_ETR", true, 6, 3, 8},
    {'A', 8, "TIM1_CH1", true, 6, 3, 3}, {'E', 9, "TIM1_CH1", true, 6, 3, 8},
    {'A', 9, "TIM1_CH2", true, 6, 3, 3}, {'E', 11, "TIM1_CH2", true, 6, 3, 8},
    {'A', 10, "TIM1_CH3", true, 6, 3, 3}, {'E', 13, "TIM1_CH3", true, 6, 3, 8},
    {'A', 11, "TIM1_CH4", true, 6, 3, 3}, {'E', 14, "TIM1_CH4", true, 6, 3, 8},
    {'B', 12, "TIM1_BKIN", true, 6, 3, 1}, {'A', 6, "TIM1_BKIN", true, 6, 3, 2},
    {'E', 15, "TIM1_BKIN", true, 6, 3, 8}, {'B', 13, "TIM1_CH1N", false, 6, 3, 1},
    {'A', 7, "TIM1_CH1N", false, 6, 3, 2}, {'E', 8, "TIM1_CH1N", false, 6, 3, 8},
    {'B', 14, "TIM1_CH2N", false, 6, 3, 1}, {'B', 0, "TIM1_CH2N", false, 6, 3, 2},
    {'E', 10, "TIM1_CH2N", false, 6, 3, 8}, {'B', 15, "TIM1_CH3N", false, 6, 3, 1},
    {'B', 1, "TIM1_CH3N", false, 6, 3, 2}, {'E', 12, "TIM1_CH3N", false, 6, 3, 8},
    {'A', 0, "TIM2_CH1", true, 8, 3, 5}, {'A', 15, "TIM2_CH1", true, 8, 3, 10},
    {'A', 0, "TIM2_ETR", true, 8, 3, 5}, {'A', 15, "TIM2_ETR", true, 8, 3, 10},
    {'A', 1, "TIM2_CH2", true, 8, 3, 5}, {'B', 3, "TIM2_CH2", true, 8, 3, 10},
    {'A', 2, "TIM2_CH3", true, 8, 3, 3}, {'B', 10, "TIM2_CH3", true, 8, 3, 12},
    {'A', 3, "TIM2_CH4", true, 8, 3, 3}, {'B', 11, "TIM2_CH4", true, 8, 3, 12},
    {'A', 6, "TIM3_CH1", true, 10, 3, 1}, {'B', 4, "TIM3_CH1", true, 10, 3, 4},
    {'C', 6, "TIM3_CH1", true, 10, 3, 8}, {'A', 7, "TIM3_CH2", true, 10, 3, 1},
    {'B', 5, "TIM3_CH2", true, 10, 3, 4}, {'C', 7, "TIM3_CH2", true, 10, 3, 8},
    {'B', 0, "TIM3_CH3", true, 10, 3, 5}, {'C', 8, "TIM3_CH3", true, 10, 3, 8},
    {'B', 1, "TIM3_CH4", true, 10, 3, 5}, {'C', 9, "TIM3_CH4", true, 10, 3, 8},
    {'B', 6, "TIM4_CH1", true, 12, 1, 1}, {'D', 12, "TIM4_CH1", true, 12, 1, 2},
    {'B', 7, "TIM4_CH2", true, 12, 1, 1}, {'D', 13, "TIM4_CH2", true, 12, 1, 2},
    {'B', 8, "TIM4_CH3", true, 12, 1, 1}, {'D', 14, "TIM4_CH3", true, 12, 1, 2},
    {'B', 9, "TIM4_CH4", true, 12, 1, 1}, {'D', 15, "TIM4_CH4", true, 12, 1, 2},
    {'D', 2, "TIM3_ETR", true, 0, 0, 1}, {'E', 0, "TIM4_ETR", true, 0, 0, 1},
    {'A', 11, "CAN1_RX", true, 13, 3, 1}, {'B', 8, "CAN1_RX", true, 13, 3, 4},
    {'D', 0, "CAN1_RX", true, 13, 3, 8}, {'A', 12, "CAN1_TX", false, 13, 3, 1},
    {'B', 9, "CAN1_TX", false, 13, 3, 4}, {'D', 1, "CAN1_TX", false, 13, 3, 8},
    {'B', 12, "SPI2_NSS", false, 0, 0, 1}, {'B', 13, "SPI2_SCK", false, 0, 0, 1},
    {'B', 14, "SPI2_MISO", true, 0, 0, 1}, {'B', 15, "SPI2_MOSI", false, 0, 0, 1},
    {'B', 10, "I2C2_SCL", false, 0, 0, 1}, {'B', 11, "I2C2_SDA", false, 0, 0, 1},
};

constexpr DmaRoute kDmaRoutes[] = {
    {1, 1, 0, "ADC1"}, {1, 1, 0, "TIM2_CH3"}, {1, 1, 0, "TIM4_CH1"}, {1, 2, 0, "SPI1_RX"},
    {1, 2, 0, "USART3_TX"}, {1, 2, 0, "TIM1_CH1"}, {1, 2, 0, "TIM2_UP"}, {1, 2, 0, "TIM3_CH3"},
    {1, 3, 0, "SPI1_TX"}, {1, 3, 0, "USART3_RX"}, {1, 3, 0, "TIM1_CH2"}, {1, 3, 0, "TIM3_CH4"},
    {1, 3, 0, "TIM3_UP"}, {1, 4, 0, "SPI2_RX"}, {1, 4, 0, "USART1_TX"}, {1, 4, 0, "I2C2_TX"},
    {1, 4, 0, "TIM1_CH4"}, {1, 4, 0, "TIM1_TRIG"}, {1, 4, 0, "TIM1_COM"}, {1, 4, 0, "TIM4_CH2"},
    {1, 5, 0, "SPI2_TX"}, {1, 5, 0, "USART1_RX"}, {1, 5, 0, "I2C2_RX"}, {1, 5, 0, "TIM1_UP"},
    {1, 5, 0, "TIM2_CH1"}, {1, 5, 0, "TIM4_CH3"}, {1, 6, 0, "USART2_RX"}, {1, 6, 0, "I2C1_TX"},
    {1, 6, 0, "TIM1_CH3"}, {1, 6, 0, "TIM3_CH1"}, {1, 6, 0, "TIM3_TRIG"}, {1, 7, 0, "USART2_TX"},
    {1, 7, 0, "I2C1_RX"}, {1, 7, 0, "TIM2_CH2"}, {1, 7, 0, "TIM2_CH4"}, {1, 7, 0, "TIM4_UP"},
};

constexpr BlockClock kBlockClocks[] = {
    {"AFIO", 0x40010000, 0x18, 0x00000001, 0x0C, 0x00000001},
    {"GPIOA", 0x40010800, 0x18, 0x00000004, 0x0C, 0x00000004},
    {"GPIOB", 0x40010C00, 0x18, 0x00000008, 0x0C, 0x00000008},
    {"GPIOC", 0x40011000, 0x18, 0x00000010, 0x0C, 0x00000010},
    {"GPIOD", 0x40011400, 0x18, 0x00000020, 0x0C, 0x00000020},
    {"GPIOE", 0x40011800, 0x18, 0x00000040, 0x0C, 0x00000040},
    {"ADC1", 0x40012400, 0x18, 0x00000200, 0x0C, 0x00000200},
    {"ADC2", 0x40012800, 0x18, 0x00000400, 0x0C, 0x00000400},
    {"TIM1", 0x40012C00, 0x18, 0x00000800, 0x0C, 0x00000800},
    {"SPI1", 0x40013000, 0x18, 0x00001000, 0x0C, 0x00001000},
    {"USART1", 0x40013800, 0x18, 0x00004000, 0x0C, 0x00004000},
    {"TIM2", 0x40000000, 0x1C, 0x00000001, 0x10, 0x00000001},
    {"TIM3", 0x40000400, 0x1C, 0x00000002, 0x10, 0x00000002},
    {"TIM4", 0x40000800, 0x1C, 0x00000004, 0x10, 0x00000004},
    {"WWDG", 0x40002C00, 0x1C, 0x00000800, 0x10, 0x00000800},
    {"SPI2", 0x40003800, 0x1C, 0x00004000, 0x10, 0x00004000},
    {"USART2", 0x40004400, 0x1C, 0x00020000, 0x10, 0x00020000},
    {"USART3", 0x40004800, 0x1C, 0x00040000, 0x10, 0x00040000},
    {"I2C1", 0x40005400, 0x1C, 0x00200000, 0x10, 0x00200000},
    {"I2C2", 0x40005800, 0x1C, 0x00400000, 0x10, 0x00400000},
    {"USB", 0x40005C00, 0x1C, 0x00800000, 0x10, 0x00800000},
    {"CAN1", 0x40006400, 0x1C, 0x02000000, 0x10, 0x02000000},
    {"BKP", 0x40006C00, 0x1C, 0x08000000, 0x10, 0x08000000},
    {"PWR", 0x40007000, 0x1C, 0x10000000, 0x10, 0x10000000},
    {"DMA1", 0x40020000, 0x14, 0x00000001, 0x00, 0x00000000},
    {"CRC", 0x40023000, 0x14, 0x00000040, 0x00, 0x00000000},
};

constexpr SerialPort kSerialPorts[] = {
    {SerialKind::spi, 1, "SPI1", 35, true},     {SerialKind::spi, 2, "SPI2", 36, false},
    {SerialKind::usart, 1, "USART1", 37, true}, {SerialKind::usart, 2, "USART2", 38, false},
    {SerialKind::usart, 3, "USART3", 39, false},
    {SerialKind::i2c, 1, "I2C1", 31, false},    {SerialKind::i2c, 2, "I2C2", 33, false}};

constexpr AnalogPin kAnalogPins[] = {
    {"PA0", 0, -1},  {"PA1", 1, -1},  {"PA2", 2, -1},  {"PA3", 3, -1},
    {"PA4", 4, -1},  {"PA5", 5, -1},  {"PA6", 6, -1},  {"PA7", 7, -1},
    {"PB0", 8, -1},  {"PB1", 9, -1},  {"PC0", 10, -1}, {"PC1", 11, -1},
    {"PC2", 12, -1}, {"PC3", 13, -1}, {"PC4", 14, -1}, {"PC5", 15, -1}};
// clang-format on

}  // namespace

const PartTables& f103_tables() {
  static const PartTables tables{kBlockClocks, kSerialPorts, kAnalogPins};
  return tables;
}
std::span<const RemapRow> f103_remaps() {
  return kRemaps;
}
std::span<const DmaRoute> f103_dma_routes() {
  return kDmaRoutes;
}

}  // namespace whirl::stm32
