#include "pipeline/pictures/module/picture_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace flaneur {
namespace {

constexpr int kJpegQuality = 90, kPngLevel = 2, kRowsAtOnce = 32;

// None: why not, or accept's error in *refused.
std::unique_ptr<OIIO::ImageInput> Opened(const std::string& file, const AcceptPicture& accept, std::string* why,
                                         Error* refused) {
  auto input = OIIO::ImageInput::open(file);
  if (!input) {
    *why = OIIO::geterror();
    return nullptr;
  }
  const OIIO::ImageSpec& spec = input->spec();
  *refused = accept({spec.width, spec.height, spec.channelnames});
  return *refused ? nullptr : std::move(input);
}

// Not the whole picture at once: what Blender renders of an impostor takes 140 MB.
std::string ReadFloats(const std::string& file, const AcceptPicture& accept, const TakeRows& take, Error* refused) {
  std::string why;
  const auto input = Opened(file, accept, &why, refused);
  if (!input) return why;
  const OIIO::ImageSpec& spec = input->spec();
  const size_t row = static_cast<size_t>(spec.nchannels) * static_cast<size_t>(spec.width);
  std::vector<float> values(kRowsAtOnce * row);
  for (int y = 0; y < spec.height; y += kRowsAtOnce) {
    const int end = std::min(y + kRowsAtOnce, spec.height);
    if (!input->read_scanlines(0, 0, spec.y + y, spec.y + end, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT,
                               values.data()))
      return input->geterror();
    take(y, {values.data(), static_cast<size_t>(end - y) * row});
  }
  return "";
}

std::string ReadBytes(const std::string& file, const AcceptPicture& accept, std::vector<uint8_t>* values,
                      Error* refused) {
  std::string why;
  const auto input = Opened(file, accept, &why, refused);
  if (!input) return why;
  const OIIO::ImageSpec& spec = input->spec();
  values->resize(static_cast<size_t>(spec.nchannels) * static_cast<size_t>(spec.width) *
                 static_cast<size_t>(spec.height));
  return input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, values->data()) ? "" : input->geterror();
}

std::string Write(const char* name, const OIIO::ImageSpec& spec, const uint8_t* pixels, std::vector<uint8_t>* bytes) {
  OIIO::Filesystem::IOVecOutput memory;
  const auto output = OIIO::ImageOutput::create(name, &memory);
  if (!output) return OIIO::geterror();
  if (!output->open(name, spec) || !output->write_image(OIIO::TypeDesc::UINT8, pixels) || !output->close())
    return output->geterror();
  *bytes = memory.buffer();
  return "";
}

std::string EncodeAsPng(const Pixels& pixels, bool srgb, std::vector<uint8_t>* bytes) {
  OIIO::ImageSpec spec(pixels.width, pixels.height, 4, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);  // else the writer would divide by it
  if (srgb) spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("png:compressionLevel", kPngLevel);
  return Write("picture.png", spec, pixels.rgba.data(), bytes);
}

// Upright, 8 bits a channel, RGB or RGBA, no side longer than that.
OIIO::ImageBuf Upright(const OIIO::ImageBuf& picture, int most_px) {
  const OIIO::ImageBuf upright = OIIO::ImageBufAlgo::reorient(picture);
  const int channels = upright.nchannels();
  std::vector<int> order{0, channels > 2 ? 1 : 0, channels > 2 ? 2 : 0};
  if (channels == 2 || channels >= 4) order.push_back(channels == 2 ? 1 : 3);
  const int count = static_cast<int>(order.size());
  OIIO::ImageBuf out = OIIO::ImageBufAlgo::channels(upright, count, order);
  const int side = std::max(out.spec().width, out.spec().height);
  if (side <= most_px) return out;
  const auto scaled = [&](int length) { return std::max(1, length * most_px / side); };
  const OIIO::ROI roi(0, scaled(out.spec().width), 0, scaled(out.spec().height), 0, 1, 0, count);
  return OIIO::ImageBufAlgo::resize(out, "", 0, roi);
}

std::string Scaled(const std::string& file, int most_px, std::vector<uint8_t>* bytes) {
  // Not ImageBuf's own reading: its cache knows files by their time in whole seconds.
  const auto input = OIIO::ImageInput::open(file);
  if (!input) return OIIO::geterror();
  OIIO::ImageSpec read = input->spec();
  read.set_format(OIIO::TypeDesc::UINT8);
  OIIO::ImageBuf picture(read);
  if (!input->read_image(0, 0, 0, read.nchannels, OIIO::TypeDesc::UINT8, picture.localpixels()))
    return input->geterror();
  const OIIO::ImageBuf out = Upright(picture, most_px);
  if (out.has_error()) return out.geterror();
  OIIO::ImageSpec spec(out.spec().width, out.spec().height, out.nchannels(), OIIO::TypeDesc::UINT8);
  spec.attribute("Compression", "jpeg:" + std::to_string(kJpegQuality));
  std::vector<uint8_t> pixels(spec.image_bytes());
  if (!out.get_pixels(OIIO::ROI::All(), OIIO::TypeDesc::UINT8, pixels.data())) return out.geterror();
  return Write(out.nchannels() == 4 ? "picture.png" : "picture.jpg", spec, pixels.data(), bytes);
}

}  // namespace
}  // namespace flaneur

const flaneur::PictureModule* FlaneurPictureModule() {
  static const flaneur::PictureModule module{flaneur::ReadFloats, flaneur::ReadBytes, flaneur::EncodeAsPng,
                                             flaneur::Scaled};
  return &module;
}
