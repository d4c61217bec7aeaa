# find_package(flaneur 0.2): target flaneur::footprints, a shared library with a C header.
include(${CMAKE_CURRENT_LIST_DIR}/flaneurTargets.cmake)
