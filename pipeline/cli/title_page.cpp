#include "pipeline/cli/title_page.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>

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

// As JPEG, or as PNG where it is translucent.
Error PackPicture(const std::filesystem::path& file, int most_px, std::vector<uint8_t>* bytes) {
  const auto refuse = [&](const std::string& why) {
    return Fail(file.string() + ": is no picture for the title page: " + OneLine(why));
  };
  OIIO::ImageBuf picture(file.string());
  if (!picture.read(0, 0, true, OIIO::TypeDesc::UINT8)) return refuse(picture.geterror());
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

}  // namespace

void ReadTitlePageSettings(TomlTable table, TitlePageSettings* settings) {
  table.File("picture", &settings->picture);
  table.File("logo", &settings->logo);
  table.Color("background", &settings->background);
  table.Finish();
}

std::vector<std::filesystem::path> FilesOf(const TitlePageSettings& settings) {
  std::vector<std::filesystem::path> files;
  for (const auto& file : {settings.picture, settings.logo}) {
    if (!file.empty()) files.push_back(file);
  }
  return files;
}

Error MakeTitlePage(const TitlePageSettings& settings, TitlePage* page) {
  page->background = settings.background;
  if (!settings.picture.empty()) {
    if (Error e = PackPicture(settings.picture, kMaxTitlePicture_px, &page->picture)) return e;
  }
  return settings.logo.empty() ? Ok() : PackPicture(settings.logo, kMaxTitleLogo_px, &page->logo);
}

}  // namespace flaneur
