#include "pipeline/web/pieces.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace flaneur {
namespace {

constexpr size_t kImageHead_bytes = 2048;  // more than what tells a picture's size, unless its maker wrote a novel

// Adds ranges to pieces, each byte once.
class Cutter {
 public:
  Cutter(size_t bytes, const PieceLimits& limits) : bytes_(bytes), limits_(limits) {}

  void Add(ByteRange range) {
    range.bytes = std::min(range.bytes, bytes_ - std::min(bytes_, range.offset));
    for (size_t at = range.offset, end = at + range.bytes; at < end;) {
      if (const size_t known = taken_.HeldFrom(at)) {
        at += known;
        continue;
      }
      size_t free = at;
      while (free < end && taken_.HeldFrom(free) == 0) free = NextTaken(free, end);
      Take({at, free - at});
      at = free;
    }
  }
  void Add(const std::vector<ByteRange>& ranges) {
    for (const ByteRange& range : ranges) Add(range);
  }
  void EndOfOpening() {
    for (PackPiece& piece : pieces_) piece.opens = true;
    starts_ = true;
  }
  void EndOfFirst() {
    for (PackPiece& piece : pieces_) piece.first = true;
    starts_ = true;
  }
  std::vector<PackPiece> Finish() {
    Add({0, bytes_});
    for (PackPiece& piece : pieces_) Join(&piece.parts);
    return std::move(pieces_);
  }

 private:
  size_t NextTaken(size_t from, size_t end) const {
    const auto next = begins_.upper_bound(from);
    return next == begins_.end() ? end : std::min(end, *next);
  }
  void Take(ByteRange range) {
    taken_.Add(range);
    begins_.insert(range.offset);
    if (starts_ || size_ >= limits_.piece_bytes) {
      pieces_.emplace_back();
      size_ = 0;
      starts_ = false;
    }
    pieces_.back().parts.push_back(range);
    size_ += range.bytes;
  }
  static void Join(std::vector<ByteRange>* parts) {
    std::sort(parts->begin(), parts->end(), [](const ByteRange& a, const ByteRange& b) { return a.offset < b.offset; });
    std::vector<ByteRange> joined;
    for (const ByteRange& part : *parts) {
      if (!joined.empty() && joined.back().offset + joined.back().bytes == part.offset)
        joined.back().bytes += part.bytes;
      else joined.push_back(part);
    }
    *parts = std::move(joined);
  }

