#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string_view>
#include <type_traits>

#include "pipeline/core/obj_files.h"
#include "pipeline/core/ply_header.h"
#include "pipeline/io/image_beside.h"
#include "pipeline/io/polygon_soup.h"
#include "pipeline/io/scene_reader.h"
#include "runtime/base/file.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

static_assert(std::endian::native == std::endian::little);

// Numbers one after the other. Past the end, or where something else stands, all are 0 and `ended` is set.
class Numbers {
 public:
  Numbers(std::string_view bytes, PlyFormat format) : rest_(bytes), format_(format) {}

  double Next(PlyType type) {
    switch (type) {
      case PlyType::kInt8:
        return Value<int8_t>();
      case PlyType::kUint8:
        return Value<uint8_t>();
      case PlyType::kInt16:
        return Value<int16_t>();
      case PlyType::kUint16:
        return Value<uint16_t>();
      case PlyType::kInt32:
        return Value<int32_t>();
      case PlyType::kUint32:
        return Value<uint32_t>();
      case PlyType::kFloat:
        return static_cast<double>(Value<float>());
      case PlyType::kDouble:
        return Value<double>();
    }
    return 0;
  }
  bool ended() const { return ended_; }

 private:
  template <typename T>
  T Value() {
    if (format_ == PlyFormat::kAscii) return Word<T>();
    std::array<char, sizeof(T)> bytes{};
    if (rest_.size() < sizeof(T)) {
      ended_ = true;
      rest_ = {};
    } else {
      std::copy_n(rest_.begin(), sizeof(T), bytes.begin());
      rest_.remove_prefix(sizeof(T));
    }
    if (format_ == PlyFormat::kBigEndian) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
  }

  template <typename T>
  T Word() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
    const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r\n"));
    rest_.remove_prefix(word.size());
    double value = 0;
    const bool read = ReadNumber(word, &value);
    const bool fits = std::is_same_v<T, double> || (value >= static_cast<double>(std::numeric_limits<T>::lowest()) &&
                                                    value <= static_cast<double>(std::numeric_limits<T>::max()));
    if (!read || !fits) ended_ = true;
    return ended_ ? T{} : static_cast<T>(value);
  }

  std::string_view rest_;
  PlyFormat format_;
  bool ended_ = false;
};

// What of a vertex is looked at, by the names that programs give it.
enum Slot : size_t { kX, kY, kZ, kNx, kNy, kNz, kRed, kGreen, kBlue, kU, kV, kSlots };

size_t SlotOf(const PlyProperty& property) {
  static constexpr std::array<std::pair<std::string_view, Slot>, 21> kNames{{
      {"x", kX},
      {"y", kY},
      {"z", kZ},
      {"nx", kNx},
      {"ny", kNy},
      {"nz", kNz},
      {"red", kRed},
      {"green", kGreen},
      {"blue", kBlue},
      {"r", kRed},
      {"g", kGreen},
      {"b", kBlue},
      {"diffuse_red", kRed},
      {"diffuse_green", kGreen},
      {"diffuse_blue", kBlue},
      {"s", kU},
      {"t", kV},
      {"u", kU},
      {"v", kV},
      {"texture_u", kU},
      {"texture_v", kV},
  }};
  const auto* known =
      std::find_if(kNames.begin(), kNames.end(), [&](const auto& name) { return name.first == property.name; });
  return known == kNames.end() || property.is_list ? kSlots : known->second;
}

// Colours are shares of one, or of as much as a byte or two hold.
double MostOf(PlyType type) { return type == PlyType::kUint8 ? 255 : type == PlyType::kUint16 ? 65535 : 1; }

// Calls with each of a list's numbers, or with the only one.
template <typename Use>
void ForEach(const PlyProperty& property, Numbers* numbers, Use use) {
  const double count = property.is_list ? numbers->Next(property.count_type) : 1;
  for (double i = 0; i < count; ++i) {
    const double value = numbers->Next(property.type);
    if (numbers->ended()) return;
    use(value);
  }
}

class Reader {
 public:
  Reader(const std::filesystem::path& path, UpAxis up) : path_(path), up_(up) {}

  Error Read(Scene* scene, std::vector<std::string>* warnings) {
    std::string bytes;
    if (Error e = ReadTextFile(path_, &bytes)) return e;
    if (Error e = ReadPlyHeader(bytes, &header_)) return Bad(e.message);
    Numbers numbers(std::string_view(bytes).substr(header_.size_bytes), header_.format);
    for (const PlyElement& element : header_.elements)
      if (Error e = TakeElement(element, &numbers)) return e;
    if (soup_.sizes.empty())
      return Bad("holds " + std::to_string(soup_.points.size()) +
                 " points and no face; make a mesh of them first (MeshLab, CloudCompare)");
    return Build(scene, warnings);
  }

 private:
  Error Bad(const std::string& why) const { return Fail(OneLine(path_.string() + ": " + why)); }

  Error TakeElement(const PlyElement& element, Numbers* numbers) {
    const bool vertices = element.name == "vertex", faces = element.name == "face";
    std::vector<size_t> slots;
    for (const PlyProperty& property : element.properties) slots.push_back(SlotOf(property));
    for (uint64_t i = 0; i < element.count && !slots.empty(); ++i) {
      const Error e = vertices ? TakeVertex(element, slots, numbers)
                      : faces  ? TakeFace(element, numbers)
                               : Skip(element, numbers);
      if (numbers->ended())
        return Bad("ends, or holds what is no number, in " + element.name + " " + std::to_string(i) + " of " +
                   std::to_string(element.count));
      if (e) return Bad(element.name + " " + std::to_string(i) + " " + e.message);
    }
    if (vertices) vertex_places_ = soup_.places.size();
    return Ok();
  }

