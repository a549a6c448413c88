# Mutants of the judging code (preset mutate): its sources are replaced by mutated copies in which every
# mutant is compiled in; WHIRL_MUTANT=n chooses one when a test runs (cmake/mutate/run.py).
include_guard()
option(WHIRL_MUTATE "Compile mutants of the judging code in" OFF)
set(WHIRL_MUTATED "^(harness/(metrics|board|lockstep|world|plan|executive)/[^/]*|harness/catalogue/(board_file|device_entry)|results/(report|verdict)[^/]*|io_bridges/(board_description/[^/]*|qemu/board/watch[^/]*))[.]cpp$")

# Gives in `result` the sources of a library, those of the judging code by their mutated copies.
function(whirl_mutated_sources library result)
  set(sources)
  foreach(source IN LISTS ARGN)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE path)
    cmake_path(RELATIVE_PATH path BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE relative)
    if(WHIRL_MUTATE AND relative MATCHES "${WHIRL_MUTATED}")
      get_property(first GLOBAL PROPERTY whirl_next_mutant)
      if(NOT first)
        set(first 10000)
      endif()
      math(EXPR next "${first} + 10000")
      set_property(GLOBAL PROPERTY whirl_next_mutant ${next})
      set(copy ${PROJECT_BINARY_DIR}/mutated/${relative})
      cmake_path(GET copy PARENT_PATH folder)
      file(MAKE_DIRECTORY ${folder})
      add_custom_command(OUTPUT ${copy} ${copy}.mutants
        COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/cmake/mutate/generate.py --root ${PROJECT_SOURCE_DIR}
                --source ${relative} --out ${copy} --first ${first} --
                "-I$<JOIN:$<TARGET_PROPERTY:${library},INCLUDE_DIRECTORIES>,;-I>"
        DEPENDS ${path} ${PROJECT_SOURCE_DIR}/cmake/mutate/generate.py
        COMMENT "Mutating ${relative}" COMMAND_EXPAND_LISTS VERBATIM)
      set_source_files_properties(${copy} PROPERTIES COMPILE_OPTIONS "-w;-Wno-narrowing")
      list(APPEND sources ${copy})
    else()
      list(APPEND sources ${source})
    endif()
  endforeach()
  set(${result} ${sources} PARENT_SCOPE)
endfunction()
