# Headers that many sources parse and that cost most of their compile time, compiled once. A source still
# includes what it uses: tools/check_headers and tools/check_tidy look at it without them.
find_package(GTest REQUIRED)
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/precompiled/main.cpp CONTENT "int main() { return 0; }\n")

# limbcast_precompiled(name KIND EXECUTABLE|LIBRARY DEPS targets HEADERS <a> <b>): a target whose headers others of its
# kind reuse (position-independent code of a library and of an executable differ; the level of optimisation may).
function(limbcast_precompiled name)
  cmake_parse_arguments(ARG "" "KIND" "DEPS;HEADERS" ${ARGN})
  if(ARG_KIND STREQUAL "LIBRARY")
    add_library(${name} STATIC ${CMAKE_BINARY_DIR}/precompiled/main.cpp)
  else()
    add_executable(${name} ${CMAKE_BINARY_DIR}/precompiled/main.cpp)
  endif()
  target_link_libraries(${name} PRIVATE limbcast_options ${ARG_DEPS})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${name} PRIVATE -fpch-preprocess ${limbcast_light_optimization})
    target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
  endif()
endfunction()

# limbcast_reuse_precompiled(target from): `target` compiles with the headers of `from`.
function(limbcast_reuse_precompiled target from)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -fpch-preprocess)
    target_precompile_headers(${target} REUSE_FROM ${from})
  endif()
endfunction()

limbcast_precompiled(limbcast_precompiled_test KIND EXECUTABLE
  DEPS GTest::gmock GTest::gtest Eigen3::Eigen
  HEADERS <gtest/gtest.h> <gmock/gmock.h> <Eigen/Geometry> <Eigen/Dense> <chrono> <functional> <random>
    <thread> <filesystem> <fstream>)
limbcast_precompiled(limbcast_precompiled_room KIND LIBRARY
  DEPS Eigen3::Eigen
  HEADERS <Eigen/Geometry> <Eigen/Dense> <algorithm> <array> <atomic> <chrono> <cmath> <cstdint> <filesystem> <functional>
    <map> <memory> <mutex> <optional> <random> <set> <span> <sstream> <string> <string_view> <thread> <unordered_map> <utility>
    <variant> <vector>)
