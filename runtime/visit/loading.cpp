#include "runtime/visit/loading.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "runtime/base/array.h"
#include "runtime/base/clock.h"
#include "runtime/base/memory.h"
#include "runtime/render/surface_plan.h"
#include "runtime/render/town_geometry.h"
#include "runtime/show/guide_figure.h"
#include "runtime/visit/arriving.h"

namespace flaneur {
namespace {

// The pieces on their way are large and soon gone: what they took goes back to the system at once, not into the
// allocator's stock. Those that many pieces need for a moment (a mesh's tables take 4 MB) would cost more time in the
// system than their reading: a stock of some tens of them stays until all is read.
void KeepNoStock() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 6 * 1024 * 1024);
  mallopt(M_TRIM_THRESHOLD, 32 * 1024 * 1024);
#endif
}
void ReleaseMemory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}
// What a picture needs for its duration stays for the next one.
void KeepForPictures() {
#ifdef __GLIBC__
  mallopt(M_TRIM_THRESHOLD, 8 * 1024 * 1024);
#endif
  KeepNoLargeStock();
}

constexpr size_t kMaxReadyAssets =
    4;  // pieces that wait for their upload; faster threads wait too, for people's pictures take 10 MB each

constexpr size_t kUpload_bytes = 1 << 19;  // at a time, of which drivers take some in a millisecond

// What is read at a time: one mesh of the town, or all of another asset.
struct Task {
  size_t asset = 0;
  int town_mesh = -1;
};

// What a slice does: reads a task, or its meshes' next primitive, makes an asset ready that has been read, or goes on
// with what is built in steps.
struct Piece {
  enum Kind { kRead, kReadOn, kPrepare, kBuild } kind = kRead;
  size_t index = 0;  // of tasks, of assets
};

// The meshes of a task, of which some primitives have been read.
struct MeshReading {
  size_t task = 0;
  std::vector<int> meshes;     // of the pack
  std::vector<PackMesh> read;  // the last may lack some
};

}  // namespace

struct Loader::Impl {
  PackFile file;
  // PartsForAssets: pieces are read into it, made ready, and taken out again. Each of its meshes, images and atlases is
  // of one asset alone: several people may show one mesh, and threads read them side by side.
  TourPack pack;
  std::vector<PackMesh> of_people;  // by asset
  std::vector<AssetId> assets;
  AssetStages stages;
  bool town_comes_twice = false;  // first what is there of it at the beginning
  std::vector<Task> tasks;
  Jobs* jobs = nullptr;
  size_t most_readers = 0;  // that there is a thread for

  std::mutex mutex;
  std::condition_variable changed;
  size_t next_task = 0, unread_tasks = 0, readers = 0;
  std::vector<size_t> parts_left;  // by asset: of its tasks
  bool looks_for_pieces = false;   // some may have arrived since there was none
  size_t asked_tasks = 0;          // so many of the tasks may be done before GoOn
  size_t in_hand = 0;              // assets but the town that are being read or wait for their upload
  bool may_prepare = false, may_go_on = false, stop = false;
  SurfacePlan plan;  // of the renderer
  AtlasFormats formats;
  std::deque<size_t> read;                    // assets
  std::optional<MeshReading> mesh_reading;    // without threads meshes are read a primitive at a time,
  std::optional<TownBuilder> town_builder;    // the town is built between pictures,
  std::optional<LayerBuilder> layer_builder;  // and pictures are made ready in steps,
  std::optional<AtlasBuilder> atlas_builder;  // as impostors are
  size_t builds = 0;                          // of assets
  std::deque<Asset> ready;
  Error error;

  std::vector<bool> uploaded;      // by asset; only of the thread with the context, as what follows
  std::optional<Asset> uploading;  // a part of it is there
  size_t uploads = 0;
  std::vector<Job> reading;  // last, so that it ends first: it uses the rest

  void AddTasks(const TourPack& whole);
  void GoOnReading(size_t most_more);
  bool ReadHere();
  bool DoPiece();
  std::optional<Piece> NextPiece();
  bool FindTask();
  void Do(const Piece& piece);
  void StopWithError(Error e);
  bool HasThreads() const { return jobs != nullptr && jobs->threads() > 0; }
  std::vector<int> MeshesToRead(const Task& task) const;
  Error ReadNextPrimitive(MeshReading* m, bool* was_last) const;
  void TakeMeshes(MeshReading done);
  Error Read(size_t task);
  Error ReadOn();
  void NoteRead(size_t task);
  void Clear(size_t asset);
  void Prepare(size_t asset);
  void Build(size_t asset);
  void TakeIn(size_t asset, Asset made);
  bool TakeReady(Asset* asset);
  void NoteUploaded(const AssetId& id);
  bool AreUploaded(size_t first_assets) const;
  void Ask(const std::vector<bool>& needed);  // by asset
  Error UploadUntil(const std::function<bool()>& is_there, Loader* loader, Renderer* renderer);
};

