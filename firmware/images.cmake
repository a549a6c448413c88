# The ARM images: build/firmware/flight.elf and the test images in build/firmware/images.
find_path(FW_EIGEN Eigen/Core PATHS /usr/include/eigen3 NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH
          REQUIRED)
set(CMAKE_EXECUTABLE_SUFFIX .elf)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -g -DNDEBUG")

add_library(fw_language INTERFACE)
target_compile_features(fw_language INTERFACE cxx_std_20)
target_include_directories(fw_language INTERFACE ${PROJECT_SOURCE_DIR})
target_include_directories(fw_language SYSTEM INTERFACE ${FW_EIGEN})
target_compile_options(fw_language INTERFACE -fno-exceptions -fno-rtti
  -fno-threadsafe-statics -fno-use-cxa-atexit -fno-unwind-tables -fno-asynchronous-unwind-tables
  -fno-math-errno -ffunction-sections -fdata-sections -Wall -Wextra -Wpedantic -Wshadow
  -Wdouble-promotion -Wfloat-conversion -Werror)
target_compile_definitions(fw_language INTERFACE EIGEN_NO_IO EIGEN_NO_MALLOC FW_VERSION="${PROJECT_VERSION}")

# The flight part: STM32F405RG.
set(FW_CPU -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard)
add_library(fw_options INTERFACE)
target_link_libraries(fw_options INTERFACE fw_language)
target_compile_options(fw_options INTERFACE ${FW_CPU})

# fw_image(name SOURCES ... | OBJECTS ... FLASH kib RAM kib): links, prints its size and checks it against the
# budget and the list of symbols that may not be in it. OBJECTS: all of the image, its start too.
function(fw_image name)
  cmake_parse_arguments(ARG "" "FLASH;RAM;FOLDER" "SOURCES;OBJECTS" ${ARGN})
  if(ARG_SOURCES)
    list(APPEND ARG_SOURCES ${PROJECT_SOURCE_DIR}/firmware/hal/startup.cpp
         ${PROJECT_SOURCE_DIR}/firmware/hal/fault_handler.cpp)
  endif()
  add_executable(${name} ${ARG_SOURCES} ${ARG_OBJECTS})
  set_target_properties(${name} PROPERTIES LINKER_LANGUAGE CXX)
  target_link_libraries(${name} PRIVATE fw_options)
  set(script ${PROJECT_SOURCE_DIR}/firmware/hal/stm32f405rg.ld)
  target_link_options(${name} PRIVATE ${FW_CPU} -nostartfiles --specs=nano.specs -T${script}
    -Wl,--gc-sections -Wl,--fatal-warnings -Wl,-Map=${CMAKE_BINARY_DIR}/${name}.map
    -Wl,--compress-debug-sections=zlib)  # each run reads the file whole; gdb unpacks them
  set_target_properties(${name} PROPERTIES LINK_DEPENDS ${script}
                        RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/${ARG_FOLDER})
  set(gate ${PROJECT_SOURCE_DIR}/firmware/gates/check_image.sh)
  add_custom_command(TARGET ${name} POST_BUILD VERBATIM
    COMMAND sh ${gate} $<TARGET_FILE:${name}> ${ARG_FLASH} ${ARG_RAM})
endfunction()

set(FLIGHT_SOURCES images/flight.cpp images/boot_text.cpp images/flight_escs.cpp images/flight_can.cpp images/flight_sticks.cpp images/gps_solution.cpp ${FW_CORE} hal/clock.cpp hal/time_base.cpp hal/spi_master.cpp
    hal/i2c_master.cpp hal/can_link.cpp hal/uart_link.cpp hal/battery_adc.cpp hal/edge_capture.cpp hal/receiver_uart.cpp hal/flash.cpp)
# Of the RAM, 19 KiB are the card's: 16 that bridge its longest pause, and a block each way.
fw_image(flight FLASH 128 RAM 32 FOLDER . SOURCES ${FLIGHT_SOURCES})
# The same for ESCs in mode 5, whose set-points span another range: the files that know the range anew, of all others
# flight's objects, which are compiled without it. They are linked in flight's order.
set(FLIGHT_BY_MODE control/mixer.cpp control/rotor_response.cpp flight/flight.cpp flight/flight_control.cpp
    flight/flight_restart.cpp)
set(flight_shared ${FLIGHT_SOURCES})
list(REMOVE_ITEM flight_shared ${FLIGHT_BY_MODE})
set_source_files_properties(${flight_shared} PROPERTIES COMPILE_DEFINITIONS FW_ANY_ESC_MODE)
add_library(flight_st_mode OBJECT ${FLIGHT_BY_MODE})
target_link_libraries(flight_st_mode PRIVATE fw_options)
target_compile_definitions(flight_st_mode PRIVATE FW_ESC_MODE=thrust_by_power)
set(flight_st_objects "")
foreach(source ${FLIGHT_SOURCES} hal/startup.cpp hal/fault_handler.cpp)
  set(compiled_in flight)
  if(source IN_LIST FLIGHT_BY_MODE)
    set(compiled_in flight_st_mode)
  endif()
  string(REPLACE "." "[.]" object "/${source}.obj$")
  list(APPEND flight_st_objects $<FILTER:$<TARGET_OBJECTS:${compiled_in}>,INCLUDE,${object}>)
endforeach()
fw_image(flight_st FLASH 128 RAM 32 FOLDER . OBJECTS ${flight_st_objects})
# On a bare board with a crystal of 8 MHz; the parts that it plays are the virtual boards'.
include(${PROJECT_SOURCE_DIR}/io_bridges/devices/core/sources.cmake)
list(TRANSFORM WHIRL_CORE_SOURCES PREPEND ${PROJECT_SOURCE_DIR}/io_bridges/devices/core/)
fw_image(pod FLASH 32 RAM 8 FOLDER . SOURCES images/pod.cpp pod/pod_time.cpp pod/spi_slave.cpp pod/imu.cpp pod/host_uart.cpp
         pod/host_link.cpp pod/ram_vectors.cpp pod/i2c_slave.cpp pod/sensors.cpp pod/escs.cpp pod/played_line.cpp pod/battery_out.cpp pod/receiver_out.cpp pod/host_can.cpp hal/clock.cpp hal/can_link.cpp ${WHIRL_CORE_SOURCES})
target_compile_definitions(pod PRIVATE FW_CRYSTAL_MHZ=8)
foreach(image hardfault silent sleeper starved)
  fw_image(${image} FLASH 4 RAM 1 FOLDER images SOURCES images/${image}.cpp)
endforeach()
add_executable(used_sectors images/used_sectors.cpp)
target_link_libraries(used_sectors PRIVATE fw_options)
set(USED_SECTORS_SCRIPT ${CMAKE_CURRENT_SOURCE_DIR}/images/used_sectors.ld)
target_link_options(used_sectors PRIVATE ${FW_CPU} -nostdlib -T${USED_SECTORS_SCRIPT} -Wl,--entry=0)
set_target_properties(used_sectors PROPERTIES LINK_DEPENDS ${USED_SECTORS_SCRIPT}
                      RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/images)
include(esc/image.cmake)
include(timing/image.cmake)
