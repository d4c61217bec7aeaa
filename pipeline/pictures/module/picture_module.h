// What the module of OpenImageIO does, for pictures/picture_files.cpp alone. Results are empty, or why not: a text of
// any number of lines.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/pictures/picture_files.h"

namespace flaneur {

struct PictureModule {
  // accept's error goes into *refused.
  std::string (*read_floats)(const std::string& file, const AcceptPicture& accept, const TakeRows& take,
                             Error* refused);
  std::string (*read_bytes)(const std::string& file, const AcceptPicture& accept, std::vector<uint8_t>* values,
                            Error* refused);
  std::string (*encode_png)(const Pixels& pixels, bool srgb, std::vector<uint8_t>* bytes);
  std::string (*scaled)(const std::string& file, int most_px, std::vector<uint8_t>* bytes);
};

inline constexpr const char* kPictureModuleFunction = "FlaneurPictureModule";

}  // namespace flaneur

extern "C" __attribute__((visibility("default"))) const flaneur::PictureModule* FlaneurPictureModule();