  size_t bytes_, size_ = 0;
  PieceLimits limits_;
  ByteRanges taken_;
  std::set<size_t> begins_;  // of what is taken
  std::vector<PackPiece> pieces_;
  bool starts_ = true;
};

Vec2 StartOf(const TourPack& pack) {
  if (!pack.path.empty()) return pack.path.front().position_m;
  const GroundRaster& ground = *pack.ground;
  return ground.min_m + Vec2{static_cast<float>(ground.columns), static_cast<float>(ground.rows)} * (ground.cell_m / 2);
}

struct GroundBox {
  Vec2 low{std::numeric_limits<float>::max(), std::numeric_limits<float>::max()}, high = low * -1;
};

GroundBox BoxOf(const TownInstance& instance, const TourPack& pack) {
  GroundBox box;
  for (const PackPrimitive& primitive : pack.meshes[static_cast<size_t>(instance.mesh)].primitives) {
    for (const Vec3& corner : primitive.positions) {
      const Vec3 p = TransformPoint(instance.world, corner);
      box.low = {std::min(box.low.x, p.x), std::min(box.low.y, -p.z)};
      box.high = {std::max(box.high.x, p.x), std::max(box.high.y, -p.z)};
    }
  }
  return box;
}

// As one sees it from there: its width over its distance.
float ApparentSize(const TownInstance& instance, const TourPack& pack, Vec2 from) {
  constexpr float kNearest_m = 4;
  const GroundBox box = BoxOf(instance, pack);
  const Vec2 away{std::max({box.low.x - from.x, 0.0f, from.x - box.high.x}),
                  std::max({box.low.y - from.y, 0.0f, from.y - box.high.y})};
  return Length(box.high - box.low) / std::max(kNearest_m, Length(away));
}

size_t Bytes(const std::vector<ByteRange>& ranges) {
  size_t bytes = 0;
  for (const ByteRange& range : ranges) bytes += range.bytes;
  return bytes;
}

std::set<int> ImagesOf(int mesh, const TourPack& pack) {
  std::set<int> images;
  for (const PackPrimitive& primitive : pack.meshes[static_cast<size_t>(mesh)].primitives) {
    if (primitive.material < 0) continue;
    const int image = pack.materials[static_cast<size_t>(primitive.material)].base_color_image;
    if (image >= 0) images.insert(image);
  }
  return images;
}

// What is seen largest where the visit begins comes first; each once.
std::vector<int> TownBySize(const TourPack& pack) {
  std::map<int, float> sizes;
  for (const TownInstance& instance : pack.town) {
    float& size = sizes[instance.mesh];
    size = std::max(size, ApparentSize(instance, pack, StartOf(pack)));
  }
  std::vector<int> meshes;
  for (const auto& [mesh, unused] : sizes) meshes.push_back(mesh);
  std::stable_sort(meshes.begin(), meshes.end(), [&](int a, int b) { return sizes[a] > sizes[b]; });
  return meshes;
}

// All but what is read piece by piece.
void AddFrame(const PackFile& file, const TourPack& pack, size_t bytes, Cutter* cutter) {
  ByteRanges bulk;
  std::set<size_t> begins{bytes};
  const auto add = [&](const std::vector<ByteRange>& ranges, size_t kept) {
    for (ByteRange range : ranges) {
      const size_t head = std::min(kept, range.bytes);
      bulk.Add({range.offset + head, range.bytes - head});
      begins.insert(range.offset + head);
    }
  };
  for (size_t k = 0; k < pack.images.size(); ++k) add(file.RangesOfImage(static_cast<int>(k)), kImageHead_bytes);
  for (size_t k = 0; k < pack.meshes.size(); ++k) add(file.RangesOfMesh(static_cast<int>(k)), 0);
  for (size_t k = 0; k < pack.avatars.size(); ++k) add(file.RangesOfAtlas(static_cast<int>(k)), 0);
  add(pack.sound_ranges, 0);
  add(pack.picture_ranges, 0);
  for (size_t at = 0; at < bytes;) {
    if (const size_t held = bulk.HeldFrom(at)) {
      at += held;
      continue;
    }
    const size_t end = *begins.upper_bound(at);
    cutter->Add({at, end - at});
    at = end;
  }
}

// Of the town as much as is near the start, with its pictures.
void AddNearTown(const PackFile& file, const TourPack& pack, const std::vector<int>& town, size_t most_bytes,
                 Cutter* cutter) {
  std::set<int> images;
  size_t bytes = 0;
  for (int mesh : town) {
    const std::vector<ByteRange> ranges = file.RangesOfMesh(mesh);
    size_t more = Bytes(ranges);
    const std::set<int> of_mesh = ImagesOf(mesh, pack);
    for (int image : of_mesh) more += images.contains(image) ? 0 : Bytes(file.RangesOfImage(image));
    if (bytes > 0 && bytes + more > most_bytes) continue;
    bytes += more;
    cutter->Add(ranges);
    for (int image : of_mesh) {
      cutter->Add(file.RangesOfImage(image));
      images.insert(image);
    }
  }
}

}  // namespace

std::vector<PackPiece> PiecesOf(const PackFile& file, const TourPack& pack, size_t bytes, const PieceLimits& limits) {
  Cutter cutter(bytes, limits);
  const std::vector<int> town = TownBySize(pack);
  const auto for_avatars = [&](auto add) {
    for (size_t a = 0; a < pack.avatars.size(); ++a) add(static_cast<int>(a), pack.avatars[a]);
  };
  AddFrame(file, pack, bytes, &cutter);
  cutter.EndOfOpening();
  AddNearTown(file, pack, town, limits.first_town_bytes, &cutter);
  for_avatars([&](int a, const PackAvatar&) { cutter.Add(file.RangesOfAtlas(a, kCoarsestAtlasLevel)); });
  cutter.EndOfFirst();
  for (int mesh : town) {
    cutter.Add(file.RangesOfMesh(mesh));
    for (int image : ImagesOf(mesh, pack)) cutter.Add(file.RangesOfImage(image));
  }
  for (size_t k = 0; k < pack.images.size(); ++k) cutter.Add(file.RangesOfImage(static_cast<int>(k)));
  size_t most = 0;
  for_avatars([&](int, const PackAvatar& avatar) {
    most = std::max(most, avatar.levels.size());
    cutter.Add(file.RangesOfMesh(avatar.levels.back().mesh));
    for (const PackProp& prop : avatar.props) cutter.Add(file.RangesOfMesh(prop.mesh));
  });
  cutter.Add(pack.sound_ranges);
  cutter.Add(pack.picture_ranges);
  for_avatars([&](int a, const PackAvatar&) { cutter.Add(file.RangesOfAtlas(a)); });
  for (size_t from_coarsest = 1; from_coarsest < most; ++from_coarsest) {
    for_avatars([&](int, const PackAvatar& avatar) {
      const size_t levels = avatar.levels.size();
      if (from_coarsest < levels) cutter.Add(file.RangesOfMesh(avatar.levels[levels - 1 - from_coarsest].mesh));
    });
  }
  return cutter.Finish();
}

}  // namespace flaneur
