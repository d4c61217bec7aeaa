#include <expat.h>
#include <iconv.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <unordered_map>

#include "pipeline/core/obj_files.h"
#include "pipeline/io/city_objects.h"
#include "pipeline/io/citygml_appearance.h"
#include "pipeline/io/scene_reader.h"
#include "pipeline/io/town_builder.h"
#include "pipeline/io/town_points.h"
#include "runtime/base/array.h"
#include "runtime/base/file.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

using Rings = std::vector<std::vector<Point3>>;

constexpr size_t kMaxDepth = 256;  // elements within elements; real files have some 25
constexpr size_t kChunk_bytes = 1 << 20;
constexpr char kSeparator = '|';           // expat puts it between namespace and name
constexpr const char* kSeparators = "|:";  // and the file a colon between prefix and name

// A polygon as it stands in the file.
struct StoredPolygon {
  int object;   // index of the node it belongs to
  int feature;  // the building, part or installation in it
  int lod;
  SurfaceKind surface;
  bool is_foundation;
  Rings rings;
  std::vector<std::string> ring_ids;  // where the file has appearances
  int look = -1;
};

// A reference to polygons that stand elsewhere in the file.
struct Reference {
  int object, feature, lod;
  std::string id;
};

struct Range {
  size_t begin, end;
};
using Matrix = std::array<double, 16>;  // row by row

Point3 Transformed(const Matrix& m, const Point3& p, const Point3& move) {
  const auto row = [&](size_t i) { return m[i] * p.x + m[i + 1] * p.y + m[i + 2] * p.z + m[i + 3]; };
  return {row(0) + move.x, row(4) + move.y, row(8) + move.z};
}

std::string_view LocalName(std::string_view name) {
  const size_t at = name.find_last_of(kSeparators);
  return at == std::string_view::npos ? name : name.substr(at + 1);
}

// lod2Solid, lod3MultiSurface, tin, ...: the level of what is in it. Curves, outlines and interiors are none. Of what
// lies on the ground level 0 says where, as kLevel0.
constexpr int kLevel0 = 5;
std::optional<int> LodOf(std::string_view name, bool on_ground) {
  if (name == "tin") return 1;
  if (name == "lod0MultiSurface" && on_ground) return kLevel0;
  if (name.size() < 5 || name.substr(0, 3) != "lod" || name[3] < '1' || name[3] > '4') return std::nullopt;
  const std::string_view what = name.substr(4);
  constexpr std::array<std::string_view, 5> kSurfaces{"Solid", "MultiSurface", "Geometry", "ImplicitRepresentation",
                                                      "Surface"};
  if (std::find(kSurfaces.begin(), kSurfaces.end(), what) == kSurfaces.end()) return std::nullopt;
  return name[3] - '0';
}

bool IsPolygon(std::string_view name) {
  return name == "Polygon" || name == "PolygonPatch" || name == "Triangle" || name == "Rectangle";
}

// What it holds says what the object is.
bool IsWord(std::string_view name) { return name == "function" || name == "relationToConstruction"; }

bool HoldsCoordinates(std::string_view name) {
  return name == "posList" || name == "pos" || name == "coordinates" || name == "transformationMatrix";
}

// Of encodings that expat does not know those with a character for each byte, as windows-1250 and its kin.
int MapEncoding(void*, const char* name, XML_Encoding* encoding) {
  const iconv_t converter = ::iconv_open("UTF-32LE", name);
  if (converter == reinterpret_cast<iconv_t>(-1)) return XML_STATUS_ERROR;
  bool single = true;
  for (int byte = 0; byte < 256; ++byte) {
    char in = static_cast<char>(byte);
    uint32_t out = 0;
    char *from = &in, *to = reinterpret_cast<char*>(&out);
    size_t from_left = 1, to_left = sizeof out;
    const bool known = ::iconv(converter, &from, &from_left, &to, &to_left) != static_cast<size_t>(-1);
    if (!known && errno == EINVAL) single = false;  // a character's first byte
    ::iconv(converter, nullptr, nullptr, nullptr, nullptr);
    encoding->map[byte] = known ? static_cast<int>(out) : -1;
  }
  ::iconv_close(converter);
  return single ? XML_STATUS_OK : XML_STATUS_ERROR;
}

