# The function blocks: timers, converters, clocks of day, watchdogs, CAN.
whirl_library(whirl_stm32_b SOURCES timer.cpp timer_count.cpp timer_schedule.cpp timer_input.cpp
              timer_output.cpp adc.cpp adc_bank.cpp crc.cpp watchdog.cpp rng.cpp dwt.cpp
              dac.cpp rtc.cpp rtc_alarm.cpp rtc_f1.cpp can_filters.cpp bxcan.cpp probe_stub.cpp
              function_block_set.cpp f405_function_blocks.cpp f103_function_blocks.cpp
              LINK whirl_devices)
whirl_test(stm32_timer_test SOURCES tests/timer_test.cpp LINK whirl_stm32_b)
whirl_test(stm32_adc_test SOURCES tests/adc_test.cpp LINK whirl_stm32_b)
whirl_test(stm32_small_blocks_test SOURCES tests/small_blocks_test.cpp LINK whirl_stm32_b)
whirl_test(stm32_rtc_can_test SOURCES tests/rtc_test.cpp tests/bxcan_test.cpp tests/dac_test.cpp LINK whirl_stm32_b)
