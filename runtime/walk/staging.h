// Where the guide walks and stands so that visitors see both the guide, from head to foot, and what the guide shows
// them. Internal to runtime/walk.
#pragma once
#include <optional>

#include "runtime/base/math.h"

namespace flaneur {

struct CameraState;
struct Route;
struct VisitorInTown;

// Unit vector, there; zero where the route leads nowhere.
Vec2 AlongRoute(const Route& route, float way_m);

// How far ahead somebody is seen whole, and how far to the side clear of the picture's middle third. The picture is as
// CameraState says.
float LeadDepth_m(const CameraState& camera);
float ClearSide_m(const CameraState& camera, float depth_m);

// Where to stand at a stop: beside what there is to see, seen whole, near the way on. `from`: where the guide comes
// from.
Vec2 PlaceBesideSight(size_t halt, Vec2 from, const VisitorInTown& v);

// The side of the route, 1 left and -1 right, on which the guide walks best from way_m on; now: the present one, 0:
// none yet.
float SideToWalk(float way_m, float now, const VisitorInTown& v);

// A point of the route, as far to that side as it takes to be clear of the view's middle, or as there is room.
Vec2 BesideRoute(float way_m, float side, const VisitorInTown& v);

// From the visitor; none: there is no guide.
std::optional<Vec2> WayToGuide(const VisitorInTown& v);

// How far from the way who follows the tour looks: with the guide in the picture, and on the last metres to a halt to
// what there is to see. Who walks looks where they go besides.
float LookOffWay_rad(float way_rad, const VisitorInTown& v);

// How the tour turns the view a little away from a guide for whom there is too little room; 0 where it need not.
float LookAside_rad(float look_rad, float most_rad, const VisitorInTown& v);

}  // namespace flaneur
