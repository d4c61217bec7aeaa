// What a file from outside may ask for at most: counts, depths, sizes, memory, work. Every limit of the formats stands
// here, so that nothing is allocated, and no work begun, only because a file says so. docs/limits.md tells them to
// users, and tests/docs_test.py that both agree.
#pragma once
#include <cstddef>
#include <cstdint>

namespace flaneur {

// Of any file.
inline constexpr uint64_t kMostFile_bytes = 4294967296;
inline constexpr int kMostNesting = 200;               // lists and objects of JSON in each other
inline constexpr int kMostKeyParts = 200;              // a.b.c of TOML has three
inline constexpr size_t kMostTables = 10000;           // of one name in a TOML file, where nothing less is said
inline constexpr size_t kMostMessage_bytes = 4000;     // of what a file's text makes of an error
inline constexpr uint64_t kMostLog_bytes = 268435456;  // that a program may print while a bake waits for it

// Of a tour pack, together: memory beside the file itself, once for pictures and once for all else.
inline constexpr uint64_t kPackMemory_bytes = 1073741824, kPackPictures_bytes = 1073741824;
// Work: so much for any pack, and more for each of its bytes. A unit is about ten nanoseconds.
inline constexpr uint64_t kPackWork = 20000000, kPackWorkAByte = 40;
inline constexpr uint64_t kFreePixels = 16777216, kPixelsAByte = 16;  // of all its pictures, likewise

// Of a glTF model of the pipeline, with the files that it names: what its meshes, animations, skins and images take,
// each as often as it is named.
inline constexpr uint64_t kModelMemory_bytes = 134217728, kModelMemoryAByte = 100;

// Points of a town, each as often as it is shown or placed: so many for any model, and more for each of its bytes.
inline constexpr uint64_t kFreeTownPoints = 4000000, kTownPointsAByte = 20;

// Triangles, and vertices, of a model's Draco data.
inline constexpr uint64_t kFreeDracoFaces = 100000, kDracoFacesAByte = 100;

inline constexpr size_t kMostPoses = 6000000;  // moments of a clip, each times the model's nodes and channels

// Of a pack's lists.
inline constexpr size_t kMostAvatars = 1000, kMostLevels = 32, kMostJoints = 1024;
inline constexpr size_t kMostElevations = 64;  // of an impostor's pictures
inline constexpr size_t kMostNodeDepth = 256;  // nodes in each other
inline constexpr size_t kMostObstacles = 200000, kMostObstaclePoints = 2000000;
inline constexpr size_t kMostPeople = 20000;              // of a scenario's own, each with goals; crowds may be larger
inline constexpr double kMostLayers = 100;                // times that the boxes about obstacles may cover the ground
inline constexpr double kMostCellsNearWalls = 100000000;  // of the grid that people walk by, each once a wall
inline constexpr size_t kMostPlaces = 10000, kMostStops = 1000, kMostHotspots = 1000, kMostStreets = 5000;
inline constexpr size_t kMostSounds = 1000;
inline constexpr size_t kMostText_bytes = 20000;  // of a caption or another text that visitors read
inline constexpr size_t kMostName_bytes = 500;

inline constexpr int64_t kMostSound_frames = 86400000;  // half an hour at 48 kHz; a longer one stays silent

// Of its numbers.
inline constexpr double kMostCoordinate_m = 1e6;                 // of anything's place
inline constexpr double kLeastCell_m = 0.01;                     // of a raster
inline constexpr double kMostCell_m = 100, kMostSide_m = 20000;  // of a raster, of all its cells beside each other
inline constexpr int kMostPictureSide_px = 16384;
inline constexpr double kLeastPerson_m = 0.05, kMostPerson_m = 50;  // height
inline constexpr double kMostPersonRadius_m = 5;
inline constexpr double kMostWalk_mps = 20;  // at which a walk clip's feet don't slide
inline constexpr double kMostShare = 1e6;
inline constexpr double kMostYaw_rad = 1000;
inline constexpr double kMostPause_s = 36000;
inline constexpr float kMostClip_s = 600;
inline constexpr float kMostReach_m = 20;  // of a person; what is farther out is a fault of the model

}  // namespace flaneur
