# Functions that every room's CMakeLists.txt uses, so that warnings, sanitizers and labels are decided once.

add_library(limbcast_options INTERFACE)
target_include_directories(limbcast_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(limbcast_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Wcast-qual -Wconversion
  -Wsign-conversion -Woverloaded-virtual -Wnull-dereference -Werror)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 reports false null dereferences and array bounds inside Eigen and libstdc++ when it inlines.
  target_compile_options(limbcast_options INTERFACE -Wno-null-dereference -Wno-array-bounds
    -Wno-stringop-overflow -Wno-stringop-overread -Wno-restrict -Wno-maybe-uninitialized)
endif()
if(LIMBCAST_FUZZ)
  # Another compiler, with warnings of its own: they are the release build's affair.
  # Assertions off, as shipped: toml++ 3.3 asserts that a key begins like one where a file may have anything, and tells
  # clang to assume it, which GCC is not told.
  target_compile_options(limbcast_options INTERFACE -w -fsanitize=fuzzer-no-link -DNDEBUG
    "-D__builtin_assume(...)=static_assert(true)")
endif()
if(LIMBCAST_SANITIZE)
  target_compile_options(limbcast_options INTERFACE -fsanitize=${LIMBCAST_SANITIZE} -fno-omit-frame-pointer
    -fno-sanitize-recover=all)
  target_link_options(limbcast_options INTERFACE -fsanitize=${LIMBCAST_SANITIZE})
endif()

# What tests and command lines do themselves is not what takes their time, and -O3 takes twice the time to compile.
set(limbcast_light_optimization $<$<CONFIG:Release>:-O1>)

# limbcast_room(common/base SOURCES a.cpp DEPS limbcast::math Eigen3::Eigen PRIVATE_DEPS x)
# makes the static library limbcast_<last part> with the alias limbcast::<last part>.
function(limbcast_room path)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS;PRIVATE_DEPS" ${ARGN})
  get_filename_component(name ${path} NAME)
  set(target limbcast_${name})
  if(ARG_SOURCES)
    add_library(${target} STATIC ${ARG_SOURCES})
    target_link_libraries(${target} PUBLIC limbcast_options ${ARG_DEPS} PRIVATE ${ARG_PRIVATE_DEPS})
    if(NOT name STREQUAL "base")  # whose sources take less time than the headers
      limbcast_reuse_precompiled(${target} limbcast_precompiled_room)
    endif()
  else()
    add_library(${target} INTERFACE)
    target_link_libraries(${target} INTERFACE limbcast_options ${ARG_DEPS})
  endif()
  add_library(limbcast::${name} ALIAS ${target})
endfunction()

# limbcast_executable(limbcast-fusion SOURCES main.cpp DEPS limbcast::fusion): lands in <build>/bin. Its sources are a
# command line and little more.
function(limbcast_executable name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE limbcast_options ${ARG_DEPS})
  target_compile_options(${name} PRIVATE ${limbcast_light_optimization})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
endfunction()

# limbcast_test(so3_test LABEL unit SOURCES so3_test.cpp DEPS limbcast::math [TIMEOUT 120]): one GoogleTest
# executable, one CTest entry for each of its test cases.
function(limbcast_test name)
  cmake_parse_arguments(ARG "SERIAL" "LABEL;TIMEOUT" "SOURCES;DEPS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  if(LIMBCAST_SANITIZE)
    math(EXPR ARG_TIMEOUT "5 * ${ARG_TIMEOUT}")  # filters of 40 states take a minute and more there
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE limbcast_options ${ARG_DEPS} limbcast_test_support
    GTest::gmock GTest::gtest GTest::gtest_main)
  target_compile_options(${name} PRIVATE ${limbcast_light_optimization})
  limbcast_reuse_precompiled(${name} limbcast_precompiled_test)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  set(properties LABELS ${ARG_LABEL} TIMEOUT ${ARG_TIMEOUT})
  if(ARG_SERIAL)
    list(APPEND properties RUN_SERIAL TRUE)
  endif()
  # One variable only: a list of them comes apart on its way to the test.
  if(LIMBCAST_SANITIZE MATCHES "thread")
    # Races inside the DDS libraries, which are not instrumented, cannot be told from ours seen through them, and some
    # of their locks (pthread_mutex_clocklock) are not seen at all.
    list(APPEND properties ENVIRONMENT
      "TSAN_OPTIONS=ignore_noninstrumented_modules=1:suppressions=${PROJECT_SOURCE_DIR}/tests/support/tsan_suppressions.txt")
  elseif(LIMBCAST_SANITIZE)
    # Fast DDS 2.9 deletes a writer's history through a base class without virtual destructor.
    list(APPEND properties ENVIRONMENT "ASAN_OPTIONS=new_delete_type_mismatch=0")
  endif()
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 DISCOVERY_MODE PRE_TEST PROPERTIES ${properties})
endfunction()

# limbcast_benchmark(so3_benchmark SOURCES ... DEPS ...): built with everything, never timed by a test.
function(limbcast_benchmark name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE limbcast_options ${ARG_DEPS} benchmark::benchmark benchmark::benchmark_main)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/benchmark)
endfunction()
