# What `cmake --install` leaves behind: headers, libraries, the program, and what find_package and pkg-config read.
include(CMakePackageConfigHelpers)

set(cmake_destination ${CMAKE_INSTALL_LIBDIR}/cmake/rollfix)
set(pkgconfig_destination ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# rollfix_install_library(TARGET EXPORT_FILE PKG_CONFIG_FILE TEMPLATE)
function(rollfix_install_library target export_file pkg_config_file template)
  install(TARGETS ${target} EXPORT ${export_file} FILE_SET HEADERS)
  install(EXPORT ${export_file} NAMESPACE rollfix:: DESTINATION ${cmake_destination})
  configure_file(cmake/${template} ${PROJECT_BINARY_DIR}/${pkg_config_file} @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${pkg_config_file} DESTINATION ${pkgconfig_destination})
endfunction()

# The prefix as seen from the .pc file, so that an installed tree can be moved.
cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX
  BASE_DIRECTORY ${CMAKE_INSTALL_PREFIX}/${pkgconfig_destination} OUTPUT_VARIABLE prefix_from_pkgconfig)

# Where dlopen is, as pkg-config has it; nowhere of its own on some systems.
list(TRANSFORM CMAKE_DL_LIBS PREPEND -l OUTPUT_VARIABLE dlopen_flags)

# rollfix_install_component(COMPONENT DESCRIPTION REQUIRES LIBS): a library on top of the core, what pkg-config says of it.
# rollfixConfig.cmake finds components by these names.
function(rollfix_install_component component description requires libs)
  if(TARGET rollfix_${component})
    rollfix_install_library(
      rollfix_${component} rollfix_${component}Targets rollfix-${component}.pc rollfix-component.pc.in)
  endif()
endfunction()

rollfix_install_library(rollfix rollfixTargets rollfix.pc rollfix.pc.in)
rollfix_install_component(march "The published marching algorithms, the reference for rollfix"
  "rollfix = ${PROJECT_VERSION}" "-lrollfix_march")
rollfix_install_component(files "Drawings and saved parts for rollfix" "rollfix = ${PROJECT_VERSION} pugixml" "-lrollfix_files")
rollfix_install_component(catalog "Catalogs of parts for rollfix"
  "rollfix-files = ${PROJECT_VERSION} sqlite3" "-lrollfix_catalog")
rollfix_install_component(draw "Figures for rollfix" "rollfix = ${PROJECT_VERSION}" "-lrollfix_draw ${dlopen_flags}")
if(TARGET rollfix_c)
  rollfix_install_library(rollfix_c rollfix_cTargets rollfix-c.pc rollfix-c.pc.in)  # needs none of them: its headers are of C
endif()
if(TARGET rollfix_cli)
  install(TARGETS rollfix_cli RUNTIME)
  if(NOT CMAKE_CROSSCOMPILING)
    set(pages ${PROJECT_BINARY_DIR}/pages)
    install(FILES ${pages}/rollfix.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
    install(FILES ${pages}/rollfix DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
    install(FILES ${pages}/_rollfix DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
  endif()
endif()
if(TARGET rollfix_verify)
  install(TARGETS rollfix_verify RUNTIME)
endif()

configure_package_config_file(cmake/rollfixConfig.cmake.in ${PROJECT_BINARY_DIR}/rollfixConfig.cmake
  INSTALL_DESTINATION ${cmake_destination} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/rollfixConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/rollfixConfig.cmake ${PROJECT_BINARY_DIR}/rollfixConfigVersion.cmake
  DESTINATION ${cmake_destination})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
