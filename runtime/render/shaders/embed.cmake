# cmake -DFOLDER=... -DLIST=programs.h -DOUTPUT=texts.cpp -DVARIANTS=folder -DGLSLANG=glslangValidator -P embed.cmake
# Writes the programs' shaders as C++ strings, each with what it includes in place, once glslang has passed all
# variants.
cmake_minimum_required(VERSION 3.25)

function(expand name depth out)
  if(depth GREATER 8)
    message(FATAL_ERROR "${name} includes itself")
  endif()
  file(READ ${FOLDER}/${name} text)
  while(text MATCHES "(^|\n)(#include \"([^\"\n]+)\")")
    set(line "${CMAKE_MATCH_2}")
    math(EXPR deeper "${depth} + 1")
    expand("${CMAKE_MATCH_3}" ${deeper} included)
    string(REPLACE "${line}\n" "${included}" text "${text}")
  endwhile()
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

# One of a file's variants, for glslang. Those that differ in nothing that the file knows are one.
function(write_variant file)
  set(defines "")
  set(name "")
  foreach(define ${ARGN})
    if(text_${file} MATCHES "[^A-Z_]${define}[^A-Z_]")
      string(APPEND defines "#define ${define}\n")
      string(APPEND name ".${define}")
    endif()
  endforeach()
  get_filename_component(stem ${file} NAME_WLE)
  get_filename_component(stage ${file} LAST_EXT)
  file(WRITE ${VARIANTS}/${stem}${name}${stage} "${header}${defines}${text_${file}}")
endfunction()

file(REMOVE_RECURSE ${VARIANTS})
file(READ ${FOLDER}/header.glsl header)
file(READ ${LIST} list)
string(REGEX MATCHALL "\n +MODE\\([^\n)]*\\)" modes "${list}")
string(REGEX MATCHALL "\n +PROGRAM\\([^\n)]*\\)" programs "${list}")
set(embedded "")
foreach(program IN LISTS programs)
  string(REGEX MATCHALL "\"[^\"]*\"" strings "${program}")
  string(REPLACE "\"" "" strings "${strings}")
  list(GET strings 2 own)
  list(SUBLIST strings 0 2 files)
  foreach(file IN LISTS files)
    if(NOT DEFINED text_${file})
      expand(${file} 0 text_${file})
      string(APPEND embedded "    {\"${file}\", R\"glsl(${text_${file}})glsl\"},\n")
    endif()
    foreach(mode IN LISTS modes)
      string(REGEX MATCH "\"[^\"]*\"" defines "${mode}")
      string(REGEX MATCHALL "[A-Z_]+" defines "${own} ${defines}")
      write_variant(${file} ${defines})
    endforeach()
  endforeach()
endforeach()

file(GLOB variants ${VARIANTS}/*)
if(NOT variants)
  message(FATAL_ERROR "${LIST} names no programs or no modes")
endif()
execute_process(COMMAND ${GLSLANG} ${variants} OUTPUT_VARIABLE said ERROR_VARIABLE said RESULT_VARIABLE failed)
if(failed)
  string(REGEX MATCHALL "[^\n]+\nERROR:[^\n]*" said "${said}")
  list(JOIN said "\n" said)
  message(FATAL_ERROR "glslang refuses\n${said}")
endif()

file(WRITE ${OUTPUT} "// Written at build by runtime/render/shaders/embed.cmake.
#include \"runtime/render/shader_source.h\"

namespace flaneur {

const char* const kShaderHeader = R\"glsl(${header})glsl\";

const std::vector<ShaderText>& ShaderTexts() {
  static const std::vector<ShaderText> texts{
${embedded}  };
  return texts;
}

}  // namespace flaneur
")
