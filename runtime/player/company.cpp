#include "runtime/player/company.h"

#include "runtime/player/loitering.h"
#include "runtime/player/places.h"

namespace flaneur {

Company CompanyOf(const Crowd& c, size_t i) {
  Company all;
  all.member[0] = i;
  if (c.group[i] < 0) return all;
  const Group& g = c.groups[static_cast<size_t>(c.group[i])];
  all.size = g.size;
  for (int k = 0; k < g.size; ++k) all.member[k] = static_cast<size_t>(g.member[k]);
  return all;
}

void Send(size_t i, int field, Simulation* s) {
  StopLoitering(i, s);
  const int place = PlaceOfField(field, s);
  if (place >= 0 && s->places[static_cast<size_t>(place)].kind == "loiter") PlanToLoiter(i, s);
  SetGoal(i, field, &s->crowd);
}

void SendAll(const Company& company, int field, Simulation* s) {
  for (int k = 0; k < company.size; ++k) Send(company.member[k], field, s);
}

}  // namespace flaneur
