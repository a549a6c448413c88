# The motor controller's image: build/firmware/esc.elf for the STM32F103CB (Cortex-M3, soft float).
# Budgets are the figures that the thesis gives for its own image.
set(ESC_CPU -mcpu=cortex-m3 -mthumb)
add_executable(esc
  esc/image/main.cpp esc/image/startup.cpp esc/image/clock.cpp esc/image/bridge.cpp
  esc/image/sampling.cpp esc/image/motor_drive.cpp esc/image/i2c_slave.cpp esc/image/can_node.cpp esc/image/pulse_input.cpp esc/image/serial.cpp
  esc/image/commands.cpp esc/image/text_number.cpp esc/image/stream.cpp
  esc/image/stream_frame.cpp esc/image/settings.cpp esc/image/float_arithmetic.cpp hal/fault_handler.cpp
  esc/core/commutation.cpp esc/core/core.cpp esc/core/filters.cpp esc/core/thrust_estimator.cpp
  esc/core/thrust_model.cpp)
target_link_libraries(esc PRIVATE fw_language)
target_compile_options(esc PRIVATE ${ESC_CPU} -O2 -flto)
# Tasks return to their handlers instead of ending the interrupt themselves: their returns can be timed.
set_source_files_properties(esc/image/main.cpp PROPERTIES
                            COMPILE_OPTIONS -fno-optimize-sibling-calls)
# What the compiler itself calls must be there when it has finished.
set_source_files_properties(esc/image/float_arithmetic.cpp PROPERTIES COMPILE_OPTIONS -fno-lto)
set(ESC_SCRIPT ${PROJECT_SOURCE_DIR}/firmware/esc/image/stm32f103cb.ld)
target_link_options(esc PRIVATE ${ESC_CPU} -O2 -flto -nostartfiles --specs=nano.specs -T${ESC_SCRIPT}
  -Wl,--wrap=__aeabi_fdiv,--wrap=__aeabi_fcmplt,--wrap=__aeabi_fcmpgt,--wrap=__aeabi_fcmple,--wrap=__aeabi_fcmpge
  -Wl,--gc-sections -Wl,--fatal-warnings -Wl,-Map=${CMAKE_BINARY_DIR}/esc.map)
set_target_properties(esc PROPERTIES LINK_DEPENDS ${ESC_SCRIPT}
                      RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
add_custom_command(TARGET esc POST_BUILD VERBATIM
  COMMAND sh ${PROJECT_SOURCE_DIR}/firmware/gates/check_image.sh $<TARGET_FILE:esc> 56 10)

# What makes one controller of a vehicle differ from the next: its page of settings, flashed beside the image.
foreach(number RANGE 1 4)
  add_executable(esc_motor_${number} esc/image/motor_number.cpp)
  target_link_libraries(esc_motor_${number} PRIVATE fw_language)
  target_compile_definitions(esc_motor_${number} PRIVATE ESC_MOTOR_NUMBER=${number})
  target_compile_options(esc_motor_${number} PRIVATE ${ESC_CPU})
  target_link_options(esc_motor_${number} PRIVATE ${ESC_CPU} -nostdlib -Wl,--section-start=.settings=0x0801FC00
    -Wl,--nmagic -Wl,--entry=0 -Wl,--build-id=none -Wl,--fatal-warnings)
  set_target_properties(esc_motor_${number} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
endforeach()
