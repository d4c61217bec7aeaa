#include <algorithm>

#include "runtime/base/array.h"
#include "runtime/base/file.h"
#include "runtime/base/limits.h"
#include "runtime/base/text.h"
#include "runtime/pack/allowance.h"
#include "runtime/pack/gltf_file.h"
#include "runtime/pack/ktx2.h"
#include "runtime/pack/mesh_table.h"
#include "runtime/pack/reach.h"
#include "runtime/pack/read_avatar.h"
#include "runtime/pack/read_impostor.h"
#include "runtime/pack/read_material.h"
#include "runtime/pack/read_mesh.h"
#include "runtime/pack/read_tour.h"
#include "runtime/pack/read_town.h"
#include "runtime/pack/tour_object.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {
namespace {

// The materials alone.
PackMesh ReadOutline(const GltfFile& file, int mesh) {
  PackMesh out;
  for (const Json& json : Member(Element(file.json, "meshes", mesh), "primitives")) {
    PackPrimitive primitive;
    primitive.material = IndexOrNone(json, "material", Member(file.json, "materials").size());
    out.primitives.push_back(std::move(primitive));
  }
  return out;
}

TourObject TourOf(const GltfFile& file) {
  const auto extensions = file.json.find("extensions");
  if (extensions == file.json.end() || !extensions->contains(kTourExtension)) {
    throw PackRefused(std::string("is a glTF binary but no tour pack: it has no ") + kTourExtension +
                      "; make one with 'flaneur bake'");
  }
  return TourObject((*extensions)[kTourExtension], kTourExtension);
}

void CheckVersion(const TourObject& tour) {
  const int version = tour.Whole("version", 0, 1e9);
  if (version >= kOldestTourPackVersion && version <= kTourPackVersion) return;
  throw PackRefused("is a tour pack of version " + std::to_string(version) + ", this player reads version " +
                    std::to_string(kTourPackVersion) +
                    (version > kTourPackVersion ? "; use a newer player" : "; bake the tour again"));
}

}  // namespace

struct PackFile::Impl {
  GltfFile file;
  std::string name;
  std::vector<int> meshes;            // of the file, by mesh of the pack
  std::vector<TourObject> impostors;  // by avatar
  std::vector<PackImpostor> atlases;  // their sizes
  std::vector<int> joints;            // by mesh; 0: of the town

  PackMesh Mesh(size_t mesh) const {
    PackMesh read = flaneur::ReadMesh(file, meshes[mesh]);
    for (const PackPrimitive& primitive : read.primitives) CheckJointsOf(mesh, primitive);
    return read;
  }

  void CheckJointsOf(size_t mesh, const PackPrimitive& primitive) const {
    if (joints[mesh] > 0) CheckJoints(primitive, joints[mesh]);
  }

  void TakeReach(const PackAvatar& avatar, int mesh) const {
    constexpr uint64_t kVertexWork = 8;
    const auto frames = static_cast<uint64_t>(avatar.walk.frames + avatar.idle.frames + avatar.talk.frames);
    file.allowance->TakeWork(Product(SizeOfMesh(file, At(meshes, mesh)).vertices, frames * kVertexWork), "a prop");
  }

  // Packs of before do not say it.
  void FindReach(PackAvatar* avatar) const {
    const bool said = avatar->reach_m > 0;
    avatar->reach_m = std::max(avatar->reach_m, avatar->radius_m);
    if (said) return;
    avatar->reach_m = std::max(avatar->reach_m, std::min(kMostReach_m, ReachOfPictures_m(avatar->impostor)));
    for (const PackProp& prop : avatar->props) {
      TakeReach(*avatar, prop.mesh);
      const PackMesh mesh = Mesh(static_cast<size_t>(prop.mesh));
      for (const PackClip* clip : {&avatar->walk, &avatar->idle, &avatar->talk})
        avatar->reach_m = std::max(avatar->reach_m, std::min(kMostReach_m, PosedReach_m(mesh, *clip, avatar->joints)));
    }
  }

