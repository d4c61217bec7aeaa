#include "runtime/visit/loading.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "runtime/base/clock.h"
#include "runtime/show/guide_figure.h"
#include "runtime/render/surface_plan.h"

namespace flaneur {
namespace {

// The pieces on their way are large and soon gone: what they took goes back to the system at once, not into the allocator's stock.
// Those that many pieces need for a moment (a mesh's tables take 4 MB) would cost more time in the system than their reading.
void KeepNoStock() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 6 * 1024 * 1024);
#endif
}
void GiveBackMemory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}
// What a picture needs for its duration stays for the next one.
void KeepForPictures() {
#ifdef __GLIBC__
  mallopt(M_TRIM_THRESHOLD, 8 * 1024 * 1024);
#endif
}

constexpr size_t kMostReady = 4;  // pieces that wait for their upload; faster threads wait too, for people's pictures take 10 MB each

// What a thread does at a time: reads one mesh of the town, or all of another asset.
struct Task { size_t asset = 0; int town_mesh = -1; };

}  // namespace

struct Loader::Impl {
  PackFile file;
  TourPack pack;                 // pieces are read into it, made ready, and taken out again
  std::vector<AssetId> assets;
  AssetStages stages;
  std::vector<Task> tasks;
  std::atomic<size_t> next_task{0}, town_meshes_left{0}, threads_left{0};
  std::atomic<bool> stop{false};
  std::vector<std::thread> threads;

  std::mutex mutex;
  std::condition_variable changed;
  bool may_prepare = false, may_go_on = false;
  SurfacePlan plan;              // of the renderer
  AtlasFormats formats;
  std::deque<Asset> ready;
  Error error;

  std::vector<bool> uploaded;    // by asset; only of the thread with the context
  size_t uploads = 0;

  void Run();
  void Give(Error e);
  Error Read(const Task& task);
  Error ReadMesh(int mesh);
  Error ReadLevel(const AssetId& id);
  void Clear(const AssetId& id);
  bool WaitUntil(const bool& may);
  bool WaitForRoom();
  void Prepare(size_t asset);
  bool AreUploaded(size_t first_assets) const;
};

Error Loader::Impl::ReadMesh(int mesh) { return file.ReadMesh(mesh, &pack.meshes[static_cast<size_t>(mesh)]); }

// The guide's figure is made of the meshes of whom it is like, which come from the file as often as they are needed.
Error Loader::Impl::ReadLevel(const AssetId& id) {
  const PackAvatar& avatar = pack.avatars[static_cast<size_t>(id.index)];
  const auto level = static_cast<size_t>(id.level);
  if (avatar.impostor_of < 0) return ReadMesh(MeshesOf(id, pack).front());
  const PackAvatar& like = pack.avatars[static_cast<size_t>(avatar.impostor_of)];
  PackMesh mesh, finest;
  if (Error e = file.ReadMesh(like.levels[level].mesh, &mesh)) return e;
  if (Error e = file.ReadMesh(like.levels.front().mesh, &finest)) return e;
  pack.meshes[static_cast<size_t>(avatar.levels[level].mesh)] = GuideMesh(std::move(mesh), finest, avatar.height_m);
  return Ok();
}

Error Loader::Impl::Read(const Task& task) {
  const AssetId& id = assets[task.asset];
  const auto index = static_cast<size_t>(id.index);
  switch (id.kind) {
    case AssetKind::kTown: return task.town_mesh >= 0 ? ReadMesh(task.town_mesh) : Ok();
    case AssetKind::kPicture: return file.ReadImage(id.index, &pack.images[index]);
    case AssetKind::kLevel: return ReadLevel(id);
    case AssetKind::kAtlas: return file.ReadAtlas(id.index, &pack.avatars[index].impostor);
  }
  return Ok();
}

void Loader::Impl::Clear(const AssetId& id) {
  const auto index = static_cast<size_t>(id.index);
  for (int mesh : MeshesOf(id, pack)) {
    for (PackPrimitive& p : pack.meshes[static_cast<size_t>(mesh)].primitives) {
      const int material = p.material;
      p = {};
      p.material = material;
    }
  }
  if (id.kind == AssetKind::kPicture) std::vector<uint8_t>().swap(pack.images[index].rgba);
  if (id.kind == AssetKind::kAtlas) {
    PackImpostor& atlas = pack.avatars[index].impostor;
    for (PackTexture* picture : {&atlas.albedo, &atlas.normal, &atlas.depth, &atlas.motion}) picture->levels.clear();
  }
}

// `may`: guarded by the mutex. False where there is nothing to wait for any more.
bool Loader::Impl::WaitUntil(const bool& may) {
  std::unique_lock lock(mutex);
  changed.wait(lock, [&] { return may || stop; });
  return !stop;
}

