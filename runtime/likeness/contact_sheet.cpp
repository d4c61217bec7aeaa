#include "runtime/likeness/contact_sheet.h"

#include <algorithm>

#include "runtime/base/png.h"

namespace flaneur {
namespace {

constexpr double kWhite = 20;  // dE*ab

struct Sheet {
  size_t width = 0, height = 0;
  std::vector<uint8_t> rgb;
};

std::vector<uint8_t> DifferencePicture(const SheetPair& pair) {
  std::vector<uint8_t> rgba(pair.full.rgba.size());
  for (size_t i = 0; i + 3 < rgba.size(); i += 4) {
    const double share = std::min(1.0, DeltaE(&pair.full.rgba[i], &pair.other.rgba[i]) / kWhite);
    std::fill_n(&rgba[i], 3, static_cast<uint8_t>(share * 255));
  }
  return rgba;
}

void Paste(const std::vector<uint8_t>& rgba, size_t size, size_t left, size_t top, Sheet* sheet) {
  for (size_t y = 0; y < size; ++y) {
    for (size_t x = 0; x < size; ++x) {
      std::copy_n(&rgba[4 * (y * size + x)], 3, &sheet->rgb[3 * ((top + y) * sheet->width + left + x)]);
    }
  }
}

size_t RowSize(const std::vector<SheetPair>& row) {
  return row.empty() ? 0 : static_cast<size_t>(row.front().full.size_px);
}

}  // namespace

Error WriteContactSheet(const std::filesystem::path& path, const std::vector<std::vector<SheetPair>>& rows) {
  Sheet sheet;
  for (const auto& row : rows) {
    sheet.width = std::max(sheet.width, RowSize(row) * row.size());
    sheet.height += 3 * RowSize(row);
  }
  sheet.rgb.assign(3 * sheet.width * sheet.height, 40);
  size_t top = 0;
  for (const auto& row : rows) {
    const size_t size = RowSize(row);
    for (size_t k = 0; k < row.size(); ++k) {
      Paste(row[k].full.rgba, size, k * size, top, &sheet);
      Paste(row[k].other.rgba, size, k * size, top + size, &sheet);
      Paste(DifferencePicture(row[k]), size, k * size, top + 2 * size, &sheet);
    }
    top += 3 * size;
  }
  return WritePng(path, static_cast<int>(sheet.width), static_cast<int>(sheet.height), sheet.rgb);
}

}  // namespace flaneur