  void Read(TourPack* pack) {
    const TourObject tour = TourOf(file);
    CheckVersion(tour);
    ReadTour(file, tour, pack);
    pack->ground = Share(ReadGround(file, tour.Object("ground")));
    for (size_t m = 0; m < CountOf(file.json, "materials"); ++m)
      pack->materials.push_back(ReadMaterial(file, file.json["materials"][m]));
    MeshTable table;
    ReadTown(file, &table, pack);
    for (const TourObject& a : tour.Objects("avatars", kMostAvatars)) {
      pack->avatars.push_back(ReadAvatar(file, a, &table));
      impostors.push_back(a.Object("impostor"));
      atlases.push_back(pack->avatars.back().impostor);
    }
    if (pack->avatars.empty()) tour.Refuse("has no avatars");
    const auto has_share = [](const PackAvatar& a) { return a.share > 0; };
    if (std::none_of(pack->avatars.begin(), pack->avatars.end(), has_share))
      tour.Refuse("has no avatar with a share above 0: nobody could live there");
    const auto is_guide = [&](const PackAvatar& a) { return a.name == pack->guide; };
    if (!pack->guide.empty() && std::none_of(pack->avatars.begin(), pack->avatars.end(), is_guide)) {
      tour.Refuse("has a guide '" + pack->guide + "' who is none of its avatars");
    }
    meshes = table.used();
    TakeBulk(*pack);
    joints.resize(meshes.size());
    for (int mesh : meshes) pack->meshes.push_back(ReadOutline(file, mesh));
    for (const PackAvatar& avatar : pack->avatars) {
      for (const PackLevel& level : avatar.levels) At(joints, level.mesh) = avatar.joints;
      for (const PackProp& prop : avatar.props) At(joints, prop.mesh) = avatar.joints;
      BindTints(avatar, pack->meshes, file.allowance, &pack->materials);
    }
    for (PackAvatar& avatar : pack->avatars) {
      FindReach(&avatar);
      avatar.reach_m =
          std::min(kMostReach_m, avatar.reach_m * (1 + avatar.height_spread) * (1 + avatar.breadth_spread));
    }
    for (size_t i = 0; i < CountOf(file.json, "images"); ++i) {
      pack->images.push_back(ReadImageSize(file, static_cast<int>(i)));
      const PackImage& image = pack->images.back();
      file.allowance->TakePicture(image.width_px, image.height_px, NameOf(file, static_cast<int>(i)));
    }
  }

  // A mesh that is read for each who shows it, and drawn as often.
  void TakeMesh(int mesh) {
    const MeshSize size = SizeOfMesh(file, At(meshes, mesh));
    const std::string what = "mesh " + std::to_string(At(meshes, mesh));
    constexpr uint64_t kVertex_bytes = 64, kIndex_bytes = 4, kVertexWork = 20, kIndexWork = 5;
    file.allowance->TakeMemory(Product(size.vertices, kVertex_bytes) + Product(size.indices, kIndex_bytes), what);
    file.allowance->TakeWork(Product(size.vertices, kVertexWork) + Product(size.indices, kIndexWork) + size.primitives,
                             what);
  }

  // What will be read and drawn later: who shares something has it all the same.
  void TakeBulk(const TourPack& pack) {
    for (const TownInstance& instance : pack.town) TakeMesh(instance.mesh);
    for (size_t a = 0; a < pack.avatars.size(); ++a) {
      for (const PackLevel& level : pack.avatars[a].levels) TakeMesh(level.mesh);
      for (const PackProp& prop : pack.avatars[a].props) TakeMesh(prop.mesh);
      for (const AtlasView& view : kAtlasViews) {
        if (!impostors[a].Has(view.name)) continue;
        const int index = impostors[a].View(view.name, CountOf(file.json, "bufferViews"));
        const uint64_t bytes =
            std::max<uint64_t>(RangeOfView(file, index).bytes, Ktx2BytesInMemory(BeginningOfView(file, index)));
        file.allowance->TakeMemory(bytes, std::string("an impostor's ") + view.name);
      }
    }
  }
};

namespace {

Error Caught(const std::string& name, auto read) {
  try {
    read();
    return Ok();
  } catch (const std::bad_alloc&) {
    return Fail(name + ": there is not enough memory for it");
  } catch (const std::exception& e) {
    return Fail(name + ": " + OneLine(Complaint(e)));
  }
}

}  // namespace

PackFile::PackFile() = default;
PackFile::PackFile(PackFile&&) noexcept = default;
PackFile& PackFile::operator=(PackFile&&) noexcept = default;
PackFile::~PackFile() = default;

Error PackFile::Open(const std::filesystem::path& path, TourPack* pack, const PackLimits& limits) {
  FileBytes bytes;
  if (Error e = ReadFile(path, &bytes)) return e;
  return Open(std::move(bytes), path.string(), pack, limits);
}

Error PackFile::Open(FileBytes bytes, const std::string& name, TourPack* pack, const PackLimits& limits) {
  return OpenPart(std::move(bytes), {}, name, pack, limits);
}

Error PackFile::Open(FileBytes bytes, ByteRanges there, const std::string& name, TourPack* pack) {
  if (there.Holds({0, bytes.size()})) return Open(std::move(bytes), name, pack);
  return OpenPart(std::move(bytes), std::move(there), name, pack, {});
}

Error PackFile::OpenPart(FileBytes bytes, std::optional<ByteRanges> there, const std::string& name, TourPack* pack,
                         const PackLimits& limits) {
  return Caught(name, [&] {
    auto impl = std::make_unique<Impl>();
    Allowance allowance(bytes.size(), limits);
    impl->file = OpenGltf(std::move(bytes), std::move(there), &allowance);
    impl->name = name;
    TourPack read;
    impl->Read(&read);
    impl->file.allowance = nullptr;
    impl_ = std::move(impl);
    *pack = std::move(read);
  });
}

Error PackFile::ReadImage(int image, PackImage* out) const {
  return Caught(impl_->name, [&] { *out = flaneur::ReadImage(impl_->file, image); });
}

