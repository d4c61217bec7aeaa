// Dead ends and traps: what hangs on one way only, found as the bridges of the network of ways, and what a visitor cuts
// off by standing somewhere, found by taking the ways round them out of it.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <unordered_map>

#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/ways_parts.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

// Wider mouths, in high-resolution radii, are squares and forecourts: people keep clear of a visitor in them.
constexpr double kMaxMouthToRadius = 1.25;
constexpr double kFar = std::numeric_limits<double>::infinity();

size_t Index(int i) { return static_cast<size_t>(i); }

// Every node's shortest way to where people leave, and the tree of a depth-first search from there.
class Network {
 public:
  Network(const Rings& ground, double radius, const OpenTest& is_open, const std::vector<Gate>& gates)
      : graph(BuildWayNetwork(ground, radius - 0.0005, is_open)),
        safe(graph.nodes.size()),
        exit(graph.nodes.size()),
        gate(graph.nodes.size()) {
    for (size_t i = 0; i < graph.nodes.size(); ++i)
      safe[i] = exit[i] = graph.nodes[i].open, open |= graph.nodes[i].open;
    for (const Gate& place : gates) AddGate(place);
    FindWaysOut(exit, &to_exit, &next);
    if (safe != exit) FindWaysOut(safe, nullptr, &next);
    Search();
  }

  WayNetwork graph;
  std::vector<uint8_t> safe, exit, gate;  // safe: an exit or a door; gate: not by being open
  std::vector<double> to_exit;            // metres; infinite where there is no way
  std::vector<int> next;                  // towards the nearest door or exit; -1: there, or no way
  std::vector<int> parent, order;         // of the search
  std::vector<uint8_t> bridge;            // the way from the parent is the only one
  std::vector<double> deepest;            // in the subtree: to_exit and clearance of its farthest node
  std::vector<int> deepest_node;
  std::vector<double> size_m2;  // about, of the ground in the subtree
  double whole_m2 = 0;
  bool open = false;  // people leave over the edge, and there is more ground beyond

 private:
  // Whoever comes out can go straight to the ways in whose free circle they stand.
  void AddGate(const Gate& place) {
    int best = -1;
    double least = kFar;
    for (size_t i = 0; i < graph.nodes.size(); ++i) {
      const WayNode& node = graph.nodes[i];
      const double d = std::hypot(node.at.x - place.at_m.x, node.at.y - place.at_m.y) - node.clearance_m;
      if (d < kGateReach_m) Mark(i, place);
      if (d < least) least = d, best = static_cast<int>(i);
    }
    if (best >= 0) Mark(Index(best), place);
  }

  void Mark(size_t node, const Gate& place) {
    safe[node] = gate[node] = 1;
    exit[node] |= place.is_exit;
  }

  void FindWaysOut(const std::vector<uint8_t>& goals, std::vector<double>* distance, std::vector<int>* towards) const {
    std::vector<double> own;
    std::vector<double>& d = distance ? *distance : own;
    d.assign(graph.nodes.size(), kFar);
    if (towards) towards->assign(graph.nodes.size(), -1);
    using Item = std::pair<double, int>;
    std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
    for (size_t i = 0; i < goals.size(); ++i)
      if (goals[i]) d[i] = 0, queue.push({0, static_cast<int>(i)});
    while (!queue.empty()) {
      const auto [length, node] = queue.top();
      queue.pop();
      if (length > d[Index(node)]) continue;
      for (const int way : graph.nodes[Index(node)].ways) {
        const int other = graph.Other(way, node);
        const double longer = length + graph.ways[Index(way)].length_m;
        if (longer >= d[Index(other)]) continue;
        d[Index(other)] = longer;
        if (towards) (*towards)[Index(other)] = node;
        queue.push({longer, other});
      }
    }
  }