bool Loader::Impl::WaitForRoom() {
  std::unique_lock lock(mutex);
  changed.wait(lock, [&] { return ready.size() < kMostReady || stop; });
  return !stop;
}

void Loader::Impl::Prepare(size_t index) {
  if (!WaitUntil(may_prepare) || !WaitForRoom()) return;
  Asset asset = PrepareAsset(pack, assets[index], plan, formats);
  Clear(assets[index]);
  const std::lock_guard lock(mutex);
  ready.push_back(std::move(asset));
  changed.notify_all();
}

void Loader::Impl::Run() {
  for (size_t t = next_task++; t < tasks.size() && !stop; t = next_task++) {
    const Task& task = tasks[t];
    if (task.asset >= stages.town && !WaitUntil(may_go_on)) break;
    try {
      if (Error e = Read(task)) return Give(std::move(e));
      const bool whole = assets[task.asset].kind != AssetKind::kTown || --town_meshes_left == 0;
      if (whole) Prepare(task.asset);
    } catch (const std::bad_alloc&) {
      return Give(Fail("there is not enough memory for this pack"));
    }
  }
  if (--threads_left > 0) return;
  file = PackFile();  // nobody reads any more
  GiveBackMemory();
}

void Loader::Impl::Give(Error e) {
  const std::lock_guard lock(mutex);
  if (!error) error = std::move(e);
  stop = true;
  changed.notify_all();
}

bool Loader::Impl::AreUploaded(size_t first_assets) const {
  return std::all_of(uploaded.begin(), uploaded.begin() + static_cast<std::ptrdiff_t>(first_assets), [](bool u) { return u; });
}

Loader::Loader() : impl_(std::make_unique<Impl>()) {}

Loader::~Loader() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->stop = true;
    impl_->changed.notify_all();
  }
  for (std::thread& thread : impl_->threads) thread.join();
}

void Loader::Start(PackFile file, const TourPack& pack) {
  KeepNoStock();
  Impl& l = *impl_;
  l.file = std::move(file);
  l.pack = pack;
  l.assets = AssetsOf(pack);
  l.stages = StagesOf(l.assets);
  l.uploaded.assign(l.assets.size(), false);
  for (size_t k = 0; k < l.assets.size(); ++k) {
    if (l.assets[k].kind != AssetKind::kTown) {
      l.tasks.push_back({k, -1});
      continue;
    }
    for (int mesh : MeshesOf(l.assets[k], pack)) l.tasks.push_back({k, mesh});
    if (l.tasks.empty()) l.tasks.push_back({k, -1});
    l.town_meshes_left = l.tasks.size();
  }
  const size_t threads = std::max(2u, std::thread::hardware_concurrency());
  l.threads_left = threads;
  for (size_t t = 0; t < threads; ++t) l.threads.emplace_back([&l] { l.Run(); });
}

void Loader::PrepareFor(const Renderer& renderer) {
  const std::lock_guard lock(impl_->mutex);
  impl_->plan = renderer.surfaces();
  impl_->formats = renderer.formats();
  impl_->may_prepare = true;
  impl_->changed.notify_all();
}

void Loader::GoOn() {
  const std::lock_guard lock(impl_->mutex);
  if (impl_->may_go_on) return;
  impl_->may_go_on = true;
  impl_->changed.notify_all();
}

Error Loader::Upload(double most_ms, Renderer* renderer) {
  Impl& l = *impl_;
  const double start_ms = Now_ms();
  do {
    Asset asset;
    {
      const std::lock_guard lock(l.mutex);
      if (l.error) return l.error;
      if (l.ready.empty()) return Ok();
      asset = std::move(l.ready.front());
      l.ready.pop_front();
      l.changed.notify_all();
    }
    const AssetId id = asset.id;
    renderer->Add(std::move(asset));
    for (size_t k = 0; k < l.assets.size(); ++k) {
      const AssetId& a = l.assets[k];
      if (a.kind != id.kind || a.index != id.index || a.level != id.level) continue;
      l.uploaded[k] = true;
      if (++l.uploads < l.assets.size()) continue;
      l.pack = TourPack();  // no thread reads it any more
      GiveBackMemory();
      KeepForPictures();
    }
  } while (Now_ms() - start_ms < most_ms);
  return Ok();
}

Error Loader::UploadAll(Renderer* renderer) {
  GoOn();
  while (!Done()) {
    if (Error e = Upload(1e9, renderer)) return e;
    std::unique_lock lock(impl_->mutex);
    impl_->changed.wait(lock, [&] { return !impl_->ready.empty() || impl_->error || Done(); });
  }
  return Ok();
}

bool Loader::TownIsThere() const { return impl_->AreUploaded(impl_->stages.town); }
bool Loader::LikenessesAreThere() const { return impl_->AreUploaded(impl_->stages.likenesses); }
bool Loader::Done() const { return impl_->uploads == impl_->assets.size(); }

}  // namespace flaneur