Error PackFile::ReadMesh(int mesh, PackMesh* out) const {
  return Caught(impl_->name, [&] { *out = impl_->Mesh(static_cast<size_t>(mesh)); });
}

Error PackFile::ReadPrimitive(int mesh, size_t primitive, PackPrimitive* out) const {
  return Caught(impl_->name, [&] {
    PackPrimitive read = flaneur::ReadPrimitive(impl_->file, At(impl_->meshes, mesh), primitive);
    impl_->CheckJointsOf(static_cast<size_t>(mesh), read);
    *out = std::move(read);
  });
}

Error PackFile::ReadAtlas(int avatar, PackImpostor* out) const {
  return Caught(impl_->name, [&] {
    const auto index = static_cast<size_t>(avatar);
    PackImpostor read = impl_->atlases[index];
    flaneur::ReadAtlas(impl_->file, impl_->impostors[index], &read);
    *out = std::move(read);
  });
}

template <typename Collect>
std::vector<ByteRange> PackFile::Ranges(Collect collect) const {
  std::vector<ByteRange> ranges;
  if (!impl_ || Caught(impl_->name, [&] { collect(impl_->file, &ranges); })) ranges.clear();
  return ranges;
}

Error PackFile::Arrive(size_t offset, std::span<const uint8_t> bytes) {
  if (!impl_) return Ok();  // nobody reads any more
  const std::span<uint8_t> all = impl_->file.bytes.span();
  if (offset > all.size() || bytes.size() > all.size() - offset)
    return Fail(impl_->name + ": has a piece beyond its end");
  std::optional<ByteRanges>& there = impl_->file.there;
  if (!there) return Ok();
  std::copy(bytes.begin(), bytes.end(), all.begin() + static_cast<std::ptrdiff_t>(offset));
  there->Add({offset, bytes.size()});
  if (there->Holds({0, all.size()})) there.reset();
  return Ok();
}

bool PackFile::IsWhole() const { return !impl_ || !impl_->file.there; }

bool PackFile::Holds(const std::vector<ByteRange>& ranges) const {
  return IsWhole() || std::all_of(ranges.begin(), ranges.end(),
                                  [&](const ByteRange& range) { return impl_->file.there->Holds(range); });
}

std::vector<ByteRange> PackFile::RangesOfImage(int image) const {
  return Ranges([&](const GltfFile& file, std::vector<ByteRange>* ranges) {
    ranges->push_back(RangeOfView(file, ImageView(file, image)));
  });
}

std::vector<ByteRange> PackFile::RangesOfMesh(int mesh) const {
  return Ranges([&](const GltfFile& file, std::vector<ByteRange>* ranges) {
    for (int view : ViewsOfMesh(file, At(impl_->meshes, mesh))) ranges->push_back(RangeOfView(file, view));
  });
}

std::vector<ByteRange> PackFile::RangesOfAtlas(int avatar, int finest_level) const {
  return Ranges([&](const GltfFile& file, std::vector<ByteRange>* ranges) {
    const TourObject& json = At(impl_->impostors, avatar);
    const size_t views = Member(file.json, "bufferViews").size();
    const int width_px = At(impl_->atlases, avatar).width_px;
    for (const AtlasView& view : kAtlasViews) {
      if (!json.Has(view.name)) continue;
      const int index = json.View(view.name, views);
      ByteRange range = RangeOfView(file, index);
      if (finest_level > 0)
        range.bytes =
            Ktx2BytesOfWidth(BeginningOfView(file, index), range.bytes, width_px >> (view.halved + finest_level));
      ranges->push_back(range);
    }
  });
}

Error LoadTourPack(const std::filesystem::path& path, const LoadOptions& options, TourPack* pack) {
  FileBytes bytes;
  if (Error e = ReadFile(path, &bytes)) return e;
  return ParseTourPack(std::move(bytes), path.string(), options, pack);
}

Error ParseTourPack(FileBytes bytes, const std::string& name, const LoadOptions& options, TourPack* pack) {
  PackFile file;
  TourPack loaded;
  if (Error e = file.Open(std::move(bytes), name, &loaded, options.limits)) return e;
  if (options.geometry_and_images) {
    const size_t images = loaded.images.size(), meshes = loaded.meshes.size(),
                 count = images + meshes + loaded.avatars.size();
    std::vector<Error> errors(count);
    ParallelFor(options.jobs, count, [&](size_t i) {
      if (i < images) errors[i] = file.ReadImage(static_cast<int>(i), &loaded.images[i]);
      else if (i < images + meshes) errors[i] = file.ReadMesh(static_cast<int>(i - images), &loaded.meshes[i - images]);
      else
        errors[i] =
            file.ReadAtlas(static_cast<int>(i - images - meshes), &loaded.avatars[i - images - meshes].impostor);
    });
    for (const Error& e : errors) {
      if (e) return e;
    }
  }
  *pack = std::move(loaded);
  return Ok();
}

}  // namespace flaneur
