# Every third-party package, found once. A missing one stops the configuration with the Debian package that brings it;
# third_party_config/apt-packages.txt says what each is for.

# etendue_find(<package> <debian-package> [find_package arguments...])
macro(etendue_find package debian_package)
  find_package(${package} ${ARGN} QUIET)
  if(NOT ${package}_FOUND)
    message(FATAL_ERROR
      "${package} was not found. Install the Debian package '${debian_package}':\n"
      "    apt-get install ${debian_package}\n"
      "or let tools/quickstart install everything in third_party_config/apt-packages.txt.")
  endif()
endmacro()

# Embree 4 (Debian 13) where it is there, else Embree 3 (Debian 12); src/world/embree.h hides the difference.
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  etendue_find(embree libembree-dev 3.13)
endif()
etendue_find(TBB libtbb-dev)
etendue_find(OpenImageIO libopenimageio-dev 2.4)
etendue_find(OpenColorIO libopencolorio-dev 2.1)
etendue_find(Imath libimath-dev 3.1)
etendue_find(TinyGLTF libtinygltf-dev)
etendue_find(nlohmann_json nlohmann-json3-dev)
etendue_find(fmt libfmt-dev)
etendue_find(spdlog libspdlog-dev)
etendue_find(CLI11 libcli11-dev)
etendue_find(Python3 python3 COMPONENTS Interpreter)
if(ETENDUE_BUILD_TESTS)
  etendue_find(GTest libgtest-dev)
  find_path(ETENDUE_BOOST_MATH boost/math/distributions/chi_squared.hpp)
  if(NOT ETENDUE_BOOST_MATH)
    message(FATAL_ERROR "Boost.Math was not found. Install the Debian package 'libboost-math-dev'.")
  endif()
endif()
if(ETENDUE_BUILD_BENCHMARKS)
  etendue_find(benchmark libbenchmark-dev)
endif()
