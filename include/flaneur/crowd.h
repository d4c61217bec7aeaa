// flaneur_crowd: people who walk to their goals among obstacles and each other, and who of them is drawn how.
//
//   FlaneurCrowdDef def = flaneur_default_crowd_def();
//   def.ground_min_m.x = def.ground_min_m.y = 0, def.ground_max_m.x = def.ground_max_m.y = 50;
//   FlaneurCrowdId crowd;
//   if (flaneur_create_crowd(&def, &crowd) != FLANEUR_OK) puts(flaneur_crowd_last_error());
//   FlaneurPersonDef person = flaneur_default_person_def();
//   FlaneurPersonId id;
//   flaneur_crowd_add_person(crowd, &person, &id);
//   flaneur_crowd_set_goal(crowd, id, goal);
//   for each frame: flaneur_crowd_step(crowd, &camera, frame_ms);
//                   flaneur_crowd_people(crowd, &people);   // where they are, and with which level of detail to draw
//                   them
//   flaneur_destroy_crowd(crowd);
//
// The control keeps the number of people in high resolution, and all triangles, within limits, and gently moves people
// so that the limits hold unnoticed: Ryder, Flack and Day, Adaptive Crowd Behaviour to Aid Real-Time Rendering of a
// Cultural Heritage Environment (VAST 2004), and beyond it. Flaneur's own code is under the MIT licence; this library
// links nothing under the GPL.
//
// Units: metres, seconds, radians; x east, y north; angles anticlockwise from +x. base.h has the rules for errors, ids,
// spans and threads. The same calls give the same bits, on every machine with the same build of the library. It starts
// no threads but those that flaneur_crowd_set_threads asks for.
#ifndef FLANEUR_CROWD_H
#define FLANEUR_CROWD_H

#include "flaneur/base.h"

// A polygon that nobody enters; within its holes people can walk.
typedef struct FlaneurPolygon {
  FlaneurRing outer;         // at least 3 points, either way round; holes, too
  const FlaneurRing* holes;  // may be null where hole_count is 0
  int hole_count;
} FlaneurPolygon;

typedef struct FlaneurCircle {
  FlaneurPoint center_m;
  double radius_m;  // > 0
} FlaneurCircle;

// One mesh of a figure.
typedef struct FlaneurLevelCost {
  int triangles;    // > 0
  float switch_px;  // chosen where the figure is this high on screen, or higher; >= 0
} FlaneurLevelCost;

// What drawing a kind of figure costs.
typedef struct FlaneurFigure {
  const FlaneurLevelCost* levels;  // finest first, 1 to 16
  int level_count;
  float height_m;     // 0.1 to 10
  float impostor_px;  // height of its picture, which is good enough as long as it is not enlarged; > 0
  float reach_m;      // of all that is drawn, from the middle: who reaches into the view is in it; 0: a person's radius
} FlaneurFigure;

typedef enum FlaneurAdaptation {
  FLANEUR_ADAPTATION_OFF = 0,    // people are left alone
  FLANEUR_ADAPTATION_PAPER = 1,  // as in the paper: people avoid the camera once the limit is reached
  FLANEUR_ADAPTATION_FULL = 2    // people foresee where the visitor will look, and keep out of it early
} FlaneurAdaptation;

typedef enum FlaneurLimitMethod {
  FLANEUR_LIMIT_COUNT = 0,      // high_limit people in high resolution
  FLANEUR_LIMIT_FRAME_TIME = 1  // as many as target_ms affords; needs frame_ms in each step
} FlaneurLimitMethod;

typedef struct FlaneurCrowdDef {
  FlaneurPoint ground_min_m, ground_max_m;  // the rectangle to walk on, sides of 2 to 2,000 m, within 100,000 km
  const FlaneurPolygon* polygons;           // obstacles, within 100 km of the ground; may overlap
  int polygon_count;
  const FlaneurCircle* circles;
  int circle_count;
  const FlaneurFigure* figures;  // null: one figure of 1.75 m with levels of 6,000 and 1,500 triangles
  int figure_count;
  uint64_t seed;              // 1; of speeds that are drawn
  float largest_radius_m;     // 0.25, of people, 0.1 to 0.5
  float preferred_speed_mps;  // 1.3, mean of the speeds drawn, 0.1 to 5
  float speed_spread_mps;     // 0.2, their standard deviation, 0 to 2
  float top_speed_mps;        // 1.9, 0.1 to 10
  int adaptation;             // FLANEUR_ADAPTATION_FULL
  float discretion;           // 1, 0 to 1, with full adaptation: 1 unnoticed, 0 the limit at any price
  int method;                 // FLANEUR_LIMIT_COUNT
  int high_limit;             // 12, 0 to 10,000
  float target_ms;            // 16.7, of a frame, 1 to 1,000
  int budget_triangles;       // 200,000, of all people in view, whatever the method; 1 to 1e9
  float r_personal_m;         // 0.6; nobody comes nearer to the camera; 0 to 10
  float r_high_m;             // 10; high resolution within it; 0 for nobody, else above r_personal_m and below r_far_m
  float r_unimportant_m;      // 40; beyond it people are not asked to go elsewhere
  float r_far_m;              // 200; beyond it nobody is drawn; 1 to 100,000
  float step_hz;              // 30, steps a second, 10 to 240
  float max_yaw_rate_dps;     // 120, of the camera, in degrees a second, 1 to 720
  int internal_value;         // set by flaneur_default_crowd_def
} FlaneurCrowdDef;

typedef struct FlaneurCrowdId {
  uint32_t index1, generation;
} FlaneurCrowdId;

// Belongs to one crowd.
typedef struct FlaneurPersonId {
  uint32_t index1, generation;
} FlaneurPersonId;