  // Tarjan's bridges, from a node 0 that all exits hang on.
  void Search() {
    const size_t n = graph.nodes.size();
    parent.assign(n, -1), bridge.assign(n, 0), deepest.assign(n, 0), deepest_node.assign(n, -1), size_m2.assign(n, 0);
    for (const WayEdge& way : graph.ways) {
      const double area =
          way.length_m * (graph.nodes[Index(way.from)].clearance_m + graph.nodes[Index(way.to)].clearance_m);
      size_m2[Index(way.from)] += area / 2, size_m2[Index(way.to)] += area / 2;
    }
    std::vector<int> position(n, 0), low(n, 0), arrived_by(n, -1);
    std::vector<size_t> tried(n, 0);
    std::vector<int> stack;
    const auto enter = [&](int node) {
      order.push_back(node);
      position[Index(node)] = Count(order);
      low[Index(node)] = exit[Index(node)] ? 0 : position[Index(node)];
      stack.push_back(node);
    };
    for (size_t start = 0; start < n; ++start) {
      if (!exit[start] || position[start] > 0) continue;
      const size_t first = order.size();
      enter(static_cast<int>(start));
      while (!stack.empty()) {
        const int node = stack.back();
        const std::vector<int>& ways = graph.nodes[Index(node)].ways;
        if (tried[Index(node)] == ways.size()) {
          stack.pop_back();
          Close(node, position, &low);
          continue;
        }
        const int way = ways[tried[Index(node)]++], other = graph.Other(way, node);
        if (way == arrived_by[Index(node)]) continue;
        if (position[Index(other)] > 0) {
          low[Index(node)] = std::min(low[Index(node)], position[Index(other)]);
          continue;
        }
        parent[Index(other)] = node, arrived_by[Index(other)] = way;
        enter(other);
      }
      for (size_t i = first; i < order.size(); ++i)
        if (parent[Index(order[i])] < 0) whole_m2 += size_m2[Index(order[i])];
    }
  }

  void Close(int node, const std::vector<int>& position, std::vector<int>* low) {
    const size_t i = Index(node);
    const double own = to_exit[i] + graph.nodes[i].clearance_m;
    if (own > deepest[i]) deepest[i] = own, deepest_node[i] = node;
    if (parent[i] < 0) return;
    const size_t up = Index(parent[i]);
    bridge[i] = (*low)[i] > position[up];
    (*low)[up] = std::min((*low)[up], (*low)[i]);
    size_m2[up] += size_m2[i];
    if (deepest[i] > deepest[up]) deepest[up] = deepest[i], deepest_node[up] = deepest_node[i];
  }
};

class NetworkCheck {
 public:
  NetworkCheck(const Network& network, const BrokenPlaces& broken, const Placed& placed, CheckState* state)
      : net_(network), broken_(broken), placed_(placed), state_(*state) {
    for (size_t i = 0; i < net_.graph.nodes.size(); ++i)
      cells_[Cell(net_.graph.nodes[i].at)].push_back(static_cast<int>(i));
    mark_.assign(net_.graph.nodes.size(), 0), verdict_.assign(net_.graph.nodes.size(), 0);
  }

  void Run() {
    FindPockets();
    FindTraps();
  }

 private:
  double Depth(int node) const { return net_.deepest[Index(node)] - net_.to_exit[Index(node)]; }
  double Width(int node) const { return 2 * net_.graph.nodes[Index(node)].clearance_m; }
  Point2 At(int node) const { return net_.graph.nodes[Index(node)].at; }
  double MaxMouth() const { return kMaxMouthToRadius * Radius(); }
  double Radius() const { return state_.options.high_resolution_radius_m; }

  // Ground with one mouth that is narrower than the ground is deep, and than what one visitor closes; in a walled town
  // less than half of all ground.
  void FindPockets() {
    pocket_.assign(net_.graph.nodes.size(), -1);
    for (const int node : net_.order) {
      const int up = net_.parent[Index(node)];
      if (up >= 0 && pocket_[Index(up)] >= 0) {
        pocket_[Index(node)] = pocket_[Index(up)];
        continue;
      }
      if (up < 0 || !net_.bridge[Index(node)]) continue;
      const int mouth = MouthFrom(node);
      if (Depth(mouth) <= Width(mouth) || Width(mouth) > MaxMouth()) continue;
      if (mouth != node) continue;  // told when the search comes to it
      if (!net_.open && 2 * net_.size_m2[Index(node)] > net_.whole_m2)
        continue;  // the town itself, behind its only gate
      pocket_[Index(node)] = node;
    }
    std::unordered_map<int, bool> in_doubt;  // by pocket
    for (const int node : net_.order)
      if (pocket_[Index(node)] >= 0) in_doubt[pocket_[Index(node)]] |= InDoubt(node);
    for (const int node : net_.order) {
      if (pocket_[Index(node)] < 0) continue;
      if (in_doubt[pocket_[Index(node)]]) told_pockets_[pocket_[Index(node)]] = true;
      else if (pocket_[Index(node)] == node && Depth(node) > state_.options.dead_end_m) ReportDeadEnd(node);
    }
  }

