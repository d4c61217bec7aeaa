#include "pipeline/impostor/atlas_image.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <string>

#include "runtime/base/text.h"

namespace flaneur {

double FillRate(const Pixels& albedo) {
  size_t covered = 0;
  for (size_t i = 3; i < albedo.rgba.size(); i += 4) covered += albedo.rgba[i] > 0;
  return albedo.rgba.empty()
             ? 0
             : 4 * static_cast<double>(covered) / static_cast<double>(albedo.rgba.size());
}

Error EncodePng(const Pixels& pixels, bool srgb, Image* image) {
  OIIO::ImageSpec spec(pixels.width, pixels.height, 4, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);  // else the writer would divide by it
  if (srgb) spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("png:compressionLevel", 6);
  OIIO::Filesystem::IOVecOutput bytes;
  auto output = OIIO::ImageOutput::create("atlas.png", &bytes);
  if (!output) return Fail("OpenImageIO cannot write PNG: " + OneLine(OIIO::geterror()));
  if (!output->open("atlas.png", spec) ||
      !output->write_image(OIIO::TypeDesc::UINT8, pixels.rgba.data()) || !output->close()) {
    return Fail("OpenImageIO cannot write PNG: " + OneLine(output->geterror()));
  }
  image->mime_type = "image/png";
  image->bytes = bytes.buffer();
  return Ok();
}

}  // namespace flaneur
