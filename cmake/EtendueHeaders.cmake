# Headers of the standard library and of others that most sources include, compiled once for all of src/ and once, with
# GoogleTest, for all of tests/: a fifth to a third of the time of a typical source of src/. None of our own, since a
# change of one would have everything compiled again. Sources include what they use all the same: clang-tidy, which
# gets no compiled headers, says where one does not.
#
# For targets with the options of every other: a compiler takes compiled headers only where they were made with the same.
set(standard_headers
  <algorithm> <array> <bit> <charconv> <chrono> <cmath> <cstddef> <cstdint> <filesystem> <fstream> <functional> <limits>
  <map> <memory> <numbers> <numeric> <optional> <set> <span> <sstream> <stdexcept> <string> <string_view> <system_error>
  <tuple> <utility> <variant> <vector>)

# etendue_make_headers(<target> HEADERS ... LINK target... [OPTIONS option...])
function(etendue_make_headers target)
  cmake_parse_arguments(ARG "" "" "HEADERS;LINK;OPTIONS" ${ARGN})
  file(CONFIGURE OUTPUT "${CMAKE_BINARY_DIR}/${target}.cpp" CONTENT "")
  add_library(${target} OBJECT "${CMAKE_BINARY_DIR}/${target}.cpp")
  target_link_libraries(${target} PRIVATE etendue_options ${ARG_LINK})
  target_compile_options(${target} PRIVATE ${ARG_OPTIONS})
  target_precompile_headers(${target} PRIVATE ${ARG_HEADERS})
endfunction()

set(headers_of_all ${standard_headers} <Imath/ImathMatrix.h> <Imath/ImathVec.h> <fmt/format.h>)
etendue_make_headers(etendue_headers HEADERS ${headers_of_all} LINK PkgConfig::Imath fmt::fmt)
etendue_make_headers(etendue_quick_headers
  HEADERS ${headers_of_all} LINK PkgConfig::Imath fmt::fmt OPTIONS ${ETENDUE_QUICK_OPTIONS})
if(ETENDUE_BUILD_TESTS)
  etendue_make_headers(etendue_test_headers
    HEADERS ${headers_of_all} <gtest/gtest.h> LINK PkgConfig::Imath fmt::fmt GTest::gtest
    OPTIONS ${ETENDUE_QUICK_OPTIONS})
endif()
