// Who is in the crowd, and at which index.
#include <algorithm>
#include <cstring>
#include <type_traits>

#include "runtime/crowd/crowd.h"
#include "runtime/crowd/fast_math.h"
#include "runtime/crowd/groups.h"

namespace flaneur {
namespace {

constexpr float kCurveCell_m = 2;

// Every array that has an element a person.
template <typename Visit>
void VisitPersonArrays(Crowd* c, Visit visit) {
  visit(&c->id), visit(&c->slot), visit(&c->avatar), visit(&c->position), visit(&c->velocity), visit(&c->heading_rad);
  visit(&c->radius_m), visit(&c->reach_m), visit(&c->view_reach_m);
  visit(&c->preferred_mps), visit(&c->top_mps), visit(&c->field), visit(&c->way), visit(&c->sees_goal),
      visit(&c->corner);
  visit(&c->activity), visit(&c->wait_s), visit(&c->facing), visit(&c->view), visit(&c->was_visible),
      visit(&c->avoids_camera);
  visit(&c->arrived), visit(&c->detour), visit(&c->detour_s), visit(&c->walked_m), visit(&c->mind), visit(&c->coast);
  visit(&c->group), visit(&c->cares), visit(&c->turn), visit(&c->wanted), visit(&c->post), visit(&c->doing),
      visit(&c->sits);
}

// The bits of a number below 65,536, each followed by a zero.
uint64_t Spread(uint64_t bits) {
  bits = (bits | bits << 8) & 0x00ff00ff;
  bits = (bits | bits << 4) & 0x0f0f0f0f;
  bits = (bits | bits << 2) & 0x33333333;
  return (bits | bits << 1) & 0x55555555;
}

size_t IndexIn(uint64_t order) { return static_cast<size_t>(order & 0xffffffff); }

// Along Morton's curve; who shares a cell of it, by index.
void OrderAlongCurve(const Crowd& c, std::vector<uint64_t>* order) {
  Vec2 min = c.position.empty() ? Vec2{} : c.position[0];
  for (Vec2 p : c.position) min = {std::min(min.x, p.x), std::min(min.y, p.y)};
  const auto cell = [](float v_m) {
    return Spread(static_cast<uint64_t>(std::min(v_m * (1 / kCurveCell_m), 65535.0f)));
  };
  order->resize(c.size());
  for (size_t i = 0; i < c.size(); ++i) {
    const Vec2 off = c.position[i] - min;
    (*order)[i] = (cell(off.x) | cell(off.y) << 1) << 32 | i;
  }
  std::sort(order->begin(), order->end());
}

template <typename T>
void Permute(const std::vector<uint64_t>& order, std::vector<T>* values, std::vector<std::byte>* spare) {
  static_assert(std::is_trivially_copyable_v<T>);
  spare->resize(std::max(spare->size(), order.size() * sizeof(T)));
  for (size_t k = 0; k < order.size(); ++k)
    std::memcpy(spare->data() + k * sizeof(T), &(*values)[IndexIn(order[k])], sizeof(T));
  std::memcpy(values->data(), spare->data(), order.size() * sizeof(T));
}

}  // namespace

int AddPerson(const Person& p, Crowd* c) {
  c->id.push_back(c->next_id);
  c->slot.push_back(TakeSlot(c->next_id, &c->slots));
  c->avatar.push_back(p.avatar);
  c->position.push_back(p.position);
  c->velocity.push_back({});
  c->heading_rad.push_back(p.heading_rad);
  c->radius_m.push_back(p.radius_m);
  c->reach_m.push_back(std::max(p.reach_m, p.radius_m));
  c->view_reach_m.push_back(c->reach_m.back());
  c->preferred_mps.push_back(p.preferred_mps);
  c->top_mps.push_back(p.top_mps);
  c->field.push_back(p.field);
  c->way.push_back({});
  c->sees_goal.push_back(0);
  c->corner.push_back({});
  c->activity.push_back(p.field >= 0 ? Activity::kWalking : Activity::kStanding);
  c->wait_s.push_back(0);
  c->facing.push_back({});
  c->view.push_back(ViewClass::kOutside);
  c->was_visible.push_back(0);
  c->avoids_camera.push_back(0);
  c->arrived.push_back(Arrival::kNot);
  c->detour.push_back({});
  c->detour_s.push_back(0);
  c->walked_m.push_back(static_cast<float>(c->next_id % 16) * 0.1f);  // not all on the same foot
  c->mind.push_back({});
  c->mind.back().ahead = DirectionOf(p.heading_rad);
  c->coast.push_back(0);
  c->group.push_back(-1);
  c->cares.push_back(0);
  c->turn.push_back(0);
  c->wanted.push_back({});
  c->post.push_back(p.position);
  c->doing.push_back(-1);
  c->sits.push_back(0);
  return c->next_id++;
}

void RemovePerson(size_t i, Crowd* c) {
  LeaveGroup(i, c);
  GiveBackSlot(c->slot[i], &c->slots);
  const int last = static_cast<int>(c->size()) - 1, of_last = c->group.back();
  if (of_last >= 0) {
    Group& g = c->groups[static_cast<size_t>(of_last)];
    std::replace(g.member, g.member + g.size, last, static_cast<int>(i));
  }
  VisitPersonArrays(c, [i](auto* values) {
    (*values)[i] = values->back();
    values->pop_back();
  });
}

void SortBySpace(CrowdScratch* s, Crowd* c) {
  OrderAlongCurve(*c, &s->order);
  VisitPersonArrays(c, [s](auto* values) { Permute(s->order, values, &s->spare); });
  s->number.resize(c->size());
  for (size_t k = 0; k < c->size(); ++k) s->number[IndexIn(s->order[k])] = static_cast<int>(k);
  for (Group& g : c->groups) {
    for (int m = 0; m < g.size; ++m) g.member[m] = s->number[static_cast<size_t>(g.member[m])];
  }
}

}  // namespace flaneur
