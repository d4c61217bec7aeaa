// Detour's crowd in the open field of crowd_bench.cpp, for comparison: the same places, people, speeds and steps.
#include <DetourCrowd.h>
#include <DetourNavMesh.h>
#include <DetourNavMeshBuilder.h>
#include <DetourNavMeshQuery.h>
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "tests/bench/time_steps.h"
#include "tests/unit/runtime/crowd/open_field.h"

namespace flaneur {
namespace {

// Ground plane x, y is Detour's x, z. Each obstacle stands in a square hole of a mesh of squares.
constexpr float kSquare_m = 4;

struct DetourField {
  std::unique_ptr<dtNavMesh, void (*)(dtNavMesh*)> mesh{nullptr, dtFreeNavMesh};
  std::unique_ptr<dtCrowd, void (*)(dtCrowd*)> crowd{nullptr, dtFreeCrowd};
};

bool Blocked(const OpenField& field, int x, int y) {
  for (const CircleObstacle& c : field.walkable.circles) {
    const Vec2 near{std::clamp(c.center.x, static_cast<float>(x) * kSquare_m, static_cast<float>(x + 1) * kSquare_m),
                    std::clamp(c.center.y, static_cast<float>(y) * kSquare_m, static_cast<float>(y + 1) * kSquare_m)};
    if (Length(near - c.center) < c.radius_m) return true;
  }
  return false;
}

dtNavMesh* MakeMesh(const OpenField& field) {
  const int aside = static_cast<int>(field.side_m / kSquare_m);
  std::vector<unsigned short> vertices, polygons, flags;
  std::vector<unsigned char> areas;
  std::vector<int> number(static_cast<size_t>(aside * aside), -1);
  const auto at = [&](int x, int y) {
    return x < 0 || y < 0 || x >= aside || y >= aside ? -1 : number[static_cast<size_t>(y * aside + x)];
  };
  int count = 0;
  for (int y = 0; y < aside; ++y) {
    for (int x = 0; x < aside; ++x) {
      if (!Blocked(field, x, y)) number[static_cast<size_t>(y * aside + x)] = count++;
    }
  }
  for (int y = 0; y <= aside; ++y) {
    for (int x = 0; x <= aside; ++x) {
      for (int v : {x, 0, y}) vertices.push_back(static_cast<unsigned short>(v));
    }
  }
  const auto vertex = [&](int x, int y) { return static_cast<unsigned short>(y * (aside + 1) + x); };
  for (int y = 0; y < aside; ++y) {
    for (int x = 0; x < aside; ++x) {
      if (at(x, y) < 0) continue;
      for (unsigned short v : {vertex(x, y), vertex(x, y + 1), vertex(x + 1, y + 1), vertex(x + 1, y)})
        polygons.push_back(v);
      for (int other : {at(x - 1, y), at(x, y + 1), at(x + 1, y), at(x, y - 1)}) {
        polygons.push_back(other < 0 ? 0xffff : static_cast<unsigned short>(other));
      }
      areas.push_back(0);
      flags.push_back(1);
    }
  }
  dtNavMeshCreateParams p{};
  p.verts = vertices.data();
  p.vertCount = static_cast<int>(vertices.size() / 3);
  p.polys = polygons.data();
  p.polyAreas = areas.data();
  p.polyFlags = flags.data();
  p.polyCount = count;
  p.nvp = 4;
  p.walkableHeight = 2, p.walkableRadius = 0.25f, p.walkableClimb = 0.5f;
  p.cs = kSquare_m, p.ch = 1;
  p.bmax[0] = p.bmax[2] = static_cast<float>(aside) * kSquare_m;
  p.bmax[1] = 1;
  p.buildBvTree = true;
  unsigned char* data = nullptr;
  int size = 0;
  if (!dtCreateNavMeshData(&p, &data, &size)) return nullptr;
  dtNavMesh* mesh = dtAllocNavMesh();
  if (dtStatusFailed(mesh->init(data, size, DT_TILE_FREE_DATA))) return nullptr;
  return mesh;
}

void Send(const OpenField& field, int place, int agent, dtCrowd* crowd) {
  const float near[3] = {3, 3, 3};
  const Vec2 goal = field.places[static_cast<size_t>(place)];
  const float wanted[3] = {goal.x, 0, goal.y};
  float point[3];
  dtPolyRef polygon = 0;
  crowd->getNavMeshQuery()->findNearestPoly(wanted, near, crowd->getFilter(0), &polygon, point);
  crowd->requestMoveTarget(agent, polygon, point);
}

DetourField MakeDetourField(const OpenField& field) {
  DetourField d;
  d.mesh.reset(MakeMesh(field));
  d.crowd.reset(dtAllocCrowd());
  if (!d.mesh || !d.crowd->init(static_cast<int>(field.crowd.size()), 0.25f, d.mesh.get())) return {};
  for (size_t i = 0; i < field.crowd.size(); ++i) {
    dtCrowdAgentParams p{};
    p.radius = field.crowd.radius_m[i];
    p.height = 1.8f;
    p.maxAcceleration = 2.5f;
    p.maxSpeed = field.crowd.preferred_mps[i];
    p.collisionQueryRange = 3;
    p.pathOptimizationRange = 30 * p.radius;
    p.separationWeight = 2;
    p.updateFlags = DT_CROWD_ANTICIPATE_TURNS | DT_CROWD_OBSTACLE_AVOIDANCE | DT_CROWD_SEPARATION;
    p.obstacleAvoidanceType = 3;
    const float position[3] = {field.crowd.position[i].x, 0, field.crowd.position[i].y};
    Send(field, field.crowd.field[i], d.crowd->addAgent(position, &p), d.crowd.get());
  }
  return d;
}

void DetourStep(benchmark::State& state) {
  OpenField field = MakeOpenField(static_cast<int>(state.range(0)));
  DetourField d = MakeDetourField(field);
  if (!d.crowd) {
    state.SkipWithError("Detour cannot hold this field");
    return;
  }
  std::vector<int> place = field.crowd.field;
  const auto step = [&] {
    d.crowd->update(kOpenFieldStep_s, nullptr);
    for (int i = 0; i < d.crowd->getAgentCount(); ++i) {
      const float* at = d.crowd->getAgent(i)->npos;
      const Vec2 left = field.places[static_cast<size_t>(place[static_cast<size_t>(i)])] - Vec2{at[0], at[2]};
      if (Dot(left, left) >= std::max(0.25f, field.turn_round_m * field.turn_round_m)) continue;
      place[static_cast<size_t>(i)] = SomePlace(&field);
      Send(field, place[static_cast<size_t>(i)], i, d.crowd.get());
    }
  };
  // It grants 8 ways a step: once everybody could have got one, it is as busy as it gets.
  const int start_steps = static_cast<int>(state.range(0)) / 8 + 100;
  for (int k = 0; k < start_steps; ++k) step();
  int walking = 0;
  for (int i = 0; i < d.crowd->getAgentCount(); ++i) {
    walking += d.crowd->getAgent(i)->targetState == DT_CROWDAGENT_TARGET_VALID ? 1 : 0;
  }
  state.counters["walking"] = walking;
  TimeSteps(state, step);
}
BENCHMARK(DetourStep)->Arg(1000)->Arg(10000)->Iterations(30)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flaneur
