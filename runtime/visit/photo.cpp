#include "runtime/visit/photo.h"

#include <qrencode.h>

#include <algorithm>
#include <memory>
#include <random>

#include "runtime/base/file.h"
#include "runtime/base/png.h"
#include "runtime/render/caption.h"

namespace flaneur {
namespace fs = std::filesystem;
namespace {

constexpr int kJpegQuality = 90;
constexpr const char* kPrefix = "flaneur-";
constexpr const char* kExtension = ".jpg";
constexpr size_t kIdLetters = 10;
constexpr char kLetters[] = "23456789abcdefghjkmnpqrstuvwxyz";  // that nobody takes for each other
constexpr int kModule_px = 6, kQuiet_modules = 4;               // ISO/IEC 18004
constexpr uint8_t kStrip = 18;

bool IsPhoto(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.size() == PhotoFileName(std::string(kIdLetters, 'x')).size() && name.rfind(kPrefix, 0) == 0 &&
         file.extension() == kExtension;
}

void KeepYoungest(const fs::path& folder, size_t most) {
  std::vector<std::pair<fs::file_time_type, fs::path>> photos;
  std::error_code ec;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ec)) {
    if (IsPhoto(entry.path())) photos.emplace_back(entry.last_write_time(ec), entry.path());
  }
  if (photos.size() <= most) return;
  std::sort(photos.begin(), photos.end());
  for (size_t k = 0; k + most < photos.size(); ++k) fs::remove(photos[k].second, ec);
}

}  // namespace

Photo WithLine(Photo photo, const std::string& line, const std::string& language, Fonts* fonts) {
  if (line.empty()) return photo;
  const PackImage strip = LayOutCaption(line, {language, 0.8f, false}, photo.width_px, photo.height_px, fonts);
  for (size_t k = 0; k < strip.rgba.size(); k += 4) {
    for (size_t c = 0; c < 3; ++c) {
      const int over = strip.rgba[k + c], cover = strip.rgba[k + 3];
      photo.rgb.push_back(static_cast<uint8_t>((over * cover + kStrip * (255 - cover)) / 255));
    }
  }
  photo.height_px += strip.height_px;
  return photo;
}

std::string NewPhotoId() {
  std::random_device random;
  std::uniform_int_distribution<size_t> letter(0, sizeof kLetters - 2);
  std::string id;
  while (id.size() < kIdLetters) id += kLetters[letter(random)];
  return id;
}

std::string PhotoFileName(const std::string& id) { return kPrefix + id + kExtension; }

std::string PhotoLink(std::string pattern, const std::string& id) {
  const auto fill = [&](const std::string& what, const std::string& by) {
    for (size_t at = 0; (at = pattern.find(what, at)) != std::string::npos; at += by.size())
      pattern.replace(at, what.size(), by);
  };
  fill("{file}", PhotoFileName(id));
  fill("{id}", id);
  return pattern;
}

Error KeepPhoto(const Photo& photo, const fs::path& folder, const std::string& id, size_t most) {
  const fs::path file = folder / PhotoFileName(id);
  const std::vector<uint8_t> jpeg = EncodeJpeg(photo.width_px, photo.height_px, kJpegQuality, photo.rgb);
  if (jpeg.empty()) return Fail(file.string() + ": the picture cannot be encoded");
  if (Error e = WriteFile(file, jpeg)) return e;
  KeepYoungest(folder, std::max<size_t>(1, most));
  return Ok();
}

std::optional<QrPicture> QrOf(const std::string& text) {
  const std::unique_ptr<QRcode, void (*)(QRcode*)> code(QRcode_encodeString8bit(text.c_str(), 0, QR_ECLEVEL_M),
                                                        &QRcode_free);
  if (code == nullptr) return std::nullopt;
  QrPicture picture;
  picture.side_px = (code->width + 2 * kQuiet_modules) * kModule_px;
  const auto side = static_cast<size_t>(picture.side_px);
  picture.rgba.assign(side * side * 4, 255);
  for (int y = 0; y < picture.side_px; ++y) {
    for (int x = 0; x < picture.side_px; ++x) {
      const int column = x / kModule_px - kQuiet_modules, row = y / kModule_px - kQuiet_modules;
      if (column < 0 || row < 0 || column >= code->width || row >= code->width) continue;
      if ((code->data[row * code->width + column] & 1) == 0) continue;
      uint8_t* p = &picture.rgba[(static_cast<size_t>(y) * side + static_cast<size_t>(x)) * 4];
      p[0] = p[1] = p[2] = 0;
    }
  }
  return picture;
}

}  // namespace flaneur
