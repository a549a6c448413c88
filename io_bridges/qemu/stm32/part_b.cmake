# The function blocks: timers, converters, clocks of day, watchdogs, CAN.
whirl_library(whirl_stm32_b SOURCES timer.cpp timer_count.cpp timer_schedule.cpp timer_input.cpp
              timer_output.cpp adc.cpp adc_bank.cpp LINK whirl_devices)
whirl_test(stm32_timer_test SOURCES tests/timer_test.cpp LINK whirl_stm32_b)
whirl_test(stm32_adc_test SOURCES tests/adc_test.cpp LINK whirl_stm32_b)
