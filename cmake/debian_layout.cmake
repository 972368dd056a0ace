# CPack runs this between installing into its own folder and packing it: what Debian has in other places or forms.
foreach(component runtime development)
  set(usr "${CPACK_TEMPORARY_DIRECTORY}/${component}/usr")
  if(NOT IS_DIRECTORY "${usr}")
    message(FATAL_ERROR "CPack has installed nothing in ${usr}.")
  endif()
  string(TOUPPER "${component}" upper)
  set(doc "${usr}/share/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME}")
  file(MAKE_DIRECTORY "${doc}")
  file(COPY_FILE "${CPACK_ETENDUE_COPYRIGHT}" "${doc}/copyright")
endforeach()

set(usr "${CPACK_TEMPORARY_DIRECTORY}/runtime/usr")
file(RENAME "${usr}/share/zsh/site-functions" "${usr}/share/zsh/vendor-completions")
file(GLOB pages "${usr}/share/man/man1/*.1")
execute_process(COMMAND gzip --best --no-name ${pages} COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE "${usr}/share/doc/etendue/LICENSE")  # which is what copyright refers to
