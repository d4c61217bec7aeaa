// Ground for a town whose model has none, as most open city models of houses alone.
#pragma once
#include <vector>

#include "pipeline/core/mesh.h"
#include "pipeline/footprint/town_objects.h"

namespace flaneur {

// A surface through the feet of the things, one at least, `margin_m` wider than they all: near a thing as high as its
// foot, of neighbours as the higher one's, between several the mean by nearness (inverse distance weighting, Shepard
// 1968). A flat square as high as most feet where they differ little or `on_one_level`. Of a mesh of many houses each
// connected piece has its own foot. What begins over another thing, as a roof does over walls, has none, unless the
// model says what it stands on; one far over or under all others near it is a cellar or a kite, and counts for nothing.
Mesh BareGround(const std::vector<TownObject>& things, bool on_one_level, float margin_m);

}  // namespace flaneur
