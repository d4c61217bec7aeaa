// Picture files, read and written by OpenImageIO. Loading that takes a third of a second of processor time, with the
// 250 libraries that it needs in turn, and most verbs meet no picture: so it stands in a module of its own
// (pictures/module), which is loaded with the first picture. Any function here may fail because the module is not in
// its place; that error names the place.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/core/mesh.h"
#include "runtime/base/error.h"
#include "runtime/base/pixels.h"

namespace flaneur {

struct PictureShape {
  int width = 0, height = 0;
  std::vector<std::string> channels;  // names, as the file has them: "R", or "ViewLayer.albedo.R" in OpenEXR
};

// Rows from the top, the channels of a pixel side by side; floats as the file has them, bytes as sRGB files have them.
// accept: asked before any pixel is read; its error is the result. take: gets some whole rows at a time, from `first`
// on. Errors: a file that is no picture; names it.
using AcceptPicture = std::function<Error(const PictureShape&)>;
using TakeRows = std::function<void(int first, std::span<const float> values)>;
Error ReadPicture(const std::filesystem::path& file, const AcceptPicture& accept, const TakeRows& take);
Error ReadPicture(const std::filesystem::path& file, const AcceptPicture& accept, std::vector<uint8_t>* values);

// Of what reads and writes them, for the keys of results that are kept.
std::string PictureVersion();

// Straight alpha, packed quickly rather than well. Errors: what OpenImageIO says.
Error EncodePng(const Pixels& pixels, bool srgb, Image* image);

// Upright, no side longer than most_px; as JPEG, or as PNG where it is translucent. Errors: a file that is no picture;
// names it.
Error ScaledPicture(const std::filesystem::path& file, int most_px, std::vector<uint8_t>* bytes);

}  // namespace flaneur