  bool InDoubt(int node) const { return broken_.Near(At(node), net_.graph.nodes[Index(node)].clearance_m); }

  // On along the only way, as long as it narrows.
  int MouthFrom(int node) const {
    const double most = net_.graph.nodes[Index(node)].clearance_m;
    double gone = 0;
    for (int at = node;;) {
      int only = -1, count = 0;
      for (const int way : net_.graph.nodes[Index(at)].ways) {
        const int other = net_.graph.Other(way, at);
        if (net_.parent[Index(other)] == at) only = other, ++count;
      }
      if (count != 1 || !net_.bridge[Index(only)]) return at;
      const double length = std::hypot(At(only).x - At(at).x, At(only).y - At(at).y);
      gone += length;
      if (gone > most || Width(at) - Width(only) <= 2 * kMinNarrowing * length) return at;
      at = only;
    }
  }

  void ReportDeadEnd(int mouth) {
    const Point2 end = At(net_.deepest_node[Index(mouth)]);
    state_.Add(502, NearestName(placed_, end), end, Depth(mouth), state_.options.dead_end_m,
               Metres(Depth(mouth)) + " deep, behind a mouth of " + Metres(Width(mouth)));
  }

  // ---- 503 ----

  static constexpr double kCell_m = 10;
  static int64_t Cell(Point2 p) {
    return CellOf(static_cast<int64_t>(std::floor(p.x / kCell_m)), static_cast<int64_t>(std::floor(p.y / kCell_m)));
  }
  static int64_t CellOf(int64_t x, int64_t y) { return x * 4'000'037 + y; }

  void FindTraps() {
    std::unordered_map<int64_t, bool> tried;
    std::vector<uint8_t> told(net_.graph.nodes.size(), 0);
    for (const int node : net_.order) {
      const Point2 p = At(node);
      const bool in_pocket = pocket_[Index(node)] >= 0;
      const int64_t place = static_cast<int64_t>(std::floor(p.x / kStandEvery_m)) * 40'000'003 +
                            static_cast<int64_t>(std::floor(p.y / kStandEvery_m));
      if (!in_pocket && 2 * net_.graph.nodes[Index(node)].clearance_m > MaxMouth()) continue;
      if (!in_pocket && !tried.try_emplace(place, true).second) continue;
      Stand(node, &told);
    }
  }

  // Takes the ways that the circle covers from wall to wall out, and looks at what is left round them. Inside a pocket
  // the visitor stands in the middle of the way; elsewhere the way may pass at one side.
  void Stand(int visitor, std::vector<uint8_t>* told) {
    ++stamp_;
    visitor_ = visitor;
    const Point2 p = At(visitor);
    inside_.clear();
    const auto low_x = static_cast<int64_t>(std::floor((p.x - Radius()) / kCell_m)),
               high_x = static_cast<int64_t>(std::floor((p.x + Radius()) / kCell_m));
    const auto low_y = static_cast<int64_t>(std::floor((p.y - Radius()) / kCell_m)),
               high_y = static_cast<int64_t>(std::floor((p.y + Radius()) / kCell_m));
    const bool in_pocket = pocket_[Index(visitor)] >= 0;
    for (int64_t x = low_x; x <= high_x; ++x) {
      for (int64_t y = low_y; y <= high_y; ++y) {
        const auto cell = cells_.find(CellOf(x, y));
        if (cell == cells_.end()) continue;
        for (const int node : cell->second) {
          const double dx = At(node).x - p.x, dy = At(node).y - p.y, c = net_.graph.nodes[Index(node)].clearance_m;
          const double d2 = dx * dx + dy * dy, left = Radius() - c;
          if (in_pocket ? d2 + c * c > Radius() * Radius() : 2 * c > MaxMouth() || d2 > left * left) continue;
          if (!in_pocket && net_.gate[Index(node)]) return;  // at a door everybody can be kept out of it
          mark_[Index(node)] = stamp_, inside_.push_back(node);
        }
      }
    }
    for (const int node : inside_)
      for (const int way : net_.graph.nodes[Index(node)].ways)
        if (const int other = net_.graph.Other(way, node); mark_[Index(other)] != stamp_) Judge(other, told);
  }

