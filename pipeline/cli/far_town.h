// Towns whose file has them far from its zero, as files in map coordinates do. Internal to pipeline/cli.
#pragma once
#include <string>
#include <vector>

#include "pipeline/cli/georeference.h"
#include "pipeline/cli/painting.h"
#include "pipeline/core/scene.h"
#include "pipeline/footprint/findings.h"
#include "runtime/tour_data/tour_data.h"

namespace flaneur {

// How far the middle of a town may be from zero. What draws it has floats, which from 3 km on are too coarse for
// shadows; obstacles for other programs are moved only as readers of city models move them.
inline constexpr double kFarToDraw_m = 1000, kFarForOthers_m = 10'000;

// By how much a town is to be moved (x east, y north) whose middle is farther than far_m from zero: whole hundreds of
// metres; else zero. scale: metres per unit of the town.
Point2 FarFromZero(double far_m, double scale, const Scene& town);
// Subtracts that, and adds it to `town->origin_m`.
void MoveNearZero(Point2 by, Scene* town);

// Towns on high mountains: heights the same way. Returns what was subtracted.
double LowerToZero(double far_m, Scene* town);

// MoveNearZero with SetGeoreference: an origin that is stated is where the file's zero is on the map; without one the
// file's coordinates are the map's. moved (may be null): by how much it was.
Error PlaceTown(const Georeference& wish, double far_m, double scale, Scene* town, Point2* moved,
                std::vector<std::string>* warnings);

// Settings give places as the town's file has them or as the moved town does: what lies nearer to zero once it is
// moved is meant as in the file.
Vec2 InMovedTown(Vec2 place_m, Point2 moved_m);
Point2 InMovedTown(Point2 place_m, Point2 moved_m);
// All places of the tour, and the heights of its smoke; of a painting's area; of accepted findings.
void TakeIntoMovedTown(Point2 moved_m, double lowered_m, TourData* tour);
PaintingSettings InMovedTown(PaintingSettings painting, Point2 moved_m);
std::vector<AcceptedFinding> InMovedTown(std::vector<AcceptedFinding> accepted, Point2 moved_m);

}  // namespace flaneur
