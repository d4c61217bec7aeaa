#include "pipeline/avatar/fit_surface.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "pipeline/avatar/in_strides.h"
#include "pipeline/avatar/posed_quadric.h"
#include "pipeline/avatar/poses.h"
#include "pipeline/avatar/surface_distance.h"
#include "pipeline/avatar/surface_places.h"

namespace flaneur {
namespace {

constexpr double kAlong = 0.02;          // of a pull along the surface, against one across it
constexpr double kBindShare = 1.25;      // of the bind pose, against all others together
constexpr double kInertia = 0.02;        // of what holds a vertex where it is, against the pulls
constexpr double kWeightInertia = 0.05;  // the same of its weights
constexpr float kMinShare = 0.01f;       // of a corner in a place: less pulls at the other corners only
constexpr float kFarthest = 1.5f;        // of its first ties' greatest length: so far may a vertex move
constexpr float kStraight = 0.7f;        // cosine; a longer way round has a border or crease between
constexpr float kSameSide = 0.2f;        // cosine between normals of places that belong together
constexpr size_t kBlock = 256;           // places on one thread
// Places a face and at most: small originals, whose levels are seen from nearer, can afford more.
struct Density {
  size_t a_face, most;
};
constexpr Density kSmallOriginal{12, 30000}, kLargeOriginal{5, 20000};
constexpr size_t kLargeOriginalFaces = 20000, kMinSamples = 5000;
constexpr size_t kMaxFaces = 10000;         // of a level: of larger ones too few places would be left for a vertex
constexpr int kRounds = 2;                  // of tying and solving
constexpr double kMinFaceTurnCosine = 0.1;  // cosine; a face that turns further is taken to fold over

// A place of the level that should be where a place of the original is.
struct Tie {
  SurfacePlace on_level, on_original;
  double along = 0;  // how much a pull along the surface counts, against one across it
};

}  // namespace

struct FitOriginal {
  Jobs* jobs;
  const std::vector<std::vector<Mat4>>& poses;
  std::vector<Triangles> triangles;  // by pose, the bind pose first
  std::vector<SurfacePlace> places;  // that are tied
  std::unique_ptr<SurfaceTree> tree;
};

namespace {

class Fitter {
 public:
  Fitter(const FitOriginal& original, size_t samples, WedgeSurface* level)
      : jobs_(original.jobs),
        poses_(original.poses),
        level_(level),
        original_(original.triangles),
        tree_(*original.tree) {
    for (size_t i = 0; i < samples; ++i) {
      on_original_.push_back(original.places[i * original.places.size() / samples]);
    }
    faces_of_.resize(level->vertices.size());
    for (size_t f = 0; f < level->faces.size(); ++f) {
      for (const int v : level->faces[f].vertices) faces_of_[static_cast<size_t>(v)].push_back(f);
    }
    skinning_.resize(level->vertices.size() * (poses_.size() + 1));
    posed_.resize(skinning_.size());
    pulls_.resize(Poses());
    for (size_t v = 0; v < level->vertices.size(); ++v) Pose(v);
  }

  // Ties evenly spread places of each surface to the nearest of the other.
  void TieAll() {
    const Triangles level = BindTriangles(*level_);
    const SurfaceTree level_tree(level);
    const bool first_time = guesses_.empty();
    if (first_time) {
      on_level_ = SpreadPlaces(level, static_cast<int>(on_original_.size()));
      guesses_.assign(on_original_.size() + on_level_.size(), 0);
    }
    std::vector<Tie> found(guesses_.size());
    InStrides(jobs_, [&](size_t first, size_t step) {
      // In blocks that do not depend on the number of threads: of equal distances a guess decides.
      for (size_t start = first * kBlock; start < found.size(); start += step * kBlock) {
        for (size_t i = start; i < std::min(start + kBlock, found.size()); ++i) {
          if (first_time && i > start) guesses_[i] = guesses_[i - 1];
          found[i] = Tied(level, level_tree, i);
        }
      }
    });
    ties_.clear();
    for (const Tie& tie : found) {
      if (tie.along > 0) ties_.push_back(tie);
    }
    SortTies();
    if (reach_.empty()) FindReach(level);
  }

  void Solve() {
    for (size_t v = 0; v < level_->vertices.size(); ++v) {
      if (ties_of_[v].empty()) continue;
      for (size_t k = 0; k < Poses(); ++k) pulls_[k] = Pull(v, k);
      Move(v);
      if (!poses_.empty()) Reweigh(v);
    }
  }

 private:
  struct Target {
    Vec3 place, normal;
  };