  bool Inside(int node) const { return mark_[Index(node)] == stamp_; }
  // Verdicts of this stand: 2 * stamp: unknown way out; 2 * stamp + 1: leads out.
  bool LeadsOut(int start) {
    walk_.clear();
    bool out = false;
    for (int node = start;;) {
      if (Inside(node)) break;
      if (verdict_[Index(node)] == 2 * stamp_ + 1) {
        out = true;
        break;
      }
      if (verdict_[Index(node)] == 2 * stamp_) break;
      walk_.push_back(node);
      if (net_.safe[Index(node)]) {
        out = true;
        break;
      }
      const int on = net_.next[Index(node)];
      if (on < 0) break;
      node = on;
    }
    for (const int node : walk_) verdict_[Index(node)] = 2 * stamp_ + (out ? 1 : 0);
    return out;
  }

  void Judge(int start, std::vector<uint8_t>* told) {
    if (net_.to_exit[Index(start)] == kFar) return;  // out of reach as it is: 501
    if (LeadsOut(start) || (*told)[Index(start)]) return;
    part_.assign(1, start);
    std::vector<uint8_t>& in_part = in_part_;
    in_part.resize(net_.graph.nodes.size());
    in_part[Index(start)] = 1;
    bool out = false;
    for (size_t i = 0; i < part_.size() && !out; ++i) {
      for (const int way : net_.graph.nodes[Index(part_[i])].ways) {
        const int other = net_.graph.Other(way, part_[i]);
        if (Inside(other) || in_part[Index(other)]) continue;
        if (LeadsOut(other)) {
          out = true;
          break;
        }
        in_part[Index(other)] = 1;
        part_.push_back(other);
      }
    }
    for (const int node : part_) {
      in_part[Index(node)] = 0;
      if (out) verdict_[Index(node)] = 2 * stamp_ + 1;
    }
    if (!out) ReportTrap(told);
  }

  // From inside a pocket all that lies beyond the circle counts, as long as two people can stand there; from anywhere
  // else only what is deeper than the radius, lest every niche and corner that a circle happens to close be a trap.
  void ReportTrap(std::vector<uint8_t>* told) {
    const int pocket = pocket_[Index(visitor_)];
    double farthest = 0, area = 0;
    int end = part_[0];
    bool in_pocket = pocket >= 0;
    for (const int node : part_) {
      const double d = std::hypot(At(node).x - At(visitor_).x, At(node).y - At(visitor_).y) +
                       net_.graph.nodes[Index(node)].clearance_m - Radius();
      if (d > farthest) farthest = d, end = node;
      in_pocket &= pocket_[Index(node)] == pocket;
      for (const int way : net_.graph.nodes[Index(node)].ways)
        area += net_.graph.ways[Index(way)].length_m * Width(node) / 2;
    }
    const double width = Width(end);
    area = std::max(area, farthest * width);
    if (area < state_.options.least_ground_m2 || farthest < 4 * state_.options.person_radius_m ||
        (!in_pocket && farthest <= Radius()))
      return;
    for (const int node : part_)
      if ((*told)[Index(node)] || (!in_pocket && InDoubt(node))) return;
    // The whole pocket is one trap.
    if (in_pocket && told_pockets_.count(pocket)) return;
    if (in_pocket) told_pockets_[pocket] = true;
    for (const int node : part_) (*told)[Index(node)] = 1;
    state_.Add(503, NearestName(placed_, At(end)), At(end), farthest, 0,
               "a visitor at (" + Number(At(visitor_).x) + ", " + Number(At(visitor_).y) + ") cuts off " +
                   Metres(farthest) + " of way without a door or an exit");
  }

  static std::string Number(double v) {
    char text[40];
    std::snprintf(text, sizeof text, "%.1f", v);
    return text;
  }

  const Network& net_;
  const BrokenPlaces& broken_;
  const Placed& placed_;
  CheckState& state_;
  std::unordered_map<int64_t, std::vector<int>> cells_;
  std::vector<int> pocket_;  // by node: its outermost pocket's mouth, or -1
  std::unordered_map<int, bool> told_pockets_;
  std::vector<int64_t> mark_, verdict_;
  std::vector<uint8_t> in_part_;
  std::vector<int> inside_, walk_, part_;
  int64_t stamp_ = 0;
  int visitor_ = 0;
};

}  // namespace

void CheckNetwork(const Rings& ground, const OpenTest& is_open, const std::vector<Gate>& gates,
                  const BrokenPlaces& broken, const Placed& placed, CheckState* state) {
  const Network network(ground, state->options.person_radius_m, is_open, gates);
  if (!network.graph.nodes.empty()) NetworkCheck(network, broken, placed, state).Run();
}

}  // namespace flaneur
