# What the rooms need beside each other, for a page: header libraries are the installed ones,
# Draco's decoder is compiled from its source. Included before the rooms, which then look for none of it.
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
add_compile_options(-fwasm-exceptions -msimd128 -mnontrapping-fptoint)
add_link_options(-fwasm-exceptions)
# What is called in one place alone stays a function of its own: browsers compile a hot function as a whole, and rooms
# that had become one function of 50 kB took them seconds while a tour begins.
set(web_apart -fno-inline-functions)  # the same, of the functions of a file that is gone through once
add_link_options("-sBINARYEN_EXTRA_PASSES=--one-caller-inline-max-function-size=40")
add_compile_options(-Wno-unknown-warning-option)  # GCC's own

set(web_headers ${CMAKE_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${web_headers})
foreach(library toml++ nlohmann stb)
  if(NOT EXISTS /usr/include/${library})
    message(FATAL_ERROR "/usr/include/${library} is missing: install the packages of packages.txt")
  endif()
  file(CREATE_LINK /usr/include/${library} ${web_headers}/${library} SYMBOLIC)
endforeach()
add_library(web_headers INTERFACE)
target_include_directories(web_headers SYSTEM INTERFACE ${web_headers})
add_library(tomlplusplus::tomlplusplus ALIAS web_headers)
add_library(nlohmann_json::nlohmann_json ALIAS web_headers)
add_library(Threads::Threads INTERFACE IMPORTED GLOBAL)
foreach(library GLES SHAPING)  # OpenGL ES 3 comes with the compiler, letters with the page
  add_library(PkgConfig::${library} INTERFACE IMPORTED GLOBAL)
  target_link_libraries(PkgConfig::${library} INTERFACE web_headers)
endforeach()

set(draco ${CMAKE_BINARY_DIR}/sources)
execute_process(COMMAND ${PROJECT_SOURCE_DIR}/scripts/web_sources.sh ${draco} COMMAND_ERROR_IS_FATAL ANY)
string(APPEND draco /draco/src/draco)
file(WRITE ${web_headers}/draco/draco_features.h.new
     "#define DRACO_MESH_COMPRESSION_SUPPORTED\n#define DRACO_NORMAL_ENCODING_SUPPORTED\n"
     "#define DRACO_STANDARD_EDGEBREAKER_SUPPORTED\n#define DRACO_PREDICTIVE_EDGEBREAKER_SUPPORTED\n"
     "#define DRACO_BACKWARDS_COMPATIBILITY_SUPPORTED\n")
configure_file(${web_headers}/draco/draco_features.h.new ${web_headers}/draco/draco_features.h COPYONLY)
file(GLOB draco_sources ${draco}/attributes/*.cc ${draco}/compression/attributes/*.cc
     ${draco}/compression/attributes/prediction_schemes/*.cc ${draco}/compression/bit_coders/*.cc
     ${draco}/compression/entropy/*.cc ${draco}/compression/mesh/*.cc ${draco}/compression/point_cloud/*.cc
     ${draco}/compression/point_cloud/algorithms/*.cc ${draco}/compression/decode.cc ${draco}/core/*.cc
     ${draco}/mesh/corner_table.cc ${draco}/mesh/mesh.cc ${draco}/mesh/mesh_attribute_corner_table.cc
     ${draco}/metadata/geometry_metadata.cc ${draco}/metadata/metadata.cc ${draco}/metadata/metadata_decoder.cc
     ${draco}/point_cloud/point_cloud.cc)
list(FILTER draco_sources EXCLUDE REGEX "(_test|encoder|encoding|encode|test_base|test_utils)[^/]*\\.cc$|/rans_bit_encoder")
add_library(web_draco STATIC ${draco_sources})
target_include_directories(web_draco SYSTEM PUBLIC ${web_headers} ${draco}/..)
add_library(PkgConfig::DRACO ALIAS web_draco)
