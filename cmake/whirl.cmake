# How targets are declared in this house.
#   whirl_library(name SOURCES ... LINK ... [HEAVY] [APART ...])   static, position independent (the board is a
#                                               plug-in); HEAVY: optimized even where only the tests count;
#                                               APART: the files that are compiled on their own, for they and
#                                               another one call different things by one name; no file: all
#   whirl_test(name SOURCES ... LINK ... LABELS ... [HEAVY] [APART ...] [COST s])   a GoogleTest executable; label
#                                               host: needs the images, QEMU or a fast build, so no sanitizers;
#                                               guest: needs the guest's kernel, fails outside (./whirl test --guest);
#                                               COST: the longest ones start first
#   whirl_guest_script(name SCRIPT file [USES target ...] [ARGUMENTS ...] [TIMEOUT s] [OWN_CLOCK])   a script of label
#                                               guest; it is given the paths of the programs that it uses, then the
#                                               arguments. OWN_CLOCK: of label guest_night, in a guest whose time is
#                                               its instructions (cmake/guest/run.sh), and TIMEOUT is of that time
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
                         -fno-omit-frame-pointer)
  # LLD: a program of this build has some 180 MB, and GNU's linker takes five times as long over it.
  target_link_options(whirl_options INTERFACE -fsanitize=address,undefined -fuse-ld=lld-14)
endif()

if(WHIRL_FUZZ)
  target_compile_options(whirl_options INTERFACE -fsanitize=fuzzer-no-link)
elseif(WHIRL_SANITIZE)
  # Counters of edges, the cheapest that libFuzzer is steered by: its smoke needs no build of its own.
  target_compile_options(whirl_options INTERFACE -fsanitize-coverage=inline-8bit-counters,pc-table)
endif()
# Where only the tests count, what is not marked HEAVY is built without optimization, which halves its build.
set(WHIRL_LIGHT "")
if(WHIRL_SANITIZE AND NOT WHIRL_FUZZ)
  set(WHIRL_LIGHT -O0)
endif()
# More than half of the time of such a build goes into reading the same headers again. A precompiled header
# serves targets of the same options only.
function(whirl_precompile name)
  add_library(${name} OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
  target_link_libraries(${name} PRIVATE whirl_options ${ARGN})
  target_precompile_headers(${name} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/precompiled.hpp)
endfunction()
if(WHIRL_PRECOMPILE)
  file(WRITE ${CMAKE_BINARY_DIR}/precompiled.cpp "")
  whirl_precompile(whirl_precompiled)
  target_compile_options(whirl_precompiled PRIVATE ${WHIRL_LIGHT})
  whirl_precompile(whirl_precompiled_heavy)
  set_target_properties(whirl_precompiled whirl_precompiled_heavy PROPERTIES POSITION_INDEPENDENT_CODE ON)
  whirl_precompile(whirl_precompiled_tests GTest::gtest)
  target_compile_options(whirl_precompiled_tests PRIVATE ${WHIRL_LIGHT})
  target_precompile_headers(whirl_precompiled_tests PRIVATE <gtest/gtest.h>)
endif()

# Whether APART was given without files.
function(whirl_all_apart result without_files)
  set(${result} OFF PARENT_SCOPE)
  if("APART" IN_LIST without_files)
    set(${result} ON PARENT_SCOPE)
  endif()
endfunction()

# Where it is the whole build that counts, four files of a target are compiled as one: most of a file's time goes
# into the headers that all of them include. What each includes for itself, ./whirl lint sees, file by file.
# whirl_together(TARGET ALL_APART FILE...)
function(whirl_together name all_apart)
  if(WHIRL_TOGETHER AND NOT all_apart)
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 4)
    set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
endfunction()

function(whirl_library name)
  cmake_parse_arguments(ARG "HEAVY" "" "SOURCES;LINK;APART" ${ARGN})
  whirl_all_apart(all_apart "${ARG_KEYWORDS_MISSING_VALUES}")
  if(ARG_SOURCES)
    whirl_mutated_sources(${name} sources ${ARG_SOURCES})
    add_library(${name} STATIC ${sources})
    target_link_libraries(${name} PUBLIC whirl_options ${ARG_LINK})
    set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    whirl_together(${name} "${all_apart}" ${ARG_APART})
    set(suffix _heavy)
    if(NOT ARG_HEAVY)
      set(suffix "")
      target_compile_options(${name} PRIVATE ${WHIRL_LIGHT})
    endif()
    if(WHIRL_PRECOMPILE)
      target_precompile_headers(${name} REUSE_FROM whirl_precompiled${suffix})
    endif()
  else()
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE whirl_options ${ARG_LINK})
  endif()
endfunction()

# What ./whirl run needs, and the tests that need real images, gates or a fast build (label host or
# gate). All other tests are built and run under the sanitizers only.
add_custom_target(whirl_program)
add_custom_target(whirl_host_tests)
add_custom_target(whirl_unit_tests)
add_custom_target(whirl_guest_tests)  # built by the host preset, run by ./whirl test --guest only

function(whirl_test name)
  cmake_parse_arguments(ARG "HEAVY" "TIMEOUT;COST" "SOURCES;LINK;LABELS;APART" ${ARGN})
  whirl_all_apart(all_apart "${ARG_KEYWORDS_MISSING_VALUES}")
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE whirl_options ${ARG_LINK} GTest::gtest)
  if("guest" IN_LIST ARG_LABELS)
    target_link_libraries(${name} PRIVATE whirl_guest_main)
  else()
    target_link_libraries(${name} PRIVATE GTest::gtest_main)
  endif()
  whirl_together(${name} "${all_apart}" ${ARG_APART})
  if(NOT ARG_HEAVY)
    target_compile_options(${name} PRIVATE ${WHIRL_LIGHT})
    if(WHIRL_PRECOMPILE)
      target_precompile_headers(${name} REUSE_FROM whirl_precompiled_tests)
    endif()
  endif()
  # One ctest per executable: a process start per case costs more than the cases do.
  add_test(NAME ${name} COMMAND ${name} --gtest_brief=1)
  set_tests_properties(${name} PROPERTIES TIMEOUT ${ARG_TIMEOUT} LABELS "${ARG_LABELS}")
  if(ARG_COST)
    set_tests_properties(${name} PROPERTIES COST ${ARG_COST})
  endif()
  if("host" IN_LIST ARG_LABELS)
    add_dependencies(whirl_host_tests ${name})
    target_compile_options(${name} PRIVATE -O0)  # they wait for what they start
  elseif("guest" IN_LIST ARG_LABELS)
    add_dependencies(whirl_guest_tests ${name})
  else()
    add_dependencies(whirl_unit_tests ${name})
  endif()
endfunction()

function(whirl_guest_script name)
  cmake_parse_arguments(ARG "OWN_CLOCK" "TIMEOUT;SCRIPT" "USES;ARGUMENTS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  set(programs "")
  foreach(target ${ARG_USES})
    list(APPEND programs $<TARGET_FILE:${target}>)
    add_dependencies(whirl_guest_tests ${target})
  endforeach()
  add_test(NAME ${name} COMMAND ${PROJECT_SOURCE_DIR}/cmake/guest/inside.sh
                                ${CMAKE_CURRENT_SOURCE_DIR}/${ARG_SCRIPT} ${programs} ${ARG_ARGUMENTS})
  set(label guest)
  if(ARG_OWN_CLOCK)
    set(label guest_night)
  endif()
  set_tests_properties(${name} PROPERTIES TIMEOUT ${ARG_TIMEOUT} LABELS ${label})
endfunction()
