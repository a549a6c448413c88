# Clocks, pins, DMA and serial ports, and the whole parts.
whirl_library(whirl_stm32 SOURCES rcc.cpp rcc_f4.cpp rcc_f1.cpp pwr.cpp flash_f4.cpp pins.cpp gpio_f4.cpp gpio_f1.cpp flash_f1.cpp dma_f1.cpp exti.cpp dma.cpp
              dma_bus.cpp spi.cpp usart.cpp uart_sampling.cpp i2c.cpp i2c_master.cpp i2c_slave.cpp
              part.cpp f405_tables.cpp stm32f405.cpp f103_tables.cpp stm32f103.cpp
              LINK whirl_devices whirl_stm32_b)
whirl_test(stm32f405_test SOURCES tests/stm32f405_test.cpp LINK whirl_stm32)
whirl_test(stm32f103_test SOURCES tests/stm32f103_test.cpp LINK whirl_stm32)
whirl_test(stm32_i2c_test SOURCES tests/i2c_master_test.cpp tests/i2c_slave_test.cpp LINK whirl_stm32)
whirl_test(stm32_serial_test SOURCES tests/spi_test.cpp tests/usart_test.cpp LINK whirl_stm32)
whirl_test(stm32_system_test SOURCES tests/dma_test.cpp tests/clocks_and_pins_test.cpp tests/reset_test.cpp LINK whirl_stm32)