// The guide's figure is made of the meshes of whom it is like, which come from the file as often as they are needed.
std::vector<int> Loader::Impl::MeshesToRead(const Task& task) const {
  const AssetId& id = assets[task.asset];
  if (task.town_mesh >= 0) return {task.town_mesh};
  if (id.kind != AssetKind::kLevel) return {};
  const PackAvatar& avatar = At(pack.avatars, id.index);
  if (avatar.impostor_of < 0) return {MeshesOf(id, pack).front()};
  const PackAvatar& like = At(pack.avatars, avatar.impostor_of);
  return {At(like.levels, id.level).mesh, like.levels.front().mesh};
}

Error Loader::Impl::ReadNextPrimitive(MeshReading* m, bool* was_last) const {
  const auto primitives = [&](size_t k) { return At(pack.meshes, m->meshes[k]).primitives.size(); };
  if (m->read.empty()) m->read.emplace_back();
  size_t k = m->read.size() - 1;
  std::vector<PackPrimitive>& there = m->read.back().primitives;
  if (there.size() < primitives(k)) {
    const size_t next = there.size();
    if (Error e = file.ReadPrimitive(m->meshes[k], next, &there.emplace_back())) return e;
  }
  if (there.size() < primitives(k)) return Ok();
  *was_last = ++k == m->meshes.size();
  if (!*was_last) m->read.emplace_back();
  return Ok();
}

void Loader::Impl::TakeMeshes(MeshReading done) {
  const Task& task = tasks[done.task];
  PackMesh& mesh = done.read.front();
  if (task.town_mesh >= 0) {
    At(pack.meshes, task.town_mesh) = std::move(mesh);
    return;
  }
  const PackAvatar& avatar = At(pack.avatars, assets[task.asset].index);
  of_people[task.asset] =
      avatar.impostor_of < 0 ? std::move(mesh) : GuideMesh(std::move(mesh), done.read.back(), avatar);
}

// With threads all of it; else of meshes the beginning.
Error Loader::Impl::Read(size_t task) {
  const AssetId& id = assets[tasks[task].asset];
  if (std::vector<int> meshes = MeshesToRead(tasks[task]); !meshes.empty()) {
    MeshReading m{task, std::move(meshes), {}};
    if (!HasThreads()) {
      mesh_reading = std::move(m);
      return ReadOn();
    }
    for (bool was_last = false; !was_last;) {
      if (Error e = ReadNextPrimitive(&m, &was_last)) return e;
    }
    TakeMeshes(std::move(m));
  } else if (id.kind == AssetKind::kPicture) {
    if (Error e = file.ReadImage(id.index, &At(pack.images, id.index))) return e;
  } else if (id.kind == AssetKind::kAtlas) {
    if (Error e = file.ReadAtlas(id.index, &At(pack.avatars, id.index).impostor)) return e;
  }
  NoteRead(task);
  return Ok();
}

Error Loader::Impl::ReadOn() {
  bool was_last = false;
  if (Error e = ReadNextPrimitive(&*mesh_reading, &was_last)) return e;
  if (!was_last) return Ok();
  const size_t task = mesh_reading->task;
  TakeMeshes(*std::exchange(mesh_reading, {}));
  NoteRead(task);
  return Ok();
}

void Loader::Impl::NoteRead(size_t task) {
  bool last = false;
  {
    const std::lock_guard lock(mutex);
    last = --unread_tasks == 0;
    const size_t asset = tasks[task].asset;
    if (--parts_left[asset] == 0) read.push_back(asset);
  }
  if (!last) return;
  file = PackFile();  // nobody reads any more
  ReleaseMemory();
}