typedef struct FlaneurPersonDef {
  FlaneurPoint position_m;
  float heading_rad;
  int figure;                 // 0, index into the crowd's figures
  float radius_m;             // 0.25, 0.1 to the crowd's largest_radius_m
  float preferred_speed_mps;  // 0: drawn; else up to 10
  int internal_value;         // set by flaneur_default_person_def
} FlaneurPersonDef;

typedef struct FlaneurCamera {
  FlaneurPoint position_m;  // within 100 km of the ground
  float yaw_rad;
  float fov_rad;        // horizontal, 10 to 150 degrees
  int screen_width_px;  // that switch_px is about, 1 to 65,536
} FlaneurCamera;

enum {
  FLANEUR_LEVEL_NOT_DRAWN = -2,
  FLANEUR_LEVEL_IMPOSTOR = -1
  // 0: the figure's finest mesh, 1: the next, ...
};

typedef enum FlaneurArrival {
  FLANEUR_ARRIVAL_NOT = 0,
  FLANEUR_ARRIVAL_NEAR = 1,  // within 3 m of the goal, and held up by others: as near as can be for now
  FLANEUR_ARRIVAL_THERE = 2  // the person stands until there is another goal
} FlaneurArrival;

// After the last step.
typedef struct FlaneurPerson {
  FlaneurPersonId id;
  FlaneurPoint position_m;
  float heading_rad;
  float speed_mps;
  float walked_m;  // since they came: drives the walk cycle
  int figure;
  int level;        // FLANEUR_LEVEL_... or a mesh
  int from_level;   // which it is faded from, as long as fade < 1
  float fade;       // 0: all of from_level, to 1: all of level
  float age_s;      // since the level changed, up to the length of the fade
  int arrival;      // in this step, a FlaneurArrival
  bool is_in_view;  // any part of them
} FlaneurPerson;

typedef struct FlaneurPersonSpan {
  const FlaneurPerson* items;
  int count;
} FlaneurPersonSpan;

// Of those in view, after the last step.
typedef struct FlaneurCrowdFigures {
  int people;         // in the whole crowd
  int high, low;      // as meshes and as impostors
  int limit;          // most in high resolution, in force
  int64_t triangles;  // of everybody, with levels that fade out
  int64_t step;       // steps done
  float step_s;       // of one
} FlaneurCrowdFigures;

FLANEUR_API FlaneurCrowdDef flaneur_default_crowd_def(void);
FLANEUR_API FlaneurPersonDef flaneur_default_person_def(void);

// Lays a grid over the ground, which takes up to a second. Its cells are 0.35 m wide on up to 430 m x 430 m, larger on
// larger ground, where narrow passages may get lost. Errors: numbers out of range, limits that contradict each other,
// no ground to walk on.
FLANEUR_API FlaneurStatus flaneur_create_crowd(const FlaneurCrowdDef* def, FlaneurCrowdId* id);

// Frees the crowd, its people and its span.
FLANEUR_API FlaneurStatus flaneur_destroy_crowd(FlaneurCrowdId crowd);

FLANEUR_API bool flaneur_crowd_is_valid(FlaneurCrowdId crowd);

// Up to 200,000 people. They stand until they get a goal, and are in the span after the next step. Errors: a place
// inside an obstacle, too near to one for a person or off the ground (FLANEUR_ERROR_INPUT).
FLANEUR_API FlaneurStatus flaneur_crowd_add_person(FlaneurCrowdId crowd, const FlaneurPersonDef* def,
                                                   FlaneurPersonId* id);

FLANEUR_API FlaneurStatus flaneur_crowd_remove_person(FlaneurCrowdId crowd, FlaneurPersonId person);

FLANEUR_API bool flaneur_crowd_has_person(FlaneurCrowdId crowd, FlaneurPersonId person);

// Where the person goes from now on. Goals that many share are cheaper than many goals. Errors: a place without ground
// to walk on within 3 m, or that no way leads to (FLANEUR_ERROR_INPUT).
FLANEUR_API FlaneurStatus flaneur_crowd_set_goal(FlaneurCrowdId crowd, FlaneurPersonId person, FlaneurPoint goal_m);

// The person stands from now on.
FLANEUR_API FlaneurStatus flaneur_crowd_clear_goal(FlaneurCrowdId crowd, FlaneurPersonId person);

// 1 / step_hz seconds pass, then levels are chosen for this camera. Null: nobody looks, nobody gets a level. frame_ms:
// what the last frame took, 0 to 10,000; 0: not known. A camera that was more than 10 m away in the step before has
// jumped.
FLANEUR_API FlaneurStatus flaneur_crowd_step(FlaneurCrowdId crowd, const FlaneurCamera* camera, float frame_ms);

// So many threads (0, as before the first call, to 64; or as many as the system starts) share the steps of crowds of
// some thousands with the caller's. The bits stay the same. They sleep between steps, and end with the crowd or the
// next call.
FLANEUR_API FlaneurStatus flaneur_crowd_set_threads(FlaneurCrowdId crowd, int threads);

// Everybody after the last step, in no order that lasts; none before the first. Stays until the next step.
FLANEUR_API FlaneurStatus flaneur_crowd_people(FlaneurCrowdId crowd, FlaneurPersonSpan* people);

FLANEUR_API FlaneurStatus flaneur_crowd_figures(FlaneurCrowdId crowd, FlaneurCrowdFigures* figures);

// Of this thread's last call that failed, one line; empty where none has. Stays until the thread's next call of this
// library.
FLANEUR_API const char* flaneur_crowd_last_error(void);

// Of the library that is linked; FLANEUR_VERSION_... are those of the header.
FLANEUR_API FlaneurVersion flaneur_crowd_version(void);

#endif
