// flaneur_footprints: what stands in a walker's way in a town of triangles, and whether it is fit for a crowd.
//
//   FlaneurFootprintsDef def = flaneur_default_footprints_def();
//   def.objects = objects, def.object_count = count;      // houses, walls, trees, ground: triangles in memory
//   FlaneurFootprintsId town;
//   if (flaneur_create_footprints(&def, &town) != FLANEUR_OK) puts(flaneur_footprints_last_error());
//   FlaneurObstacleSpan obstacles;                        // polygons with holes, and circles
//   flaneur_footprints_obstacles(town, &obstacles);
//   FlaneurFindingSpan findings;                          // what is wrong with them, and where
//   FlaneurCheckDef check = flaneur_default_check_def();
//   flaneur_footprints_check(town, &check, &findings);
//   flaneur_destroy_footprints(town);
//
// LICENCE. This library links CGAL, whose packages used here are under the GPL, version 3 or later. What links it is,
// when handed on, under the terms of the GPL as a whole. Flaneur's own code, this header included, is under the MIT
// licence.
//
// Coordinates: metres, x east, y north, z up, any origin; results are in the same coordinates. base.h has the rules for
// errors, ids, spans and threads. Same input, same result, bit for bit, whatever the number of threads.
#ifndef FLANEUR_FOOTPRINTS_H
#define FLANEUR_FOOTPRINTS_H

#include "flaneur/base.h"

typedef enum FlaneurObjectKind {
  FLANEUR_OBJECT_BY_NAME = 0,  // told by the words of its name (tree, lamp, street, grass, square ...), flat ones are
                               // ground, all others are buildings
  FLANEUR_OBJECT_BUILDING = 1,
  FLANEUR_OBJECT_WALL = 2,
  FLANEUR_OBJECT_TREE = 3,  // trees and lamps become circles
  FLANEUR_OBJECT_LAMP = 4,
  FLANEUR_OBJECT_OTHER = 5,  // fountains, carts, statues
  FLANEUR_OBJECT_GROUND = 6  // what people walk on; without any, buildings tell how high the ground lies
} FlaneurObjectKind;

// A house, a tree, a piece of ground: triangles in space.
typedef struct FlaneurObject {
  const char* name;           // of its obstacles and in findings; null: object_0, object_1, ...
  int kind;                   // a FlaneurObjectKind
  const double* positions_m;  // x, y, z of each vertex, 3 * vertex_count numbers, each within 100,000 km
  int vertex_count;
  const uint32_t* indices;  // three a triangle, either way round; null: vertices 0 1 2, 3 4 5, ...
  int index_count;          // a multiple of 3; 0 where indices is null
  double radius_m;          // of trees and lamps; 0: measured
} FlaneurObject;

typedef struct FlaneurFootprintsDef {
  const FlaneurObject* objects;
  int object_count;     // > 0
  double clearance_m;   // 0.05; obstacles are enlarged by this, 0 to 10
  double band_low_m;    // 0.1; what reaches between these heights over the local ground blocks, 0 <= low < high <= 100
  double band_high_m;   // 2
  double tolerance_m;   // 0.01; simplifying moves outlines outwards by at most this, 0 to 1
  double bridge_m;      // 0.05; walls that miss each other by less are joined, 0 to 1
  double open_yard_m2;  // 0.5; smaller enclosed yards are filled, >= 0
  bool merge_blocks;    // false; houses that adjoin become one obstacle
  int threads;          // 0: one a core; at most 1024
  int internal_value;   // set by flaneur_default_footprints_def
} FlaneurFootprintsDef;

typedef struct FlaneurFootprintsId {
  uint32_t index1, generation;
} FlaneurFootprintsId;

// A polygon with holes, or a circle (outer.count 0, radius_m > 0).
typedef struct FlaneurObstacle {
  const char* name;          // unique
  const char* object;        // the name of the object it was made from
  FlaneurObjectKind kind;    // building, wall, tree, lamp or other
  FlaneurRing outer;         // anticlockwise, simple
  const FlaneurRing* holes;  // clockwise: yards that are open to the sky
  int hole_count;
  FlaneurPoint center_m;  // of a circle
  double radius_m;
  double ground_z_m;  // under its middle
  bool is_guess;      // its object's walls do not close, or had to be closed
} FlaneurObstacle;

