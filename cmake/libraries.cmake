# rollfix::rollfix, the core, rollfix::march, the published algorithms, rollfix::files, what users come with,
# rollfix::catalog, many parts, rollfix::draw, the figures, and rollfix::c, for other languages. A new file in src/ needs no edit here.
find_package(Eigen3 3.4 CONFIG REQUIRED)
find_package(Boost 1.74 CONFIG REQUIRED)
find_package(fmt 9 CONFIG REQUIRED)
find_package(FastFloat CONFIG REQUIRED)
find_package(Threads REQUIRED)
set(ROLLFIX_C_ABI 1)  # ROLLFIX_ABI of rollfix.h
set(ROLLFIX_FMT fmt::fmt)
if(ROLLFIX_FMT_HEADER_ONLY)
  set(ROLLFIX_FMT fmt::fmt-header-only)
endif()

configure_file(${CMAKE_CURRENT_LIST_DIR}/version.hpp.in ${PROJECT_BINARY_DIR}/include/rollfix/version.hpp @ONLY)

# rollfix_library(TARGET EXPORTED_NAME SOURCES ... HEADERS ... HEADER_DIRS ...): the headers are the public ones.
function(rollfix_library target exported_name)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "SOURCES;HEADERS;HEADER_DIRS")
  add_library(${target} STATIC ${arg_SOURCES})
  add_library(rollfix::${exported_name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${exported_name})
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${arg_HEADER_DIRS} FILES ${arg_HEADERS})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/src)
  rollfix_settings(${target})
  rollfix_rooms(${target})
endfunction()

file(GLOB_RECURSE core_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/*.cpp)
file(GLOB_RECURSE core_headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/*.hpp)
# rollfix_rooms_of(LIBRARY ROOMS HEADERS): which of these are its own and not the core's.
macro(rollfix_rooms_of library rooms headers)
  set(${library}_sources ${core_sources})
  set(${library}_headers ${core_headers})
  list(FILTER ${library}_sources INCLUDE REGEX "/src/(${rooms})/")
  list(FILTER ${library}_headers INCLUDE REGEX "/rollfix/(${headers})[.]hpp")
  list(FILTER core_sources EXCLUDE REGEX "/src/(${rooms})/")
  list(FILTER core_headers EXCLUDE REGEX "/rollfix/(${headers})[.]hpp")
endmacro()
rollfix_rooms_of(march "march" "march")
rollfix_rooms_of(files "files|documents" "files|documents")
rollfix_rooms_of(catalog "catalog" "identify")
rollfix_rooms_of(draw "draw" "draw")
rollfix_rooms_of(capi "capi" "none")

rollfix_library(rollfix rollfix
  SOURCES ${core_sources}
  HEADERS ${core_headers} ${PROJECT_BINARY_DIR}/include/rollfix/version.hpp
  HEADER_DIRS ${PROJECT_SOURCE_DIR}/include ${PROJECT_BINARY_DIR}/include)
# With noise most of the time goes there: by itself more of it is inlined, whatever else its folder holds.
set_source_files_properties(${PROJECT_SOURCE_DIR}/src/belief/one/side_by_side.cpp
  PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
# Eigen is part of the interface, fmt is linked; Boost and fast_float are headers that only our sources see.
target_link_libraries(rollfix
  PUBLIC Eigen3::Eigen
  PRIVATE ${ROLLFIX_FMT} Threads::Threads $<BUILD_INTERFACE:Boost::headers> $<BUILD_INTERFACE:FastFloat::fast_float>)

rollfix_library(rollfix_march march
  SOURCES ${march_sources}
  HEADERS ${march_headers}
  HEADER_DIRS ${PROJECT_SOURCE_DIR}/include)
target_link_libraries(rollfix_march PUBLIC rollfix PRIVATE ${ROLLFIX_FMT} $<BUILD_INTERFACE:Boost::headers>)

if(ROLLFIX_BUILD_FILES)
  find_package(pugixml 1.13 CONFIG REQUIRED)
  find_package(nlohmann_json 3.11 CONFIG REQUIRED)
  rollfix_library(rollfix_files files
    SOURCES ${files_sources}
    HEADERS ${files_headers}
    HEADER_DIRS ${PROJECT_SOURCE_DIR}/include)
  target_link_libraries(rollfix_files
    PUBLIC rollfix
    PRIVATE ${ROLLFIX_FMT} pugixml::pugixml $<BUILD_INTERFACE:nlohmann_json::nlohmann_json>
      $<BUILD_INTERFACE:FastFloat::fast_float>)
endif()

if(ROLLFIX_BUILD_C)
  # Shared, with the functions of rollfix.h and nothing else to be seen: what other languages load.
  add_library(rollfix_c SHARED ${capi_sources})
  add_library(rollfix::c ALIAS rollfix_c)
  set_target_properties(rollfix_c PROPERTIES
    EXPORT_NAME c SOVERSION ${ROLLFIX_C_ABI} VERSION ${ROLLFIX_C_ABI}.${PROJECT_VERSION}
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_sources(rollfix_c PUBLIC FILE_SET HEADERS
    BASE_DIRS ${PROJECT_SOURCE_DIR}/include FILES ${PROJECT_SOURCE_DIR}/include/rollfix/rollfix.h)
  target_include_directories(rollfix_c PRIVATE ${PROJECT_SOURCE_DIR}/src)
  rollfix_settings(rollfix_c)
  rollfix_rooms(rollfix_c)
  check_linker_flag(CXX -Wl,--exclude-libs,ALL ROLLFIX_HAS_EXCLUDE_LIBS)
  target_link_options(rollfix_c PRIVATE $<$<BOOL:${ROLLFIX_HAS_EXCLUDE_LIBS}>:-Wl,--exclude-libs,ALL>)
  target_link_libraries(rollfix_c PRIVATE rollfix rollfix_files ${ROLLFIX_FMT})
endif()

if(ROLLFIX_BUILD_CATALOG)
  find_package(SQLite3 3.35 REQUIRED)
  rollfix_library(rollfix_catalog catalog
    SOURCES ${catalog_sources}
    HEADERS ${catalog_headers}
    HEADER_DIRS ${PROJECT_SOURCE_DIR}/include)
  target_link_libraries(rollfix_catalog
    PUBLIC rollfix_files
    PRIVATE ${ROLLFIX_FMT} Threads::Threads SQLite::SQLite3 $<BUILD_INTERFACE:nlohmann_json::nlohmann_json>
      $<BUILD_INTERFACE:FastFloat::fast_float>)
endif()

if(ROLLFIX_BUILD_DRAW)
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(ROLLFIX_RSVG REQUIRED librsvg-2.0)
  pkg_check_modules(ROLLFIX_CAIRO REQUIRED cairo)
  rollfix_library(rollfix_draw draw
    SOURCES ${draw_sources}
    HEADERS ${draw_headers}
    HEADER_DIRS ${PROJECT_SOURCE_DIR}/include)
  rollfix_writes(rollfix_draw)
  # Their headers alone: the libraries are loaded with the first PNG or PDF (see src/draw/save.cpp).
  target_include_directories(rollfix_draw SYSTEM PRIVATE ${ROLLFIX_RSVG_INCLUDE_DIRS} ${ROLLFIX_CAIRO_INCLUDE_DIRS})
  target_link_libraries(rollfix_draw
    PUBLIC rollfix
    PRIVATE ${ROLLFIX_FMT} ${CMAKE_DL_LIBS})
endif()