void Loader::Impl::Clear(size_t asset) {
  const AssetId& id = assets[asset];
  const auto index = static_cast<size_t>(id.index);
  if (id.kind == AssetKind::kLevel) of_people[asset] = {};
  if (id.kind == AssetKind::kTown) {
    for (int mesh : MeshesOf(id, pack)) {
      for (PackPrimitive& p : pack.meshes[static_cast<size_t>(mesh)].primitives) {
        const int material = p.material;
        p = {};
        p.material = material;
      }
    }
  }
  if (id.kind == AssetKind::kPicture) std::vector<uint8_t>().swap(pack.images[index].rgba);
  if (id.kind == AssetKind::kAtlas) {
    PackImpostor& atlas = pack.avatars[index].impostor;
    for (PackTexture* picture : {&atlas.albedo, &atlas.normal, &atlas.depth, &atlas.motion, &atlas.tints})
      picture->levels.clear();
  }
}

void Loader::Impl::Prepare(size_t index) {
  const AssetId& id = assets[index];
  if (!HasThreads()) {
    builds = index;
    if (id.kind == AssetKind::kTown) return void(town_builder.emplace(pack, plan));
    if (id.kind == AssetKind::kAtlas)
      return void(atlas_builder.emplace(pack.avatars[static_cast<size_t>(id.index)].impostor, formats));
    const int array = id.kind == AssetKind::kPicture ? plan.pictures[static_cast<size_t>(id.index)].array : -1;
    if (array >= 0)
      return void(
          layer_builder.emplace(pack.images[static_cast<size_t>(id.index)], plan.arrays[static_cast<size_t>(array)]));
  }
  TakeIn(index, id.kind == AssetKind::kLevel ? PrepareLevel(pack, id, of_people[index], plan)
                                             : PrepareAsset(pack, id, plan, formats));
}

void Loader::Impl::Build(size_t index) {
  if (layer_builder) {
    if (!layer_builder->Advance()) return;
    Asset asset = PreparePicture(assets[index], layer_builder->Take());
    layer_builder.reset();
    return TakeIn(index, std::move(asset));
  }
  if (atlas_builder) {
    if (!atlas_builder->Advance()) return;
    Asset asset = PrepareAtlas(assets[index], atlas_builder->Take());
    atlas_builder.reset();
    return TakeIn(index, std::move(asset));
  }
  if (!town_builder->Advance()) return;
  TownGeometry geometry = town_builder->Take();
  town_builder.reset();
  TakeIn(index, PrepareTown(pack, assets[index], std::move(geometry)));
}

void Loader::Impl::TakeIn(size_t index, Asset asset) {
  const bool again = town_comes_twice && assets[index].kind == AssetKind::kTown && assets[index].index != kWholeTown;
  if (!again) Clear(index);
  const std::lock_guard lock(mutex);
  ready.push_back(std::move(asset));
  changed.notify_all();
}

// What may be done now; guarded. Nothing: until the renderer, the first picture or the upload has come further, or
// ever.
std::optional<Piece> Loader::Impl::NextPiece() {
  if (stop) return {};
  if (mesh_reading) return Piece{Piece::kReadOn, mesh_reading->task};
  if (town_builder || layer_builder || atlas_builder) return Piece{Piece::kBuild, builds};
  if (!read.empty() && may_prepare && ready.size() < kMaxReadyAssets) {
    const size_t asset = read.front();
    read.pop_front();
    return Piece{Piece::kPrepare, asset};
  }
  if (next_task == tasks.size() || !FindTask()) return {};
  const Task& task = tasks[next_task];
  const bool of_town = assets[task.asset].kind == AssetKind::kTown;
  if (next_task >= asked_tasks && !may_go_on) return {};
  if (!of_town && in_hand >= kMaxReadyAssets + most_readers) return {};
  in_hand += of_town ? 0 : 1;
  return Piece{Piece::kRead, next_task++};
}

// Puts what is there before what is not.
bool Loader::Impl::FindTask() {
  if (file.IsWhole()) return true;
  if (!looks_for_pieces) return false;
  const auto is_there = [&](const Task& task) {
    return task.town_mesh >= 0 ? flaneur::IsThere(task.town_mesh, file)
                               : assets[task.asset].kind == AssetKind::kTown || IsThere(assets[task.asset], file, pack);
  };
  const auto next = tasks.begin() + static_cast<std::ptrdiff_t>(next_task);
  const auto found = std::find_if(next, tasks.end(), is_there);
  looks_for_pieces = found != tasks.end();
  if (!looks_for_pieces) return false;
  std::rotate(next, found, found + 1);
  return true;
}

