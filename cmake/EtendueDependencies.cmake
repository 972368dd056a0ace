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

# etendue_find_pkgconfig(<name> <module> <debian-package>): imported target PkgConfig::<name>. For the packages whose CMake
# files on Debian 12 ask for others that are not needed (Imath's and OpenImageIO's want the Python bindings).
etendue_find(PkgConfig pkgconf)
macro(etendue_find_pkgconfig name module debian_package)
  pkg_check_modules(${name} QUIET IMPORTED_TARGET ${module})
  if(NOT ${name}_FOUND)
    message(FATAL_ERROR "${module} was not found. Install the Debian package '${debian_package}':\n"
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
etendue_find_pkgconfig(OpenImageIO OpenImageIO>=2.4 libopenimageio-dev)
etendue_find_pkgconfig(OpenColorIO OpenColorIO>=2.1 libopencolorio-dev)
etendue_find_pkgconfig(xxHash libxxhash libxxhash-dev)
etendue_find_pkgconfig(Imath Imath>=3.1 libimath-dev)
etendue_find_pkgconfig(Highway libhwy>=1.0.3 libhwy-dev)
etendue_find(TinyGLTF libtinygltf-dev)
# Debian's Draco carries a tinygltf of its own, of another version, whose functions would take the place of the real one's.
# So what is linked is a copy of the archive without its glTF reader.
find_library(ETENDUE_DRACO libdraco.a)
find_path(ETENDUE_DRACO_INCLUDE draco/compression/decode.h)
if(NOT ETENDUE_DRACO OR NOT ETENDUE_DRACO_INCLUDE)
  message(FATAL_ERROR "Draco was not found. Install the Debian package 'libdraco-dev'.")
endif()
set(etendue_draco_codec "${CMAKE_BINARY_DIR}/libdraco_codec.a")
if("${ETENDUE_DRACO}" IS_NEWER_THAN "${etendue_draco_codec}")
  file(COPY_FILE "${ETENDUE_DRACO}" "${etendue_draco_codec}")
  execute_process(
    COMMAND "${CMAKE_AR}" d "${etendue_draco_codec}" gltf_decoder.cc.o gltf_encoder.cc.o gltf_utils.cc.o
            tiny_gltf_utils.cc.o
    COMMAND_ERROR_IS_FATAL ANY)
endif()
add_library(etendue_draco STATIC IMPORTED GLOBAL)
set_target_properties(etendue_draco PROPERTIES IMPORTED_LOCATION "${etendue_draco_codec}")
# Intel Open Image Denoise, for 'etendue denoise --method oidn', where it is there.
find_package(OpenImageDenoise QUIET)
etendue_find(meshoptimizer libmeshoptimizer-dev)
etendue_find(nlohmann_json nlohmann-json3-dev)
etendue_find(fmt libfmt-dev)
etendue_find(spdlog libspdlog-dev)
etendue_find(CLI11 libcli11-dev)
etendue_find_pkgconfig(httplib cpp-httplib>=0.11 libcpp-httplib-dev)
# Functions in the header of newer httplib call it.
etendue_find_pkgconfig(libcrypto libcrypto libssl-dev)
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
