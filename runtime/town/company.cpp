#include "runtime/town/company.h"

#include "runtime/town/loitering.h"
#include "runtime/town/places.h"
#include "runtime/town/work.h"

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

void Send(size_t i, int field, Town* town) {
  StopLoitering(i, town);
  StopWork(i, town);
  const int place = PlaceOfField(field, town);
  if (place >= 0 && town->places[static_cast<size_t>(place)].kind == "loiter") PlanToLoiter(i, town);
  SetGoal(i, field, &town->crowd);
}

void SendAll(const Company& company, int field, Town* town) {
  for (int k = 0; k < company.size; ++k) Send(company.member[k], field, town);
}

}  // namespace flaneur