typedef struct FlaneurObstacleSpan {
  const FlaneurObstacle* items;
  int count;
} FlaneurObstacleSpan;

typedef struct FlaneurTextSpan {
  const char* const* items;
  int count;
} FlaneurTextSpan;

// Where people come in or leave.
typedef struct FlaneurGate {
  const char* name;
  FlaneurPoint at_m;
  FlaneurPoint ahead;  // a direction that leads from a door into the open; {0, 0}: none
  bool is_exit;
} FlaneurGate;

// The middle line of a street.
typedef struct FlaneurStreet {
  const char* name;
  const FlaneurPoint* points_m;
  int count;  // >= 2
} FlaneurStreet;

typedef struct FlaneurCheckDef {
  const FlaneurGate* gates;  // may be null where gate_count is 0
  int gate_count;
  const FlaneurStreet* streets;
  int street_count;
  double person_radius_m;           // 0.3, > 0
  double clearance_m;               // wall to outline; negative (default): that of the footprints
  double tolerance_m;               // 0.01, > 0; distances may be off by this
  double spike_width_m;             // 0.01, > 0; 203: what an opening with this radius takes away,
  double spike_length_m;            // 0.1, > 0; where it is longer than this
  double over_cover_share;          // 0.02, >= 0; 303: of a footprint's area
  double headroom_m;                // 2, > 0; 307: over a passage
  double overlap_m2;                // 0.01, >= 0; 401
  double least_ground_m2;           // 1, > 0; 501
  double dead_end_m;                // 10, > 0; 502: deeper ones
  double high_resolution_radius_m;  // 10, > 0; 503: round the visitor
  int most_points;                  // 256, >= 3; 108: in a ring
  int internal_value;               // set by flaneur_default_check_def
} FlaneurCheckDef;

typedef struct FlaneurFinding {
  int code;       // 101 to 604, see docs/findings.md
  bool is_error;  // else a warning
  FlaneurPoint at_m;
  double value, limit;  // what was measured, and what it must not pass
  const char* title;    // a few words
  const char* feature;  // the obstacle's (or gate's, or street's) name
  const char* other;    // the second obstacle, where there is one
  const char* message;  // what is wrong here
  const char* advice;   // what to do
} FlaneurFinding;

typedef struct FlaneurFindingSpan {
  const FlaneurFinding* items;  // by code, then by name
  int count;
} FlaneurFindingSpan;

FLANEUR_API FlaneurFootprintsDef flaneur_default_footprints_def(void);
FLANEUR_API FlaneurCheckDef flaneur_default_check_def(void);

// Extracts the obstacles; takes milliseconds for a house and seconds for a town of a million triangles. Errors: numbers
// out of range, an index behind the last vertex, no triangle with an area, a town in degrees, one wider than 100 km.
FLANEUR_API FlaneurStatus flaneur_create_footprints(const FlaneurFootprintsDef* def, FlaneurFootprintsId* id);

// Frees the footprints and all their spans.
FLANEUR_API FlaneurStatus flaneur_destroy_footprints(FlaneurFootprintsId id);

FLANEUR_API bool flaneur_footprints_is_valid(FlaneurFootprintsId id);

// Stay as long as the footprints.
FLANEUR_API FlaneurStatus flaneur_footprints_obstacles(FlaneurFootprintsId id, FlaneurObstacleSpan* obstacles);

// One line for each thing that looks wrong about the input. They stay as long as the footprints.
FLANEUR_API FlaneurStatus flaneur_footprints_warnings(FlaneurFootprintsId id, FlaneurTextSpan* warnings);

// Looks at rings and pairs of obstacles, at walls, ground and passages of the town, at the ways between, at gates and
// streets. Findings stay until the next check of these footprints. Errors: numbers out of range.
FLANEUR_API FlaneurStatus flaneur_footprints_check(FlaneurFootprintsId id, const FlaneurCheckDef* def,
                                                   FlaneurFindingSpan* findings);

// Of this thread's last call that failed, one line; empty where none has. Stays until the thread's next call of this
// library.
FLANEUR_API const char* flaneur_footprints_last_error(void);

// Of the library that is linked; FLANEUR_VERSION_... are those of the header.
FLANEUR_API FlaneurVersion flaneur_footprints_version(void);

#endif
