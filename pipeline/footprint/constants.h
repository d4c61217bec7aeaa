// Tuned numbers of the footprints and their check, each with its unit and reason. What a user may set stands in
// FootprintOptions (extract_footprints.h) and CheckOptions (check.h).
#pragma once
#include <cstddef>

namespace flaneur {

// Which objects of a scene are ground.
inline constexpr double kMaxFlatHeight_m = 0.15;  // a node no higher than this,
inline constexpr double kMinFlatWidth_m = 1.0;    // and wider than this is ground to walk on
// Flat things that cover less than this share of what houses do are no town's ground, where it has no other.
inline constexpr double kMinGroundToHouses = 0.2;
// What is higher than this share of its length is no ground, whatever its name: mountain_grass, Square Tower.
inline constexpr double kMaxGroundSteepness = 0.3;

// Towns that are not in metres.
inline constexpr double kMaxObject_m = 100'000;  // wide; beyond, coordinates lose millimetres
inline constexpr double kMaxGround_m = 100'000;  // wide
inline constexpr double kMinHouse_m = 0.5;       // wide, half of a town's buildings at least
inline constexpr double kMinLargest_m = 2.5;     // wide or high, one in ten of them at least
inline constexpr double kMaxHouse_m = 500;       // wide, half of them at most
inline constexpr double kMaxHeight_m = 150;      // high, half of them at most
inline constexpr double kMaxOfOne_m = 5'000;     // wide, a town that is one thing; and a tenth as high

// Trees and lamps.
inline constexpr double kTrunkTop_m = 1.2;  // over the ground: crowns and lanterns begin above
inline constexpr double kMinTrunk_m = 0.3;  // of the band at least

// The ground.
inline constexpr int kSmoothingRounds = 30;     // over the heights of cells without ground
inline constexpr double kMaxSlopeStep_m = 0.5;  // higher steps between neighbouring cells are no slope
inline constexpr double kMinGroundHole_m2 = 1;  // smaller holes of the ground are nobody's obstacle
inline constexpr double kBaseCell_m = 0.25;     // of the raster under an object without ground
inline constexpr double kMaxBaseCells = 1e6;    // of one object; the cells become larger
inline constexpr double kOverhang_m = 3;        // half the width of what may hang over lower parts
// What varies by less is taken for level: a band from the lowest point finds all walls.
inline constexpr float kLevelGround_m = 0.3f;
inline constexpr float kMinTerraceStep_m = 0.1f;  // lower steps are none
inline constexpr double kMaxWallSlope = 0.3;      // of a wall's normal, what points up
inline constexpr double kMinLevelShare = 0.9;     // of a floor's normal, what points up or down
inline constexpr double kMaxHangingShare = 0.4;   // of a floor's border may lie over lower parts
inline constexpr double kMaxFreeShare = 0.1;      // of a floor's border may end in the air
inline constexpr float kPassageHeight_m = 2;      // over the floor beside it: a ceiling, no terrace
inline constexpr double kEaves_m = 1.5;           // walls farther than this under something stand inside

// Cutting to the band over the ground.
inline constexpr double kBandGrid_m = 0.001;        // to which cuts are rounded
inline constexpr double kMaxBend_m = 0.01;          // the ground may leave an edge's straight line by this much
inline constexpr double kMinSplitEdge_m = 0.25;     // shorter edges are not split
inline constexpr double kThinPart_m = 0.002;        // parts thinner than this in plan are drawn as one line
inline constexpr double kOnLongerLine_m = 0.001;    // lines this near to longer ones belong to them
inline constexpr double kMinLineOverlap_m = 0.003;  // of two lines that are parts of one

// Walls that do not close.
inline constexpr double kRoofedShare = 0.5;         // of a region's area must lie under something
inline constexpr size_t kMinRoofSamples = 16;       // of a region, to see whether it is roofed
inline constexpr double kRoofSampleArea_m2 = 0.25;  // that one sample of a region stands for at most
inline constexpr double kMaxOpenShell_m = 1.0;      // of wall without anything solid beside it, in a building
inline constexpr double kMinLoosePiece_m = 0.02;    // of lines without area that lead nowhere
inline constexpr double kNoWay_m = 0.5;             // nobody passes a gap in a building narrower than this
inline constexpr double kOnOutline_m = 0.002;       // lines this near to something solid are its outline
inline constexpr double kMaxMouth_m = 20;           // between walls that enclose a room but for it
inline constexpr double kMaxMouthShare = 0.2;       // of a room's outline
inline constexpr double kMinRoomToMouth = 1.1;      // a room is so many times as wide as its mouth
inline constexpr size_t kMaxWallEnds = 40;  // of walls that lead nowhere; with more nobody knows which belong together
inline constexpr double kOnWall_m = 0.01;   // a mouth whose middle is this near to a room's outline is its own
inline constexpr double kSameCorner_m = 0.001;  // corners this near are one,
inline constexpr double kTornCorner_m = 0.005;  // where a surface ends at both, also those
// Thinner triangles close nothing; corners this near in plan stand over each other.
inline constexpr double kThinTriangle_m = 0.02;
inline constexpr double kFoot_m = 0.3;              // how far a wall's foot may go up and down
inline constexpr size_t kMaxHoleEdges = 8;          // edges round a hole; longer ones are openings
inline constexpr double kFlatHole_m = 0.02;         // corners of a plane hole leave its plane by no more
inline constexpr double kMinOverheadCell_m = 0.05;  // of the grid that finds what is overhead
inline constexpr double kMaxOverheadEntries = 6;    // for each triangle; larger cells hold fewer

inline constexpr double kMinBuried_m2 = 0.5;  // smaller parts beneath the terrain are not worth a word

// Between pieces of ground, that people step over where both sides are so alike in height.
inline constexpr double kMaxCrack_m = 0.5, kMaxCrackStep_m = 0.35;

// Bridges.
inline constexpr double kMaxPylon_m = 4;         // wide; what is wider and carries the deck is walked over
inline constexpr double kMinDeck_m = 2;          // wide; narrower tops are those of pylons and parapets
inline constexpr double kMaxDeckSlope_m = 0.35;  // a deck this near to the ground in height leads on to it
inline constexpr double kDeckMouth_m = 0.6;      // before its end the ground is looked at

// What walls do not quite enclose, on a building's ground.
inline constexpr double kMinWalledGround = 0.7;  // of its outline is walls, where the model says that it is ground
inline constexpr double kMinWalledFloor = 0.85;  // likewise on a floor that was found
inline constexpr double kMinWalledLost = 0.3;    // likewise in a town that has lost triangles
inline constexpr double kMinFloor = 0.2;         // of a building lies over its floor
inline constexpr double kMinPlainFloor =
    0.999;  // times what is not upright over them: the lowest faces are all of a floor
inline constexpr double kMinFloorLost = 0.15;   // likewise in a town that has lost triangles
inline constexpr double kMinFloorOfStrips = 4;  // times what walls that lean by a hair cover of it
inline constexpr double kMinLostShare = 0.01;  // of a town's triangles missing singly, and others with their neighbours
inline constexpr int kMinLostTriangles = 5;    // and so many at least: the town has lost triangles

// Holes that are none.
inline constexpr double kMinWalledHole = 0.5;  // of a yard's outline is walls, else it is a part below the band
inline constexpr double kMaxOffGround = 0.02;  // of a hole lies beside the building's ground surface, else it is none
inline constexpr double kRoofOverFloor_m = 0.03;  // what lies so little over the ground is its floor

// Houses beside each other.
inline constexpr double kSeamInPlan_m = 0.0005;  // cracks between triangles of one surface
inline constexpr double kMinClaim_m2 = 0.05;     // of another house's ground; less is untidiness
inline constexpr double kStripe_m = 0.1;         // what is narrower goes to the house that it lies against
inline constexpr double kSameGround_m = 1;       // a house without walls stands on ground no farther off than this
inline constexpr double kBlockReach_m = 0.1;     // houses nearer than this are looked at together
inline constexpr double kMinPiece_m2 = 0.01;     // what clipping leaves over that is smaller is dropped
inline constexpr double kMinGap_m2 = 0.01;       // of a block that no single house accounts for
inline constexpr double kSliver_m = 0.022;       // strips narrower than this that neighbours leave over are dropped
inline constexpr double kSlit_m = 0.4;           // narrower yards are none
inline constexpr double kSamePoint_m = 0.0011;   // points of a ring this near are one: nearer than 1 mm is an error
// Half the thickness of a wall without any, at least: thinner ones are slivers, but for those beside something solid.
inline constexpr double kThinWall_m = 0.0125, kThinSeam_m = 0.001;
inline constexpr double kMinStrip_m2 = 1e-4;     // of those that go to a neighbour instead
inline constexpr double kMinOverlap_m2 = 0.005;  // less is none, half of what the check finds
inline constexpr double kAgainst_m = 0.0005;     // strips nearer than this to a neighbour lie against it
inline constexpr double kJoint_m = 1.5;          // houses that overlap by less are meant to touch

// Segments in a grid.
inline constexpr double kMinCutCell_m = 0.1;  // for cutting: about as long as the segments
inline constexpr double kMaxCutCell_m = 2;    // for cutting: about as long as the segments
inline constexpr size_t kFewSegments = 40;    // looking at all of so few is faster than to sort them into cells
inline constexpr double kPointGrid_m = 1e-4;  // to which points are rounded
// A point this near to a segment is on it: rounding may have moved it so far.
inline constexpr double kTouching_m = 0.6e-4;
// Rounding may make pieces cross anew; what is left then is cut exactly elsewhere.
inline constexpr int kCuttingRounds = 4;

// Check: rings.
inline constexpr double kTouch_m = 1e-6;              // edges this near touch
inline constexpr double kHairline_rad = 1e-4;         // sharper spikes have no area to speak of
inline constexpr double kOpeningRounding_m = 0.0005;  // the opening's own, along every edge
inline constexpr double kSpikeMiter = 20;             // corners down to 6 degrees survive the opening
// A crossing ring runs the wrong way where that many times more of it does.
inline constexpr double kMinTurnedRatio = 20;
inline constexpr size_t kMaxCrossings = 64;   // that are listed of a ring
inline constexpr size_t kManyPoints = 100;    // times most_points: larger rings are only counted
inline constexpr size_t kMaxNearEdges = 512;  // larger rings are opened without asking whether that can matter

// Check: pairs, and obstacles against the town.
inline constexpr double kSameShare = 0.99;           // of the area of both: a duplicate
inline constexpr double kWallSampleStep_m = 0.5;     // along walls, where gaps at corners are filled by others
inline constexpr double kMinMissingShare = 0.5;      // of a building's area uncovered: it has no obstacle
inline constexpr double kMaxStrangeShare = 0.05;     // of an obstacle's area on buildings: less, and it has no building
inline constexpr double kOutlineRounding_m = 0.002;  // of outlines that were offset on a grid
inline constexpr double kMinFinding_m2 = 0.001;      // smaller pieces are rounding
inline constexpr double kMinWallFinding_m = 0.005;   // shorter pieces of a wall likewise
inline constexpr double kSeam_m = 0.0125;  // cracks between neighbours up to twice this are nobody's way, and welded
inline constexpr double kNearWall_m = 1;   // obstacles farther from a building are not compared with it
inline constexpr double kArcTolerance_m = 0.003;  // of round corners
inline constexpr int kCircleCorners = 64;         // of a circle as a polygon

// Check: ways.
inline constexpr double kFreeMargin_m = 3;     // round the obstacles, where there is no town
inline constexpr double kMinLargeShare = 0.1;  // of all free ground: more, and it is no courtyard
inline constexpr double kMaxNook_m2 = 4;       // cut off by narrow gaps, but nobody misses it
inline constexpr double kWaySlack_m = 0.0005;  // a way exactly as wide as a person counts as open
inline constexpr double kStandEvery_m = 4;     // places where a visitor is tried
inline constexpr double kGateReach_m = 0.1;    // beyond a way's free circle
inline constexpr double kMinNarrowing = 0.1;   // a way that narrows faster than this is still coming to its mouth
// Ground up to this wide is drawn on a grid of 0.1 mm (32 bits), else of 1 mm.
inline constexpr double kMaxFineGround_m = 200'000;
inline constexpr double kRowHeight_m = 2;           // of the rows in which ways are looked for
inline constexpr double kNodeStep_m = 2.5;          // between nodes, at most (more where the way is wide),
inline constexpr double kMaxNodeSteps = 1000;       // but no more than this many along one edge of the diagram
inline constexpr double kPassageStep_m = 0.1;       // of samples in narrow places
inline constexpr double kMaxPassageSamples = 3000;  // more, and they stand further apart
inline constexpr int kPassageDirections = 16;       // of lines through a sample
inline constexpr int kMaxAskedSamples = 60;         // samples asked for walls beside them
inline constexpr double kMinWalledShare = 0.25;     // of them that must have some

}  // namespace flaneur