void Loader::Impl::Do(const Piece& piece) {
  if (piece.kind == Piece::kPrepare) return Prepare(piece.index);
  if (piece.kind == Piece::kBuild) return Build(piece.index);
  if (Error e = piece.kind == Piece::kReadOn ? ReadOn() : Read(piece.index)) StopWithError(std::move(e));
}

// A slice of one of the readers, who end as soon as nothing may be done: true.
bool Loader::Impl::DoPiece() {
  std::optional<Piece> piece;
  {
    const std::lock_guard lock(mutex);
    piece = NextPiece();
    if (!piece) --readers;
  }
  if (!piece) return true;
  try {
    Do(*piece);
  } catch (const std::bad_alloc&) {
    StopWithError(Fail("there is not enough memory for this pack"));
  } catch (const std::exception& e) {
    StopWithError(Fail(std::string("this pack cannot be read: ") + e.what()));
  }
  return false;
}

// Whenever more may be done than before: by so many more readers, as far as there are threads for them.
void Loader::Impl::GoOnReading(size_t most_more) {
  std::erase_if(reading, [](const Job& job) { return job.Done(); });
  size_t more = 0;
  {
    const std::lock_guard lock(mutex);
    if (stop || (read.empty() && next_task == tasks.size() && !mesh_reading)) return;
    more = std::min(most_more, most_readers - readers);
    readers += more;
  }
  for (; more > 0; --more)
    reading.push_back(StartJob(
        jobs, [this] { return DoPiece(); }, Urgency::kMeanwhile));
}

// Without threads: does the next piece. False: none may be done, or threads do it.
bool Loader::Impl::ReadHere() {
  if (HasThreads()) return false;
  GoOnReading(1);
  if (reading.empty()) return false;
  reading.front().Advance();
  return !reading.front().Done();
}

void Loader::Impl::StopWithError(Error e) {
  const std::lock_guard lock(mutex);
  if (!error) error = std::move(e);
  stop = true;
  changed.notify_all();
}

bool Loader::Impl::AreUploaded(size_t first_assets) const {
  return std::all_of(uploaded.begin(), uploaded.begin() + static_cast<std::ptrdiff_t>(first_assets),
                     [](bool u) { return u; });
}

Loader::Loader(Jobs* jobs) : impl_(std::make_unique<Impl>()) {
  impl_->jobs = jobs;
  impl_->most_readers = std::max<size_t>(1, jobs != nullptr ? jobs->threads() : 0);
}

Loader::~Loader() {
  const std::lock_guard lock(impl_->mutex);
  impl_->stop = true;
}

void Loader::Impl::AddTasks(const TourPack& whole) {
  const bool twice = std::any_of(assets.begin(), assets.end(),
                                 [](const AssetId& a) { return a.kind == AssetKind::kTown && a.index == kWholeTown; });
  for (size_t k = 0; k < assets.size(); ++k) {
    const size_t before = tasks.size();
    if (assets[k].kind == AssetKind::kTown) {
      for (int mesh : MeshesOf(assets[k], whole)) {
        const bool first = !twice || flaneur::IsThere(mesh, file);
        if (first == (assets[k].index != kWholeTown)) tasks.push_back({k, mesh});
      }
    }
    if (tasks.size() == before) tasks.push_back({k, -1});
    parts_left.push_back(tasks.size() - before);
  }
  town_comes_twice = twice;
}

void Loader::Start(PackFile file, const TourPack& pack) {
  KeepNoStock();
  Impl& l = *impl_;
  l.file = std::move(file);
  l.pack = PartsForAssets(pack);
  if (l.file.IsWhole()) {
    l.assets = AssetsOf(pack);
    l.stages = StagesOf(l.assets);
  } else {
    l.assets = AssetsWhileArriving(l.file, pack, &l.stages);
    l.looks_for_pieces = true;
  }
  l.uploaded.assign(l.assets.size(), false);
  l.of_people.resize(l.assets.size());
  l.AddTasks(pack);
  l.unread_tasks = l.tasks.size();
  while (l.asked_tasks < l.tasks.size() && l.tasks[l.asked_tasks].asset < l.stages.town) ++l.asked_tasks;
  l.GoOnReading(l.most_readers);
}

Error Loader::Arrive(size_t offset, std::span<const uint8_t> bytes) {
  if (Error e = impl_->file.Arrive(offset, bytes)) return e;
  impl_->looks_for_pieces = true;
  return Ok();
}

void Loader::PrepareFor(const Renderer& renderer) {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->plan = renderer.surfaces();
    impl_->formats = renderer.formats();
    impl_->may_prepare = true;
  }
  impl_->GoOnReading(impl_->most_readers);
}

