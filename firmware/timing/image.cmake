# The timing images: build/firmware/timing_f405.elf and timing_f103.elf, judged by whirl validate --timing.
set(TIMING_SOURCES timing/main.cpp timing/report.cpp timing/code_blocks.cpp timing/exceptions.cpp
    timing/compiled.cpp timing/integer_kernels.cpp timing/memory_kernels.cpp timing/branch_kernels.cpp
    timing/loop_kernels.cpp timing/bus_kernels.cpp timing/float_kernels.cpp)
fw_image(timing_f405 FLASH 208 RAM 4 FOLDER . SOURCES ${TIMING_SOURCES} timing/part_f405.cpp)

add_executable(timing_f103 ${TIMING_SOURCES} timing/part_f103.cpp esc/image/startup.cpp
               hal/fault_handler.cpp)
target_link_libraries(timing_f103 PRIVATE fw_language)
target_compile_options(timing_f103 PRIVATE ${ESC_CPU})
target_link_options(timing_f103 PRIVATE ${ESC_CPU} -nostartfiles --specs=nano.specs -T${ESC_SCRIPT}
  -Wl,--gc-sections -Wl,--fatal-warnings -Wl,-Map=${CMAKE_BINARY_DIR}/timing_f103.map)
set_target_properties(timing_f103 PROPERTIES LINK_DEPENDS ${ESC_SCRIPT}
                      RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
add_custom_command(TARGET timing_f103 POST_BUILD VERBATIM
  COMMAND sh ${PROJECT_SOURCE_DIR}/firmware/gates/check_image.sh $<TARGET_FILE:timing_f103> 96 4)
