# A file a language, built into the program: word_files.cpp in the current build folder.
file(GLOB word_files CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/words/*.toml)
set(WORDS "")
foreach(file ${word_files})
  get_filename_component(language ${file} NAME_WE)
  file(READ ${file} text)
  string(APPEND WORDS "          {\"${language}\", R\"words(${text})words\"},\n")
endforeach()
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${word_files})
file(CONFIGURE OUTPUT word_files.cpp @ONLY CONTENT [[
#include "runtime/visit/word_files.h"

std::vector<flaneur::WordFile> flaneur::WordFiles() {
  return {
@WORDS@  };
}
]])
