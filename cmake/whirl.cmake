# How targets are declared in this house.
#   whirl_library(name SOURCES ... LINK ...)    static, position independent (the board is a plug-in)
#   whirl_test(name SOURCES ... LINK ... LABELS ...)   a GoogleTest executable; label host: needs the
#                                               images, QEMU or a fast build, so no sanitizers
include_guard()
include(cmake/mutate.cmake)

add_library(whirl_options INTERFACE)
target_compile_features(whirl_options INTERFACE cxx_std_20)
target_include_directories(whirl_options INTERFACE ${PROJECT_SOURCE_DIR})
# Contraction off: the same source gives the same bits whatever the compiler's mood (see design: digests).
target_compile_options(whirl_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                       -Woverloaded-virtual -Werror -ffp-contract=off
                       # Nothing of the checkout's path is compiled in: a copy must use its own files.
                       -ffile-prefix-map=${PROJECT_SOURCE_DIR}/=)
if(WHIRL_SANITIZE)
  target_compile_options(whirl_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all
                         -fno-omit-frame-pointer -O1)
  target_link_options(whirl_options INTERFACE -fsanitize=address,undefined)
endif()

if(WHIRL_FUZZ)
  target_compile_options(whirl_options INTERFACE -fsanitize=fuzzer-no-link)
endif()

function(whirl_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  if(ARG_SOURCES)
    whirl_mutated_sources(${name} sources ${ARG_SOURCES})
    add_library(${name} STATIC ${sources})
    target_link_libraries(${name} PUBLIC whirl_options ${ARG_LINK})
    set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  else()
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE whirl_options ${ARG_LINK})
  endif()
endfunction()

# What ./whirl run needs, and the tests that need real images, gates or a fast build (label host or
# gate). All other tests are built and run under the sanitizers only.
add_custom_target(whirl_program)
add_custom_target(whirl_host_tests)

function(whirl_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LINK;LABELS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE whirl_options ${ARG_LINK} GTest::gtest GTest::gtest_main)
  # One ctest per executable: a process start per case costs more than the cases do.
  add_test(NAME ${name} COMMAND ${name} --gtest_brief=1)
  set_tests_properties(${name} PROPERTIES TIMEOUT ${ARG_TIMEOUT} LABELS "${ARG_LABELS}")
  if("host" IN_LIST ARG_LABELS)
    add_dependencies(whirl_host_tests ${name})
  endif()
endfunction()
