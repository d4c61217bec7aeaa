# find_package(flaneur 0.2): targets flaneur::crowd and flaneur::footprints, shared libraries with C headers.
include(${CMAKE_CURRENT_LIST_DIR}/flaneurTargets.cmake)
