# Compile options of our own code, carried by one interface target that every room links.
add_library(etendue_options INTERFACE)
target_compile_options(etendue_options INTERFACE
  -Wall -Wextra -Wshadow -Wconversion
  # errno and trapping are not used; without them sqrt and comparisons inline and vectorise. Results stay IEEE.
  -fno-math-errno -fno-trapping-math
  $<$<BOOL:${ETENDUE_WARNINGS_AS_ERRORS}>:-Werror>
  $<$<BOOL:${ETENDUE_MARCH}>:-march=${ETENDUE_MARCH}>)
if(ETENDUE_SANITIZERS)
  target_compile_options(etendue_options INTERFACE
    -fsanitize=${ETENDUE_SANITIZERS} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(etendue_options INTERFACE -fsanitize=${ETENDUE_SANITIZERS})
endif()
