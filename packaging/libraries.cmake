# The shared libraries, their headers, and how CMake and pkg-config find them; relocatable.
include(CMakePackageConfigHelpers)
set(cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/flaneur)
set(pkgconfig_folder ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH UP_TO_PREFIX /prefix/${pkgconfig_folder} /prefix)

# install_library(NAME SUMMARY LICENCE)
function(install_library LIBRARY SUMMARY LICENCE)
  install(TARGETS flaneur_${LIBRARY} EXPORT flaneur
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${LIBRARY} NAMELINK_COMPONENT dev)
  install(FILES ${PROJECT_SOURCE_DIR}/include/flaneur/${LIBRARY}.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/flaneur COMPONENT dev)
  configure_file(flaneur.pc.in flaneur-${LIBRARY}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/flaneur-${LIBRARY}.pc DESTINATION ${pkgconfig_folder} COMPONENT dev)
endfunction()

install_library(footprints "obstacles of a town of triangles, and whether they are fit for a crowd" "GPL-3.0-or-later")
install_library(crowd "people who walk to their goals, and which of them is drawn how" "MIT")
install(FILES ${PROJECT_SOURCE_DIR}/include/flaneur/base.h ${PROJECT_BINARY_DIR}/include/flaneur/version.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/flaneur COMPONENT dev)
install(EXPORT flaneur NAMESPACE flaneur:: FILE flaneurTargets.cmake DESTINATION ${cmake_folder} COMPONENT dev)
write_basic_package_version_file(flaneurConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES flaneurConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/flaneurConfigVersion.cmake DESTINATION ${cmake_folder} COMPONENT dev)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/samples/ DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libflaneur-dev/examples COMPONENT dev)