  // The i-th tie; one whose ends face different ways does not pull.
  Tie Tied(const Triangles& level, const SurfaceTree& level_tree, size_t i) {
    Tie tie;
    const bool from_original = i < on_original_.size();
    if (from_original) tie.on_original = on_original_[i];
    else tie.on_level = on_level_[i - on_original_.size()];
    const Vec3 from = from_original ? At(original_[0][tie.on_original.triangle], tie.on_original.shares)
                                    : At(level[tie.on_level.triangle], tie.on_level.shares);
    const auto nearest = (from_original ? level_tree : tree_).Find(from, guesses_[i]);
    guesses_[i] = nearest.triangle;
    (from_original ? tie.on_level : tie.on_original) = {nearest.triangle, nearest.shares};
    const auto& corners = level[tie.on_level.triangle];
    const auto& triangle = original_[0][tie.on_original.triangle];
    const Vec3 normal = FaceNormal(triangle);
    if (Dot(FaceNormal(corners), normal) <= kSameSide) return tie;
    // Beyond a border or a crease the nearest place does not lie straight below.
    const Vec3 way = At(corners, tie.on_level.shares) - At(triangle, tie.on_original.shares);
    tie.along = std::abs(Dot(way, normal)) > kStraight * Length(way) ? kAlong : 1;
    return tie;
  }

  void SortTies() {
    ties_of_.resize(level_->vertices.size());
    for (auto& ties : ties_of_) ties.clear();
    targets_.clear();
    targets_.reserve(ties_.size() * Poses());
    for (size_t i = 0; i < ties_.size(); ++i) {
      const SurfacePlace& place = ties_[i].on_level;
      for (size_t k = 0; k < 3; ++k) {
        if (!(place.shares[k] > kMinShare)) continue;
        const int v = level_->faces[place.triangle].vertices[k];
        ties_of_[static_cast<size_t>(v)].push_back(static_cast<uint32_t>(3 * i + k));
      }
      for (const Triangles& pose : original_) {
        const auto& triangle = pose[ties_[i].on_original.triangle];
        targets_.push_back({At(triangle, ties_[i].on_original.shares), FaceNormal(triangle)});
      }
    }
  }

  void FindReach(const Triangles& level) {
    for (const WedgeSurface::Vertex& vertex : level_->vertices) start_.push_back(vertex.position);
    reach_.assign(start_.size(), 0);
    for (size_t v = 0; v < start_.size(); ++v) {
      for (const uint32_t id : ties_of_[v]) {
        const Tie& tie = ties_[id / 3];
        const Vec3 way = At(original_[0][tie.on_original.triangle], tie.on_original.shares) -
                         At(level[tie.on_level.triangle], tie.on_level.shares);
        reach_[v] = std::max(reach_[v], Length(way));
      }
    }
  }

  size_t Poses() const { return poses_.size() + 1; }

  void Pose(size_t v) {
    const WedgeSurface::Vertex& vertex = level_->vertices[v];
    for (size_t k = 0; k < Poses(); ++k) {
      Affine& m = skinning_[v * Poses() + k];
      m = k > 0 ? SkinningOf(vertex.joints, vertex.weights, poses_[k - 1]) : kIdentity;
      posed_[v * Poses() + k] = Apply(m, ToDouble(vertex.position));
    }
  }

  // What of the tie's pull is left for this corner: the target less the other corners' part.
  DVec3 Left(const Tie& tie, size_t corner, size_t pose, const Target& target) const {
    DVec3 left = ToDouble(target.place);
    for (size_t k = 0; k < 3; ++k) {
      if (k == corner) continue;
      const auto v = static_cast<size_t>(level_->faces[tie.on_level.triangle].vertices[k]);
      left = left - posed_[v * Poses() + pose] * static_cast<double>(tie.on_level.shares[k]);
    }
    return left;
  }

  // The ties' quadric in one pose, of the vertex's posed place.
  Quadric Pull(size_t v, size_t pose) const {
    Quadric sum;
    const auto others = static_cast<double>(poses_.size());
    const double weight = pose == 0 ? std::max(1.0, kBindShare * others) : 1;
    for (const uint32_t id : ties_of_[v]) {
      const Tie& tie = ties_[id / 3];
      const size_t corner = id % 3;
      const Target& target = targets_[(id / 3) * Poses() + pose];
      const double share = static_cast<double>(tie.on_level.shares[corner]);
      const DVec3 wanted = Left(tie, corner, pose, target) * (1 / share);
      sum = sum + PlaneQuadric(ToDouble(target.normal), wanted, weight * share * share) +
            PointQuadric(wanted, weight * tie.along * share * share);
    }
    return sum;
  }

  bool TurnsOver(size_t v, Vec3 to) const {
    for (const size_t f : faces_of_[v]) {
      const auto& face = level_->faces[f];
      size_t k = 0;
      while (face.vertices[k] != static_cast<int>(v)) ++k;
      const auto corner = [&](size_t i) {
        return ToDouble(level_->vertices[static_cast<size_t>(face.vertices[(k + i) % 3])].position);
      };
      const DVec3 along = corner(2) - corner(1);
      const DVec3 before = Cross(along, corner(0) - corner(1));
      const DVec3 after = Cross(along, ToDouble(to) - corner(1));
      if (Dot(before, after) <= kMinFaceTurnCosine * std::sqrt(Dot(before, before) * Dot(after, after))) {
        return true;
      }
    }
    return false;
  }