class Reader {
 public:
  // keep_rings: by their ids, for texture coordinates.
  Reader(const std::filesystem::path& path, bool keep_rings, std::vector<std::string>* warnings,
         const ReadSceneOptions& options, SceneSource* source, bool namespaces)
      : path_(path),
        keep_rings_(keep_rings),
        warnings_(warnings),
        options_(options),
        source_(*source),
        parser_(namespaces ? XML_ParserCreateNS(nullptr, kSeparator) : XML_ParserCreate(nullptr), &XML_ParserFree) {}

  // A name's prefix that the file does not explain: it may be read without looking at namespaces.
  bool lacks_namespace() const { return XML_GetErrorCode(parser_.get()) == XML_ERROR_UNBOUND_PREFIX; }

  // Whether what was read has looks but no rings to put them on.
  bool NeedsRings() const { return !keep_rings_ && !appearances_.empty(); }

  Error Parse() {
    if (Error e = CheckReadable(path_)) return e;
    const std::unique_ptr<FILE, int (*)(FILE*)> file(std::fopen(path_.c_str(), "rb"), &std::fclose);
    if (!file) return Fail(path_.string() + ": cannot be opened");
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), &Reader::OnStart, &Reader::OnEnd);
    XML_SetStartDoctypeDeclHandler(parser_.get(), &Reader::OnDoctype);
    XML_SetUnknownEncodingHandler(parser_.get(), &MapEncoding, nullptr);
    for (bool last = false; !last;) {
      void* buffer = XML_GetBuffer(parser_.get(), static_cast<int>(kChunk_bytes));
      if (!buffer) return Fail(path_.string() + ": out of memory");
      const size_t count = std::fread(buffer, 1, kChunk_bytes, file.get());
      last = count < kChunk_bytes;
      const bool good = XML_ParseBuffer(parser_.get(), static_cast<int>(count), last) == XML_STATUS_OK;
      if (error_) return error_;
      if (!good) return Fail(Where() + "not well-formed XML: " + XML_ErrorString(XML_GetErrorCode(parser_.get())));
    }
    return Ok();
  }

  Error Build(Scene* scene) {
    std::error_code ec;
    TownPoints left(std::filesystem::file_size(path_, ec));
    Error too_many = PlaceImplicits(&left);
    if (!too_many) too_many = TakeReferences(&left);
    if (too_many) return Fail(path_.string() + ": " + too_many.message);
    if (without_geometry_ > 0 && warnings_)
      warnings_->push_back(path_.string() + ": " + std::to_string(without_geometry_) +
                           " objects show models in other files; they were left out");
    TownBuilder builder;
    const std::vector<int> materials = AddMaterials(path_, appearances_.looks(), &builder, warnings_);
    AddPolygons(materials, &builder);
    polygons_ = {};
    const std::string& system = options_.system.empty() ? reference_system_ : options_.system;
    return builder.Finish(path_.string(), {PlainReferenceSystem(system), true}, scene, &source_.system, warnings_);
  }

 private:
  struct Element {
    std::string name, id;
    size_t first_polygon;
    int object, feature, lod;
    const CitySurface* surface;
    bool skipped;
  };

  static void OnStart(void* self, const char* name, const char** attributes) {
    static_cast<Reader*>(self)->Start(name, attributes);
  }
  static void OnEnd(void* self, const char*) { static_cast<Reader*>(self)->End(); }
  static void OnText(void* self, const char* text, int length) {
    static_cast<Reader*>(self)->text_.append(text, static_cast<size_t>(length));
  }
  static void OnDoctype(void* self, const char*, const char*, const char*, int) {
    static_cast<Reader*>(self)->Stop(
        "has a DOCTYPE, which CityGML does not need and which can hide an XML bomb; remove it");
  }

  std::string Where() const {
    return path_.string() + ":" + std::to_string(XML_GetCurrentLineNumber(parser_.get())) + ": ";
  }
  void Stop(const std::string& why) {
    if (!error_) error_ = Fail(OneLine(Where() + why));
    XML_StopParser(parser_.get(), XML_FALSE);
  }

  void Start(std::string_view full_name, const char** attributes) {
    if (error_) return;
    const std::string_view name = LocalName(full_name);
    if (stack_.empty()) CheckRoot(full_name, name);
    if (stack_.size() >= kMaxDepth) return Stop("elements stand more than 256 deep; no CityGML does");
    Element e{std::string(name), {}, polygons_.size(), -1, -1, 0, nullptr, false};
    if (!stack_.empty()) {
      const Element& parent = stack_.back();
      e.object = parent.object, e.feature = parent.feature, e.lod = parent.lod;
      e.surface = parent.surface, e.skipped = parent.skipped;
    }
    std::string reference, uri, ring;
    for (const char** a = attributes; *a; a += 2) {
      const std::string_view key = LocalName(a[0]);
      if (key == "id") e.id = a[1];
      else if (key == "href") reference = a[1];
      else if (key == "uri") uri = a[1];
      else if (key == "ring") ring = a[1];
      else if (key == "srsName" && reference_system_.empty()) reference_system_ = a[1];
    }
    stack_.push_back(std::move(e));
    Enter(&stack_.back(), reference);
    if (appearances_.Enter(name, uri, ring)) Collect(true), text_.clear();
  }

  void CheckRoot(std::string_view full_name, std::string_view name) {
    if (name != "CityModel")
      return Stop("its outermost element is '" + std::string(name) + "', not CityGML's CityModel");
    const bool named = full_name.find(kSeparator) != std::string_view::npos;
    if (!named) {
      if (warnings_)
        warnings_->push_back(path_.string() +
                             ": its CityModel names no namespace; read as CityGML 2.0 (add "
                             "xmlns=\"http://www.opengis.net/citygml/2.0\")");
      return;
    }
    for (const char* version : {"/1.0", "/2.0", "/3.0"})
      if (full_name.find(std::string("opengis.net/citygml") + version) != std::string_view::npos) return;
    Stop("CityGML 1.0 to 3.0 are understood, not '" +
         std::string(full_name.substr(0, full_name.size() - name.size() - 1)) + "'; convert it");
  }

  void Enter(Element* e, const std::string& reference) {
    if (e->skipped) return;
    if (IsIndoors(e->name)) e->skipped = true;
    else if (const CityFeature* feature = FindCityFeature(e->name)) EnterFeature(*feature, e);
    else if (const CitySurface* surface = FindCitySurface(e->name)) e->surface = surface;
    else if (e->name == "exterior" || e->name == "interior" || IsPolygon(e->name)) EnterGeometry(e->name);
    else if (e->name == "ImplicitGeometry") implicit_ = Implicit{};
    else if (const std::optional<int> lod = LodOf(e->name, IsOnGround(*e))) e->lod = *lod;
    if (!reference.empty() && e->lod > 0 && e->object >= 0 && reference[0] == '#')
      references_.push_back({e->object, e->feature, e->lod, reference.substr(1)});
    if (IsWord(e->name) && e->object >= 0) Collect(true), text_.clear();
    if (!HoldsCoordinates(e->name)) return;
    Collect(in_polygon_ || implicit_);
    text_.clear();
  }

  bool IsOnGround(const Element& e) const {
    return e.object >= 0 && At(objects_, e.object).feature.kind == NodeKind::kGround;
  }

  void Collect(bool on) {
    collects_ = on;
    XML_SetCharacterDataHandler(parser_.get(), on ? &Reader::OnText : nullptr);
  }

  void EnterFeature(const CityFeature& feature, Element* e) {
    if (!feature.is_part || e->object < 0) {
      const std::string name = e->id.empty() ? e->name + "_" + std::to_string(objects_.size()) : e->id;
      e->object = Count(objects_);
      objects_.push_back({name, feature, features_});
      e->surface = nullptr;
      e->lod = 0;
    }
    e->feature = features_++;
  }

  void EnterGeometry(const std::string& name) {
    if (IsPolygon(name)) {
      const Element& e = stack_.back();
      in_polygon_ = e.lod > 0 && e.object >= 0 && !(e.surface && e.surface->is_virtual);
      rings_.clear();
    } else if (in_polygon_) {
      rings_.emplace_back();
    }
  }

  void End() {
    if (error_) return;
    const Element e = std::move(stack_.back());
    stack_.pop_back();
    if (e.name == "LinearRing" && in_polygon_ && keep_rings_ && !rings_.empty()) {
      ring_ids_.resize(rings_.size());
      ring_ids_.back() = e.id;
    }
    appearances_.Leave(e.name, collects_ ? text_ : std::string());
    if (collects_ && !in_polygon_ && !implicit_ && !IsWord(e.name)) Collect(false);
    if (collects_ && IsWord(e.name)) TakeWord(e);
    else if (collects_ && HoldsCoordinates(e.name)) TakeCoordinates(e);
    else if (IsPolygon(e.name) && in_polygon_) Store(e);
    else if (e.name == "ImplicitGeometry" && implicit_) EndImplicit(e);
    if (!e.id.empty() && e.lod > 0 && polygons_.size() > e.first_polygon)
      ranges_[e.id] = {e.first_polygon, polygons_.size()};
  }

  void TakeWord(const Element& e) {
    Collect(false);
    const std::string_view word = Trimmed(text_);
    if (e.name == "function" && IsBridgeFunction(word)) At(objects_, e.object).feature.is_bridge = true;
    if (e.name == "relationToConstruction" && word == "inside" &&
        !stack_.empty())  // an installation's, behind its faces
      for (size_t i = stack_.back().first_polygon; i < polygons_.size(); ++i) polygons_[i].lod = 0;
  }

  void TakeCoordinates(const Element& e) {
    Collect(false);
    std::vector<double> numbers;
    const char *at = text_.data(), *end = at + text_.size();
    while (true) {
      while (at < end && (static_cast<unsigned char>(*at) <= ' ' || *at == ',')) ++at;
      if (at == end) break;
      if (*at == '+') ++at;
      double value = 0;
      const auto [next, problem] = std::from_chars(at, end, value);
      if (problem != std::errc() || !std::isfinite(value))
        return Stop(Named(e) + ": '" + std::string(at, std::min<size_t>(12, static_cast<size_t>(end - at))) +
                    "' is no coordinate");
      numbers.push_back(value);
      at = next;
    }
    if (e.name == "transformationMatrix") return TakeMatrix(e, numbers);
    if (numbers.size() % 3 != 0)
      return Stop(Named(e) + ": " + std::to_string(numbers.size()) +
                  " numbers do not make points of three coordinates");
    if (!in_polygon_) return TakeReferencePoint(numbers);
    if (rings_.empty()) rings_.emplace_back();
    for (size_t i = 0; i < numbers.size(); i += 3)
      rings_.back().push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  }

  std::string Named(const Element& e) const { return e.object < 0 ? e.name : "'" + At(objects_, e.object).name + "'"; }

  void TakeMatrix(const Element& e, const std::vector<double>& numbers) {
    if (numbers.size() != 16) return Stop(Named(e) + ": a transformationMatrix needs 16 numbers");
    if (implicit_) std::copy(numbers.begin(), numbers.end(), implicit_->matrix.begin());
  }
  void TakeReferencePoint(const std::vector<double>& numbers) {
    if (implicit_ && numbers.size() == 3) implicit_->at = {numbers[0], numbers[1], numbers[2]};
  }

  void Store(const Element& e) {
    in_polygon_ = false;
    for (std::vector<Point3>& ring : rings_) {
      const auto same = [](const Point3& p, const Point3& q) { return p.x == q.x && p.y == q.y && p.z == q.z; };
      ring.erase(std::unique(ring.begin(), ring.end(), same), ring.end());
      if (ring.size() > 1 && same(ring.front(), ring.back())) ring.pop_back();
    }
    ring_ids_.resize(keep_rings_ ? rings_.size() : 0);
    for (size_t i = rings_.size(); i-- > 1;) {
      if (rings_[i].size() >= 3) continue;
      rings_.erase(rings_.begin() + static_cast<long>(i));
      if (keep_rings_) ring_ids_.erase(ring_ids_.begin() + static_cast<long>(i));
    }
    const SurfaceKind kind = e.surface ? e.surface->surface : SurfaceKind::kNotSaid;
    polygons_.push_back({e.object, e.feature, e.lod, kind, e.surface && e.surface->is_foundation, std::move(rings_),
                         std::move(ring_ids_)});
    rings_.clear();
    ring_ids_.clear();
  }

  // The prototype stands in its own coordinates and is moved to its place; others may refer to it as it was.
  void EndImplicit(const Element& e) {
    Implicit place = *implicit_;
    implicit_.reset();
    place.object = e.object, place.feature = e.feature, place.lod = e.lod;
    place.prototype = {e.first_polygon, polygons_.size()};
    if (!references_.empty() && references_.back().object == e.object && place.prototype.begin == place.prototype.end) {
      place.id = references_.back().id;
      references_.pop_back();
    }
    for (size_t i = place.prototype.begin; i < place.prototype.end; ++i) polygons_[i].lod = 0;  // not where it stands
    if (place.id.empty() && place.prototype.begin == place.prototype.end) ++without_geometry_;
    else implicits_.push_back(std::move(place));
  }

  Error TakeCopy(StoredPolygon polygon, TownPoints* left) {
    size_t points = 1;
    for (const auto& ring : polygon.rings) points += ring.size();
    if (Error e = left->Take(points)) return e;
    polygons_.push_back(std::move(polygon));
    return Ok();
  }

  Error PlaceImplicits(TownPoints* left) {
    for (const Implicit& place : implicits_) {
      Range range = place.prototype;
      if (!place.id.empty()) {
        const auto found = ranges_.find(place.id);
        if (found == ranges_.end()) continue;
        range = found->second;
      }
      for (size_t i = range.begin; i < range.end; ++i) {
        if (Error e = TakeCopy(StoredPolygon(polygons_[i]), left)) return e;
        StoredPolygon& polygon = polygons_.back();
        polygon.object = place.object, polygon.feature = place.feature, polygon.lod = place.lod;
        for (auto& ring : polygon.rings)
          for (Point3& p : ring) p = Transformed(place.matrix, p, place.at);
      }
    }
    return Ok();
  }

  // A solid often only lists the polygons of its own building's surfaces; a neighbour's wall is taken over.
  Error TakeReferences(TownPoints* left) {
    for (const Reference& r : references_) {
      const auto found = ranges_.find(r.id);
      if (found == ranges_.end()) continue;
      const Range range = found->second;
      for (size_t i = range.begin; i < range.end; ++i) {
        if (polygons_[i].object == r.object) continue;
        if (Error e = TakeCopy(StoredPolygon(polygons_[i]), left)) return e;
        StoredPolygon& polygon = polygons_.back();
        polygon.object = r.object, polygon.feature = r.feature, polygon.lod = r.lod;
      }
    }
    return Ok();
  }

  // Level 4 only where there is none from 1 to 3: it is about interiors. Level 0 only where there is no other.
  static int Finer(int a, int b) {
    constexpr std::array<int, 6> kRank{0, 3, 4, 5, 2, 1};
    return At(kRank, a) >= At(kRank, b) ? a : b;
  }

  // Each part has its own finest level; a building's own model gives way to finer ones of its parts.
  struct Levels {
    std::vector<int> of_feature, of_object;
  };
  Levels FinestLevels() const {
    Levels levels{std::vector<int>(static_cast<size_t>(features_), 0), std::vector<int>(objects_.size(), 0)};
    for (const StoredPolygon& p : polygons_) {
      for (int* finest : {&At(levels.of_feature, p.feature), &At(levels.of_object, p.object)})
        if (p.lod > 0) *finest = Finer(*finest, p.lod);
    }
    return levels;
  }

  // The looks of polygons, by the ids of these or of what holds them; the first one counts.
  void TakeLooks(const std::vector<int>& materials) {
    // Of each polygon the first from it on that may have no look yet: many looks may name the same whole town.
    std::vector<size_t> next(polygons_.size() + 1);
    std::iota(next.begin(), next.end(), size_t{0});
    const auto without_look = [&next](size_t i) {
      while (next[i] != i) i = next[i] = next[next[i]];
      return i;
    };
    for (size_t k = 0; k < materials.size(); ++k) {
      for (const std::string& target : appearances_.looks()[k].targets) {
        const auto found = ranges_.find(target);
        if (found == ranges_.end()) continue;
        for (size_t i = without_look(found->second.begin); i < found->second.end; i = without_look(i)) {
          if (polygons_[i].look < 0) polygons_[i].look = static_cast<int>(k);
          next[i] = i + 1;
        }
      }
    }
  }

  PolygonLook LookOf(const StoredPolygon& p, const std::vector<int>& materials) const {
    PolygonLook look;
    if (p.look < 0) return look;
    look.material = At(materials, p.look);
    if (At(appearances_.looks(), p.look).image.empty()) return look;
    for (size_t i = 0; i < p.rings.size(); ++i) {
      const std::vector<Vec2>* uvs =
          i < p.ring_ids.size() ? appearances_.TextureCoordinates(p.ring_ids[i], p.rings[i].size()) : nullptr;
      if (!uvs) return {};
      look.uvs.push_back(*uvs);
    }
    return look;
  }

  void AddPolygons(const std::vector<int>& materials, TownBuilder* builder) {
    TakeLooks(materials);
    const Levels levels = FinestLevels();
    std::vector<int> node(objects_.size(), -1);
    for (const StoredPolygon& p : polygons_) {
      const auto object = static_cast<size_t>(p.object);
      const int lod = At(levels.of_feature, p.feature);
      const bool outdone = p.feature == objects_[object].root && lod != levels.of_object[object];
      if (p.lod == 0 || p.lod != lod || outdone) continue;
      const Object& o = objects_[object];
      if (node[object] < 0) {
        node[object] = builder->AddNode(o.name, o.feature.kind, o.feature.ground);
        if (o.feature.is_bridge) builder->MarkBridge(node[object]);
      }
      const bool foundation = p.is_foundation && o.feature.kind == NodeKind::kBuilding;
      const SurfaceKind surface = p.surface == SurfaceKind::kNotSaid ? o.feature.surface : p.surface;
      builder->AddPolygon(foundation ? builder->FoundationOf(node[object]) : node[object], surface, p.rings,
                          LookOf(p, materials));
    }
    for (size_t i = 0; i < objects_.size(); ++i)  // for the builder to tell that it is left out
      if (node[i] < 0 && objects_[i].feature.kind == NodeKind::kBuilding)
        builder->AddNode(objects_[i].name, NodeKind::kBuilding);
  }

  struct Object {
    std::string name;
    CityFeature feature;
    int root;
  };
  struct Implicit {
    Matrix matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    Point3 at;
    int object = 0, feature = 0, lod = 0;
    Range prototype{0, 0};
    std::string id;
  };

  std::filesystem::path path_;
  bool keep_rings_;
  std::vector<std::string>* warnings_;
  const ReadSceneOptions& options_;
  SceneSource& source_;
  std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> parser_;
  Error error_;
  std::vector<Element> stack_;
  std::vector<Object> objects_;
  int features_ = 0, without_geometry_ = 0;
  std::string reference_system_, text_;
  bool in_polygon_ = false, collects_ = false;
  Rings rings_;
  std::vector<std::string> ring_ids_;
  CityAppearances appearances_;
  std::optional<Implicit> implicit_;
  std::vector<Implicit> implicits_;
  std::vector<StoredPolygon> polygons_;
  std::vector<Reference> references_;
  std::unordered_map<std::string, Range> ranges_;
};

}  // namespace

Error ReadCityGml(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings,
                  const ReadSceneOptions& options, SceneSource* source) {
  bool namespaces = true, keep_rings = false;
  for (;;) {
    Reader reader(path, keep_rings, warnings, options, source, namespaces);
    if (Error e = reader.Parse()) {
      if (!namespaces || !reader.lacks_namespace()) return e;
      namespaces = false;
    } else if (!keep_rings && reader.NeedsRings()) {
      keep_rings = true;
    } else {
      return reader.Build(scene);
    }
  }
}

}  // namespace flaneur
