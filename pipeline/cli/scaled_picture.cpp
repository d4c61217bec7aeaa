#include "pipeline/cli/scaled_picture.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <string>

#include "runtime/base/array.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

constexpr int kJpegQuality = 90;

// Upright, 8 bits a channel, RGB or RGBA, no side longer than that.
OIIO::ImageBuf Scaled(const OIIO::ImageBuf& picture, int most_px) {
  const OIIO::ImageBuf upright = OIIO::ImageBufAlgo::reorient(picture);
  const int channels = upright.nchannels();
  std::vector<int> order{0, channels > 2 ? 1 : 0, channels > 2 ? 2 : 0};
  if (channels == 2 || channels >= 4) order.push_back(channels == 2 ? 1 : 3);
  OIIO::ImageBuf out = OIIO::ImageBufAlgo::channels(upright, Count(order), order);
  const int side = std::max(out.spec().width, out.spec().height);
  if (side <= most_px) return out;
  const auto scaled = [&](int length) { return std::max(1, length * most_px / side); };
  const OIIO::ROI roi(0, scaled(out.spec().width), 0, scaled(out.spec().height), 0, 1, 0, Count(order));
  return OIIO::ImageBufAlgo::resize(out, "", 0, roi);
}

}  // namespace

Error ScaledPicture(const std::filesystem::path& file, int most_px, std::vector<uint8_t>* bytes) {
  const auto refuse = [&](const std::string& why) {
    return Fail(file.string() + ": is no picture that can be read: " + OneLine(why));
  };
  // Not ImageBuf's own reading: its cache knows files by their time in whole seconds.
  const auto input = OIIO::ImageInput::open(file.string());
  if (!input) return refuse(OIIO::geterror());
  OIIO::ImageSpec read = input->spec();
  read.set_format(OIIO::TypeDesc::UINT8);
  OIIO::ImageBuf picture(read);
  if (!input->read_image(0, 0, 0, read.nchannels, OIIO::TypeDesc::UINT8, picture.localpixels()))
    return refuse(input->geterror());
  const OIIO::ImageBuf out = Scaled(picture, most_px);
  if (out.has_error()) return refuse(out.geterror());
  const char* name = out.nchannels() == 4 ? "picture.png" : "picture.jpg";
  OIIO::Filesystem::IOVecOutput memory;
  const auto writer = OIIO::ImageOutput::create(name, &memory);
  if (!writer) return refuse(OIIO::geterror());
  OIIO::ImageSpec spec(out.spec().width, out.spec().height, out.nchannels(), OIIO::TypeDesc::UINT8);
  spec.attribute("Compression", "jpeg:" + std::to_string(kJpegQuality));
  std::vector<uint8_t> pixels(spec.image_bytes());
  if (!out.get_pixels(OIIO::ROI::All(), OIIO::TypeDesc::UINT8, pixels.data())) return refuse(out.geterror());
  if (!writer->open(name, spec) || !writer->write_image(OIIO::TypeDesc::UINT8, pixels.data()) || !writer->close())
    return refuse(writer->geterror());
  *bytes = memory.buffer();
  return Ok();
}

}  // namespace flaneur