void Loader::GoOn() {
  {
    const std::lock_guard lock(impl_->mutex);
    if (impl_->may_go_on) return;
    impl_->may_go_on = true;
  }
  impl_->GoOnReading(impl_->most_readers);
}

bool Loader::Impl::TakeReady(Asset* asset) {
  const std::lock_guard lock(mutex);
  if (error || ready.empty()) return false;
  *asset = std::move(ready.front());
  ready.pop_front();
  in_hand -= asset->id.kind == AssetKind::kTown ? 0 : 1;
  return true;
}

void Loader::Impl::NoteUploaded(const AssetId& id) {
  for (size_t k = 0; k < assets.size(); ++k) {
    const AssetId& a = assets[k];
    if (a.kind != id.kind || a.index != id.index || a.level != id.level) continue;
    uploaded[k] = true;
    if (++uploads < assets.size()) continue;
    pack = TourPack();  // nobody reads it any more
    ReleaseMemory();
    KeepForPictures();
  }
}

Error Loader::Upload(double most_ms, Renderer* renderer) {
  Impl& l = *impl_;
  const double start_ms = Now_ms();
  do {
    Asset asset;
    if (!l.uploading && l.TakeReady(&asset)) {
      l.GoOnReading(1);
      l.uploading = std::move(asset);
    }
    if (l.uploading) {
      if (!renderer->Add(kUpload_bytes, &*l.uploading)) continue;
      const AssetId id = l.uploading->id;
      l.uploading.reset();
      l.NoteUploaded(id);
    } else if (!l.ReadHere()) {
      break;
    }
  } while (Now_ms() - start_ms < most_ms);
  const std::lock_guard lock(l.mutex);
  return l.error;
}

Error Loader::ReadOn(double most_ms) {
  const double start_ms = Now_ms();
  while (impl_->ReadHere() && Now_ms() - start_ms < most_ms) {}
  const std::lock_guard lock(impl_->mutex);
  return impl_->error;
}

Error Loader::Impl::UploadUntil(const std::function<bool()>& is_there, Loader* loader, Renderer* renderer) {
  while (!is_there()) {
    if (Error e = loader->Upload(1e9, renderer)) return e;
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return !ready.empty() || error || is_there(); });
  }
  return Ok();
}

// All pictures: nobody is drawn as a mesh before they are there.
void Loader::Impl::Ask(const std::vector<bool>& needed) {
  {
    const std::lock_guard lock(mutex);
    const auto asked = [&](const Task& task) { return needed[task.asset] && !uploaded[task.asset]; };
    const auto from = tasks.begin() + static_cast<std::ptrdiff_t>(std::max(next_task, asked_tasks));
    asked_tasks = static_cast<size_t>(std::stable_partition(from, tasks.end(), asked) - tasks.begin());
  }
  GoOnReading(most_readers);
}

Error Loader::UploadAll(Renderer* renderer) {
  GoOn();
  return impl_->UploadUntil([this] { return Done(); }, this, renderer);
}

Error Loader::UploadThese(const std::vector<AssetId>& ids, Renderer* renderer) {
  Impl& l = *impl_;
  std::vector<bool> needed(l.assets.size());
  for (size_t k = 0; k < l.assets.size(); ++k) {
    needed[k] = l.assets[k].kind == AssetKind::kPicture || std::find(ids.begin(), ids.end(), l.assets[k]) != ids.end();
  }
  l.Ask(needed);
  const auto are_there = [&] {
    for (size_t k = 0; k < needed.size(); ++k) {
      if (needed[k] && !l.uploaded[k]) return false;
    }
    return TownIsThere();
  };
  return l.UploadUntil(are_there, this, renderer);
}

bool Loader::TownIsThere() const { return impl_->AreUploaded(impl_->stages.town); }
float Loader::ShareOfLikenesses() const {
  const size_t all = impl_->stages.likenesses;
  const auto there =
      std::count(impl_->uploaded.begin(), impl_->uploaded.begin() + static_cast<std::ptrdiff_t>(all), true);
  return all > 0 ? static_cast<float>(there) / static_cast<float>(all) : 1;
}
bool Loader::LikenessesAreThere() const { return impl_->AreUploaded(impl_->stages.likenesses); }
bool Loader::Done() const { return impl_->uploads == impl_->assets.size(); }

}  // namespace flaneur