  void Move(size_t v) {
    Quadric sum;
    for (size_t k = 0; k < Poses(); ++k) {
      AddPulledBack(pulls_[k], skinning_[v * Poses() + k], &sum);
    }
    const Vec3 to = ToFloat(Minimizer(sum, ToDouble(level_->vertices[v].position), kInertia));
    if (!(Length(to - start_[v]) <= kFarthest * reach_[v]) || TurnsOver(v, to)) return;
    level_->vertices[v].position = to;
    Pose(v);
  }

  // Shifts weight between pairs of the vertex's joints, each time by what serves best.
  void Reweigh(size_t v) {
    WedgeSurface::Vertex& vertex = level_->vertices[v];
    double scale = 0;
    for (size_t k = 1; k < Poses(); ++k) scale += pulls_[k].xx + pulls_[k].yy + pulls_[k].zz;
    for (size_t i = 0; i < 4; ++i) {
      for (size_t j = i + 1; j < 4; ++j) {
        if (!(vertex.weights[i] > 0) || !(vertex.weights[j] > 0)) continue;
        // Weight s from j to i moves the vertex by s * way in each pose.
        double slope = 0, curve = 0, way2 = 0;
        for (size_t k = 1; k < Poses(); ++k) {
          const auto at = [&](uint16_t joint) {
            return ToDouble(TransformPoint(poses_[k - 1][joint], vertex.position));
          };
          const DVec3 way = at(vertex.joints[i]) - at(vertex.joints[j]);
          const DVec3 from = posed_[v * Poses() + k];
          const Quadric& q = pulls_[k];
          const double here = Evaluate(q, from), there = Evaluate(q, from + way);
          const double half = Evaluate(q, from + way * 0.5);
          const double bend = 2 * (there - 2 * half + here);  // f(s) = here + b s + bend s^2
          curve += bend;
          slope += there - here - bend;
          way2 += Dot(way, way);
        }
        curve += kWeightInertia * scale / 3 * way2 / static_cast<double>(poses_.size());
        if (!(curve > 0)) continue;
        const float s = std::clamp(static_cast<float>(-slope / (2 * curve)), -vertex.weights[i], vertex.weights[j]);
        vertex.weights[i] += s;
        vertex.weights[j] -= s;
        Pose(v);
      }
    }
  }

  Jobs* jobs_;
  const std::vector<std::vector<Mat4>>& poses_;
  WedgeSurface* level_;
  std::vector<Vec3> start_;                 // places before all
  std::vector<float> reach_;                // the greatest distance of a vertex's first ties
  const std::vector<Triangles>& original_;  // bind pose first
  std::vector<SurfacePlace> on_original_;   // that are tied
  const SurfaceTree& tree_;
  std::vector<std::vector<size_t>> faces_of_;
  std::vector<Affine> skinning_;  // by vertex and pose
  std::vector<DVec3> posed_;
  std::vector<Quadric> pulls_;  // by pose, of the vertex in hand: they hang on other vertices alone
  std::vector<SurfacePlace> on_level_;
  std::vector<uint32_t> guesses_;  // of where each one's nearest place is
  std::vector<Tie> ties_;
  std::vector<Target> targets_;                 // by tie and pose
  std::vector<std::vector<uint32_t>> ties_of_;  // by vertex: 3 * tie + corner
};

Density DensityFor(const FitOriginal& original) {
  return original.triangles[0].size() > kLargeOriginalFaces ? kLargeOriginal : kSmallOriginal;
}

}  // namespace

SurfaceFitter::SurfaceFitter(const std::vector<Mesh>& original, const std::vector<std::vector<Mat4>>& poses, Jobs* jobs)
    : original_(new FitOriginal{jobs, poses, {}, {}, nullptr}) {
  const std::vector<Mesh> shapes = Shapes(original);
  original_->triangles.push_back(PosedTriangles(shapes, nullptr));
  for (const auto& pose : poses) original_->triangles.push_back(PosedTriangles(shapes, &pose));
  original_->places = SpreadPlaces(original_->triangles[0], static_cast<int>(DensityFor(*original_).most));
  original_->tree = std::make_unique<SurfaceTree>(original_->triangles[0]);
}

SurfaceFitter::~SurfaceFitter() = default;

void SurfaceFitter::Fit(WedgeSurface* level) const {
  if (level->faces.size() > kMaxFaces) return;
  const Density density = DensityFor(*original_);
  const size_t samples = std::clamp(density.a_face * level->faces.size(), kMinSamples, density.most);
  Fitter fitter(*original_, samples, level);
  for (int round = 0; round < kRounds; ++round) {
    fitter.TieAll();
    fitter.Solve();
    fitter.Solve();
  }
}

}  // namespace flaneur
