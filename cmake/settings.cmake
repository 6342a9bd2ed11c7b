# What every target of this project is compiled with.
if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
  if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release, RelWithDebInfo or MinSizeRel" FORCE)
  endif()
  find_program(ROLLFIX_CCACHE ccache)
  if(ROLLFIX_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    # What one checkout has compiled another finds there: no path of a checkout is in what is compiled.
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=true
      ${ROLLFIX_CCACHE})
    add_compile_options(-fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)
  endif()
endif()

# rollfix_rooms(TARGET [FEW]): in a unity build (see CMakePresets.json) the files of a folder are compiled together, and so are all
# those of folders with no more than FEW: half of what these take to compile are the headers. Not of what has to be fast: the compiler
# inlines less in a larger unit.
set(ROLLFIX_COMPILED_ALONE "" CACHE STRING "Files that even then are compiled by themselves, as a regular expression")
set(ROLLFIX_TOGETHER 0 CACHE STRING "Most files of a folder that are compiled together; 0: all. Fewer take less memory")
if(ROLLFIX_TOGETHER AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(--param=ggc-min-expand=10 --param=ggc-min-heapsize=32768)  # it gathers its garbage sooner
endif()
function(rollfix_rooms target)
  set(few ${ARGN})
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "[.]cpp$")
  if(ROLLFIX_COMPILED_ALONE)
    list(FILTER sources EXCLUDE REGEX "${ROLLFIX_COMPILED_ALONE}")
  endif()
  foreach(source IN LISTS sources)
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(GET folder FILENAME room)
    list(APPEND rooms ${room})
    list(APPEND files_of_${room} ${source})
  endforeach()
  list(REMOVE_DUPLICATES rooms)
  foreach(room IN LISTS rooms)
    list(LENGTH files_of_${room} count)
    set(group ${room})
    if(few AND NOT ROLLFIX_TOGETHER AND count LESS_EQUAL few)
      set(group small)
    endif()
    set(number 0)
    foreach(source IN LISTS files_of_${room})
      if(ROLLFIX_TOGETHER)
        math(EXPR part "${number} / ${ROLLFIX_TOGETHER}")
        set(group ${room}_${part})
      endif()
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
      math(EXPR number "${number} + 1")
    endforeach()
  endforeach()
endfunction()

# rollfix_writes(TARGET): what it does is text and figures, and what optimising adds to that is mostly time to compile: -O3
# takes a third longer than -O1, and under the sanitizers -O1 twice as long as -O0.
function(rollfix_writes target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1> $<$<CONFIG:Debug>:-O0>)
endfunction()

# rollfix_optimised_first(TARGET): of a template that many files of code hold, the linker takes the copy that comes first,
# however it was optimised. So the libraries that compute come before what only writes, and before the tests, which are
# optimised less: under the sanitizers that makes them three to seven times as fast.
include(CheckLinkerFlag)
check_linker_flag(CXX "-Wl,--whole-archive,--no-whole-archive" ROLLFIX_HAS_WHOLE_ARCHIVE)
function(rollfix_optimised_first target)
  get_target_property(type rollfix TYPE)
  if(ROLLFIX_HAS_WHOLE_ARCHIVE AND type STREQUAL STATIC_LIBRARY)
    target_link_options(${target} PRIVATE
      "SHELL:-Wl,--whole-archive $<TARGET_FILE:rollfix> $<TARGET_FILE:rollfix_files> -Wl,--no-whole-archive")
  endif()
endfunction()

# What users run is hardened as distributions do it: an overflow that nobody has found yet ends the program rather than
# doing as the file says. Not the debug builds, whose sanitizers see more. script/lint looks for it in the program.
option(ROLLFIX_HARDENING "Stack protector, checked library calls, no late binding, and CET where it exists" ON)
include(CheckCXXCompilerFlag)
set(rollfix_hardening_compile -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2)
foreach(flag -fstack-protector-strong -fstack-clash-protection -fcf-protection=full)
  string(MAKE_C_IDENTIFIER "ROLLFIX_HAS${flag}" has)
  check_cxx_compiler_flag(${flag} ${has})
  if(${has})
    list(APPEND rollfix_hardening_compile ${flag})
  endif()
endforeach()
check_linker_flag(CXX -Wl,-z,relro,-z,now ROLLFIX_HAS_BIND_NOW)
set(rollfix_hardening_link $<$<BOOL:${ROLLFIX_HAS_BIND_NOW}>:-Wl,-z,relro,-z,now>)

function(rollfix_settings target)
  if(ROLLFIX_HARDENING)
    target_compile_options(${target} PRIVATE "$<$<CONFIG:Release>:${rollfix_hardening_compile}>")
    target_link_options(${target} PRIVATE "$<$<CONFIG:Release>:${rollfix_hardening_link}>")
  endif()
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  # No fused multiply-add behind our back: the same source gives the same bits in every build.
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  # A library's calls of its own functions are those: position independent code may then have them inline as well.
  target_compile_options(${target} PRIVATE -fno-semantic-interposition)
  if(ROLLFIX_WARNINGS)
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
    if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
      # Guesses after inlining, wrong in Boost, Eigen and std::string with -O3; the sanitizers see the real thing.
      target_compile_options(${target} PRIVATE
        -Wno-array-bounds -Wno-maybe-uninitialized -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread)
      if(CMAKE_UNITY_BUILD)  # A source that is included is taken for a header, where types of no name do harm.
        target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
      endif()
    endif()
  endif()
  if(ROLLFIX_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()
