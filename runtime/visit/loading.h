// Reads the bulk of a pack beside everything else, while the tour is set up and already plays.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/base/jobs.h"
#include "runtime/pack/tour_pack.h"
#include "runtime/render/renderer.h"

namespace flaneur {

class Loader {
 public:
  // `jobs` outlives it. Without threads Upload reads too: a whole piece at a time.
  explicit Loader(Jobs* jobs = nullptr);
  ~Loader();  // leaves what has not been read

  // `pack`: of this file, without its bulk; AddGuideFigure may have added to it.
  void Start(PackFile file, const TourPack& pack);
  // More of a file that was opened in pieces; what can be read now is. In the thread that uploads, and without threads.
  // Errors: those of PackFile::Arrive.
  Error Arrive(size_t offset, std::span<const uint8_t> bytes);
  // After the renderer has begun with the same pack: from now on pieces are made ready for it.
  void PrepareFor(const Renderer& renderer);

  // After the first picture: until then nothing is read that it does not show.
  void GoOn();

  // Hands over what is ready, for about `most_ms`. Errors: of a piece that cannot be read.
  Error Upload(double most_ms, Renderer* renderer);
  // Reads and makes ready, for about as long, and uploads nothing. Without threads; else they do.
  Error ReadOn(double most_ms);
  Error UploadAll(Renderer* renderer);
  // The town, all pictures and what else a still needs; the rest stays unread.
  Error UploadThese(const std::vector<AssetId>& needed, Renderer* renderer);

  bool TownIsThere() const;         // with its pictures
  bool LikenessesAreThere() const;  // and everybody can be drawn somehow
  float ShareOfLikenesses() const;  // of what that takes, that is there
  bool Done() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flaneur