  static Error Skip(const PlyElement& element, Numbers* numbers) {
    for (const PlyProperty& property : element.properties) ForEach(property, numbers, [](double) {});
    return Ok();
  }

  Error TakeVertex(const PlyElement& element, const std::vector<size_t>& slots, Numbers* numbers) {
    std::array<double, kSlots + 1> v{};
    std::array<bool, kSlots + 1> has{};
    for (size_t k = 0; k < slots.size(); ++k) {
      const PlyProperty& property = element.properties[k];
      ForEach(property, numbers, [&](double value) { v[slots[k]] = value; });
      has[slots[k]] = true;
      if (slots[k] >= kRed && slots[k] <= kBlue) v[slots[k]] /= MostOf(property.type);
    }
    if (!(has[kX] && has[kY] && has[kZ])) return Fail("has no x, y and z");
    if (!(std::isfinite(v[kX]) && std::isfinite(v[kY]) && std::isfinite(v[kZ]))) return Fail("is not finite");
    soup_.points.push_back({v[kX], v[kY], v[kZ]});
    if (has[kNx] && has[kNy] && has[kNz]) soup_.normals.push_back(UnitNormal(v[kNx], v[kNy], v[kNz]));
    if (has[kU] && has[kV]) soup_.places.push_back({static_cast<float>(v[kU]), static_cast<float>(v[kV])});
    // Scans have both, and the picture is the finer of them.
    if (has[kRed] && has[kGreen] && has[kBlue] && header_.pictures.empty())
      soup_.colors.push_back(ColorOfPoint(v[kRed], v[kGreen], v[kBlue]));
    return Ok();
  }

  Error TakeFace(const PlyElement& element, Numbers* numbers) {
    std::vector<double> corners, places;
    double picture = 0;
    for (const PlyProperty& property : element.properties) {
      const bool of_corners = property.name == "vertex_indices" || property.name == "vertex_index";
      ForEach(property, numbers, [&](double value) {
        if (of_corners) corners.push_back(value);
        else if (property.name == "texcoord") places.push_back(value);
        else if (property.name == "texnumber") picture = value;
      });
    }
    if (numbers->ended() || corners.size() < 3) return Ok();  // points and lines are no faces
    const size_t first_place = soup_.places.size();
    const bool own_places = places.size() == 2 * corners.size();
    for (size_t i = 0; i < corners.size(); ++i) {
      if (!(corners[i] >= 0 && corners[i] < static_cast<double>(soup_.points.size())))
        return Fail("names vertex " + Compact(corners[i]) + " of " + std::to_string(soup_.points.size()));
      const auto point = static_cast<uint32_t>(corners[i]);
      const size_t place = own_places ? first_place + i : point < vertex_places_ ? point : PolygonSoup::kNone;
      if (own_places)
        soup_.places.push_back({static_cast<float>(places[2 * i]), static_cast<float>(places[2 * i + 1])});
      soup_.corners.push_back(point);
      soup_.corner_places.push_back(static_cast<uint32_t>(place));
      soup_.corner_normals.push_back(point < soup_.normals.size() ? point : PolygonSoup::kNone);
    }
    soup_.sizes.push_back(static_cast<uint32_t>(corners.size()));
    pictures_.push_back(picture >= 0 && picture < 1e6 ? static_cast<size_t>(picture) : 0);
    return Ok();
  }

  // One look for each picture; what cannot be read leaves its faces plain.
  std::vector<FaceLook> Looks(TownBuilder* builder, std::vector<std::string>* warnings) const {
    std::vector<FaceLook> looks;
    for (const std::string& name : header_.pictures) {
      Image image;
      FaceLook& look = looks.emplace_back();
      look.has_picture = ReadImageFile(BesideModel(path_.parent_path(), name), &image);
      if (look.has_picture) {
        image.name = name;
        look.material = builder->AddMaterial(WhiteMaterial(), &image);
      } else if (warnings) {
        warnings->push_back(path_.string() + ": its picture '" + OneLine(name) +
                            "' is not beside it, or no PNG, JPEG or WebP; its surfaces are plain");
      }
    }
    return looks;
  }

  Error Build(Scene* scene, std::vector<std::string>* warnings) {
    const UpAxis up = UpOf(soup_, up_, path_.string(), "PLY", warnings);
    TownBuilder builder;
    const std::vector<FaceLook> looks = Looks(&builder, warnings);
    FaceLook plain;
    if (!soup_.colors.empty()) plain.material = builder.AddMaterial(WhiteMaterial(), nullptr);
    const int node = builder.AddNode(path_.stem().string(), NodeKind::kUntagged);
    size_t corner = 0;
    for (size_t face = 0; face < soup_.sizes.size(); corner += soup_.sizes[face++]) {
      const FaceLook& look = pictures_[face] < looks.size() ? looks[pictures_[face]] : plain;
      AddFace(soup_, corner, soup_.sizes[face], up, look, node, &builder);
    }
    return builder.Finish(path_.string(), {"", false}, scene, nullptr, warnings);
  }

  std::filesystem::path path_;
  UpAxis up_;
  PlyHeader header_;
  PolygonSoup soup_;
  size_t vertex_places_ = 0;      // of soup_.places: the first, one for each vertex
  std::vector<size_t> pictures_;  // of each face
};

}  // namespace

Error ReadPly(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings, UpAxis up) {
  return Reader(path, up).Read(scene, warnings);
}

}  // namespace flaneur
