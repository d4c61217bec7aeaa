/* People cross a square with a fountain and a house while a visitor walks through and looks around. Each second one
   line: how many are in view, and with which level of detail they are drawn. */
#include <math.h>
#include <stdio.h>

#include <flaneur/crowd.h>

#define PEOPLE 150
#define SIZE_M 60.0
#define SECONDS 20

/* Corners and middles of the square's sides, where people come from and go to. */
static const FlaneurPoint gates_m[] = {{3, 3}, {30, 3}, {57, 3}, {57, 30}, {57, 57}, {30, 57}, {3, 57}, {3, 30}};
#define GATES (int)(sizeof gates_m / sizeof *gates_m)

static int check(FlaneurStatus status) {
  if (status != FLANEUR_OK) fprintf(stderr, "crowd_in_square: error: %s\n", flaneur_crowd_last_error());
  return status == FLANEUR_OK;
}

static int create_square(FlaneurCrowdId* crowd) {
  static const FlaneurPoint house_m[] = {{8, 40}, {20, 40}, {20, 50}, {8, 50}};
  FlaneurPolygon house = {{house_m, 4}, NULL, 0};
  FlaneurCircle fountain = {{30, 30}, 3};
  FlaneurLevelCost levels[] = {{6000, 400}, {1500, 200}, {400, 0}};
  FlaneurFigure figure = {levels, 3, 1.75f, 128, 0.45f};
  FlaneurCrowdDef def = flaneur_default_crowd_def();
  def.ground_max_m.x = def.ground_max_m.y = SIZE_M;
  def.polygons = &house, def.polygon_count = 1;
  def.circles = &fountain, def.circle_count = 1;
  def.figures = &figure, def.figure_count = 1;
  def.high_limit = 8;
  def.r_high_m = 12;
  return check(flaneur_create_crowd(&def, crowd));
}

/* In rows all over the square, where there is room. */
static int add_people(FlaneurCrowdId crowd) {
  int added = 0;
  for (int k = 0; k < 400 && added < PEOPLE; ++k) {
    FlaneurPersonDef def = flaneur_default_person_def();
    FlaneurPersonId person;
    def.position_m.x = 2 + 2.9 * (k % 20), def.position_m.y = 2 + 2.9 * (k * 7 % 20);
    if (flaneur_crowd_add_person(crowd, &def, &person) == FLANEUR_ERROR_INPUT)
      continue; /* inside the house or the fountain */
    if (!check(flaneur_crowd_set_goal(crowd, person, gates_m[k % GATES]))) return 0;
    ++added;
  }
  return added == PEOPLE;
}

/* Who has come to a gate goes on to another one. */
static void send_on(FlaneurCrowdId crowd, const FlaneurPerson* person) {
  if (person->arrival == FLANEUR_ARRIVAL_NOT) return;
  flaneur_crowd_set_goal(crowd, person->id, gates_m[(person->id.index1 * 5 + (unsigned)person->walked_m) % GATES]);
}

static void print_levels(double seconds, FlaneurCrowdId crowd, FlaneurPersonSpan people) {
  int drawn[4] = {0, 0, 0, 0}, fading = 0; /* three meshes, the impostor */
  FlaneurCrowdFigures figures;
  flaneur_crowd_figures(crowd, &figures);
  for (int i = 0; i < people.count; ++i) {
    const FlaneurPerson* p = &people.items[i];
    if (!p->is_in_view || p->level == FLANEUR_LEVEL_NOT_DRAWN) continue;
    ++drawn[p->level == FLANEUR_LEVEL_IMPOSTOR ? 3 : p->level];
    fading += p->fade < 1;
  }
  printf("%4.0f s: meshes %2d fine %2d middle %2d coarse, %3d impostors, %2d fading, %6ld triangles, limit %d\n",
         seconds, drawn[0], drawn[1], drawn[2], drawn[3], fading, (long)figures.triangles, figures.limit);
}

int main(void) {
  FlaneurCrowdId crowd;
  if (!create_square(&crowd) || !add_people(crowd)) return 1;
  FlaneurCrowdFigures figures;
  flaneur_crowd_figures(crowd, &figures);
  const int steps_a_second = (int)(1 / figures.step_s + 0.5f);
  for (int step = 0; step < SECONDS * steps_a_second; ++step) {
    const double t_s = step * figures.step_s;
    FlaneurCamera camera = {{12 + 1.2 * t_s, 20 + 4 * sin(0.4 * t_s)}, (float)(0.8 * sin(0.5 * t_s)), 1.05f, 1280};
    FlaneurPersonSpan people;
    if (!check(flaneur_crowd_step(crowd, &camera, 0)) || !check(flaneur_crowd_people(crowd, &people))) return 1;
    if (step % steps_a_second == 0) print_levels(t_s, crowd, people);
    for (int i = 0; i < people.count; ++i) send_on(crowd, &people.items[i]);
  }
  return check(flaneur_destroy_crowd(crowd)) ? 0 : 1;
}
