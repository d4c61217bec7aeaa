// The crowd library as a program in C sees it: people who walk and levels within limits, the same each time, and a
// status for whatever else it is given.
#include <flaneur/crowd.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <thread>
#include <vector>

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
constexpr FlaneurPoint kHouse[] = {{20, 10}, {30, 10}, {30, 20}, {20, 20}};

// A square of 50 m with a house and a tree.
FlaneurCrowdDef Square(FlaneurPoint at = {0, 0}) {
  static const FlaneurCircle tree{{10, 10}, 1};
  static const FlaneurPolygon house{{kHouse, 4}, nullptr, 0};
  FlaneurCrowdDef def = flaneur_default_crowd_def();
  def.ground_min_m = at, def.ground_max_m = {at.x + 50, at.y + 50};
  if (at.x == 0) def.polygons = &house, def.polygon_count = 1, def.circles = &tree, def.circle_count = 1;
  return def;
}

class ACrowd : public testing::Test {
 protected:
  explicit ACrowd(const FlaneurCrowdDef& def = Square()) {
    EXPECT_EQ(flaneur_create_crowd(&def, &crowd), FLANEUR_OK) << flaneur_crowd_last_error();
  }
  ~ACrowd() override { flaneur_destroy_crowd(crowd); }

  FlaneurPersonId Add(FlaneurPoint at) const {
    FlaneurPersonDef def = flaneur_default_person_def();
    def.position_m = at;
    FlaneurPersonId id{};
    EXPECT_EQ(flaneur_crowd_add_person(crowd, &def, &id), FLANEUR_OK)
        << flaneur_crowd_last_error() << at.x << " " << at.y;
    return id;
  }
  FlaneurPersonId Send(FlaneurPoint from, FlaneurPoint to) const {
    const FlaneurPersonId id = Add(from);
    EXPECT_EQ(flaneur_crowd_set_goal(crowd, id, to), FLANEUR_OK) << flaneur_crowd_last_error();
    return id;
  }
  std::vector<FlaneurPerson> Step(const FlaneurCamera* camera = nullptr) const {
    EXPECT_EQ(flaneur_crowd_step(crowd, camera, 0), FLANEUR_OK) << flaneur_crowd_last_error();
    FlaneurPersonSpan people{};
    EXPECT_EQ(flaneur_crowd_people(crowd, &people), FLANEUR_OK);
    return {people.items, people.items + people.count};
  }
  // Rows of people who cross the square, from the west to the east.
  void Fill(int count) const {
    for (int k = 0; k < count; ++k) Send({1.5 + k % 6, 22.0 + k / 6 * 0.9}, {45, 5.0 + k % 8 * 5});
  }

  FlaneurCrowdId crowd{};
};

TEST_F(ACrowd, WalksRoundTheHouseAndStandsWhereItWanted) {
  Send({5, 15}, {45, 15});
  bool has_arrived = false;
  FlaneurPoint last{};
  for (int step = 0; step < 60 * 30 && !has_arrived; ++step) {
    const FlaneurPerson p = Step()[0];
    EXPECT_FALSE(p.position_m.x > 20 && p.position_m.x < 30 && p.position_m.y > 10 && p.position_m.y < 20);
    has_arrived = p.arrival == FLANEUR_ARRIVAL_THERE, last = p.position_m;
  }
  EXPECT_TRUE(has_arrived);
  EXPECT_NEAR(last.x, 45, 1);
  EXPECT_NEAR(last.y, 15, 1);
  for (int step = 0; step < 60; ++step) Step();
  EXPECT_LT(Step()[0].speed_mps, 0.05f);
}

class ACrowdOnTheMap : public ACrowd {
 protected:
  ACrowdOnTheMap() : ACrowd(Square({603'900, 5'780'000})) {}
};

TEST_F(ACrowdOnTheMap, IsInTheCallersCoordinates) {
  Send({603'905, 5'780'015}, {603'945, 5'780'015});
  const FlaneurPerson before = Step()[0];
  for (int step = 0; step < 300; ++step) Step();
  const FlaneurPerson after = Step()[0];
  EXPECT_NEAR(before.position_m.x, 603'905, 0.1);
  EXPECT_GT(after.position_m.x, 603'912);
  EXPECT_NEAR(after.position_m.y, 5'780'015, 0.1);
}

class ACrowdThatIsLeftAlone : public ACrowd {
 protected:
  ACrowdThatIsLeftAlone() : ACrowd(Def()) {}
  static FlaneurCrowdDef Def() {
    FlaneurCrowdDef def = Square();
    def.adaptation = FLANEUR_ADAPTATION_OFF;
    return def;
  }
};

TEST_F(ACrowdThatIsLeftAlone, KeepsTheLimitsOfLevelsAndFadesChanges) {
  Fill(150);
  FlaneurCamera camera{{40, 35}, 3.1416f, 1.05f, 1280};
  int most_high = 0, most_in_view = 0, changes = 0;
  for (int step = 0; step < 600; ++step) {
    camera.position_m.x -= 0.05;
    for (const FlaneurPerson& p : Step(&camera)) {
      EXPECT_GE(p.fade, 0);
      EXPECT_LE(p.fade, 1);
      EXPECT_GE(p.level, FLANEUR_LEVEL_NOT_DRAWN);
      EXPECT_LT(p.level, 2);
      changes += p.fade < 1 && p.level != p.from_level;
    }
    FlaneurCrowdFigures figures;
    ASSERT_EQ(flaneur_crowd_figures(crowd, &figures), FLANEUR_OK);
    EXPECT_LE(figures.high, figures.limit);
    EXPECT_LE(figures.triangles, 200'000);
    most_high = std::max(most_high, figures.high), most_in_view = std::max(most_in_view, figures.high + figures.low);
  }
  EXPECT_GE(most_high, 10);
  EXPECT_GT(most_in_view, 40);
  EXPECT_GT(changes, 10);
}

TEST_F(ACrowd, NobodyHasALevelWhereNobodyLooks) {
  Fill(10);
  const FlaneurCamera camera{{40, 25}, 3.1416f, 1.05f, 1280};
  Step(&camera);
  for (const FlaneurPerson& p : Step()) {
    EXPECT_EQ(p.level, FLANEUR_LEVEL_NOT_DRAWN);
    EXPECT_FALSE(p.is_in_view);
  }
}

// All that comes out of a run with people who come, go and are sent elsewhere, bit for bit.
std::vector<double> AllOfARun(uint64_t seed) {
  FlaneurCrowdDef def = Square();
  def.seed = seed;
  FlaneurCrowdId crowd{};
  EXPECT_EQ(flaneur_create_crowd(&def, &crowd), FLANEUR_OK);
  std::vector<double> out;
  for (int step = 0; step < 400; ++step) {
    FlaneurPersonDef person = flaneur_default_person_def();
    person.position_m = {3.0 + step % 7, 30.0 + step % 5};
    FlaneurPersonId id{};
    if (step % 4 == 0 && flaneur_crowd_add_person(crowd, &person, &id) == FLANEUR_OK)
      flaneur_crowd_set_goal(crowd, id, {45, 5.0 + step % 3 * 20});
    const FlaneurCamera camera{{25 + 0.02 * step, 30}, 0.01f * static_cast<float>(step), 1.05f, 1280};
    EXPECT_EQ(flaneur_crowd_step(crowd, &camera, 0), FLANEUR_OK);
    FlaneurPersonSpan people;
    flaneur_crowd_people(crowd, &people);
    for (int i = 0; i < people.count; ++i) {
      const FlaneurPerson& p = people.items[i];
      out.insert(out.end(),
                 {p.position_m.x, p.position_m.y, p.heading_rad, p.speed_mps, static_cast<double>(p.level), p.fade});
    }
    if (step % 9 == 0 && people.count > 0) flaneur_crowd_remove_person(crowd, people.items[people.count / 2].id);
  }
  flaneur_destroy_crowd(crowd);
  return out;
}

TEST(Crowds, GiveTheSameBitsForTheSameCallsInAnyThread) {
  const std::vector<double> expected = AllOfARun(1);
  ASSERT_GT(expected.size(), 10'000u);
  EXPECT_NE(AllOfARun(2), expected);
  std::vector<std::vector<double>> results(4);
  std::vector<std::thread> threads;
  for (std::vector<double>& result : results) threads.emplace_back([&] { result = AllOfARun(1); });
  for (std::thread& thread : threads) thread.join();
  for (const std::vector<double>& result : results) EXPECT_EQ(result, expected);
}

// A crowd of some thousands on their way between twelve places; `threads` of each step.
std::vector<FlaneurPerson> PeopleAfterSteps(const std::vector<int>& threads) {
  FlaneurCrowdDef def = flaneur_default_crowd_def();
  def.ground_max_m = {200, 200};
  FlaneurCrowdId crowd{};
  EXPECT_EQ(flaneur_create_crowd(&def, &crowd), FLANEUR_OK) << flaneur_crowd_last_error();
  for (int k = 0; k < 5000; ++k) {
    FlaneurPersonDef person = flaneur_default_person_def();
    person.position_m = {2 + k % 71 * 2.7, 2 + k / 71 * 2.7};
    FlaneurPersonId id{};
    EXPECT_EQ(flaneur_crowd_add_person(crowd, &person, &id), FLANEUR_OK) << flaneur_crowd_last_error();
    if (k % 5 == 0) continue;
    EXPECT_EQ(flaneur_crowd_set_goal(crowd, id, {10.0 + k % 12 * 15, 100}), FLANEUR_OK) << flaneur_crowd_last_error();
  }
  const FlaneurCamera camera{{100, 60}, 1.57f, 1.05f, 1280};
  FlaneurPersonSpan people{};
  for (int count : threads) {
    EXPECT_EQ(flaneur_crowd_set_threads(crowd, count), FLANEUR_OK) << flaneur_crowd_last_error();
    EXPECT_EQ(flaneur_crowd_step(crowd, &camera, 0), FLANEUR_OK) << flaneur_crowd_last_error();
  }
  EXPECT_EQ(flaneur_crowd_people(crowd, &people), FLANEUR_OK);
  std::vector<FlaneurPerson> result(people.items, people.items + people.count);
  EXPECT_EQ(flaneur_destroy_crowd(crowd), FLANEUR_OK);
  return result;
}

TEST(Crowds, WalkInTheSameBitsWithAnyNumberOfThreads) {
  std::vector<int> alone(60, 0), with_three(60, 3), now_and_then;
  for (int step = 0; step < 60; ++step) now_and_then.push_back(step % 7);
  const std::vector<FlaneurPerson> people = PeopleAfterSteps(alone);
  ASSERT_EQ(people.size(), 5000u);
  EXPECT_GT(std::count_if(people.begin(), people.end(), [](const FlaneurPerson& p) { return p.walked_m > 1; }), 3000);
  for (const auto& threads : {with_three, now_and_then}) {
    const std::vector<FlaneurPerson> others = PeopleAfterSteps(threads);
    ASSERT_EQ(others.size(), people.size());
    for (size_t i = 0; i < people.size(); ++i) {
      ASSERT_EQ(others[i].id.index1, people[i].id.index1);
      ASSERT_EQ(others[i].position_m.x, people[i].position_m.x) << i;
      ASSERT_EQ(others[i].position_m.y, people[i].position_m.y) << i;
      ASSERT_EQ(others[i].heading_rad, people[i].heading_rad) << i;
      ASSERT_EQ(others[i].level, people[i].level) << i;
    }
  }
}

TEST_F(ACrowd, HasNoLessThanNoThreads) {
  for (int count : {-1, 65, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()}) {
    EXPECT_EQ(flaneur_crowd_set_threads(crowd, count), FLANEUR_ERROR_OUT_OF_RANGE) << count;
    EXPECT_NE(std::string(flaneur_crowd_last_error()).find("threads"), std::string::npos);
  }
  EXPECT_EQ(flaneur_crowd_set_threads({}, 1), FLANEUR_ERROR_ID);
}

TEST_F(ACrowd, KnowsItsPeopleByIdsThatAreNeverUsedAgain) {
  std::vector<FlaneurPersonId> ids, gone;
  for (int round = 0; round < 300; ++round) {
    for (int k = 0; k < 3; ++k) ids.push_back(Add({3.0 + k, 5.0 + round % 20}));
    Step();
    for (int k = 0; k < 3; ++k) {
      const size_t at = static_cast<size_t>(round * 7 + k) % ids.size();
      ASSERT_EQ(flaneur_crowd_remove_person(crowd, ids[at]), FLANEUR_OK);
      gone.push_back(ids[at]);
      ids.erase(ids.begin() + static_cast<long>(at));
    }
  }
  for (const FlaneurPersonId id : gone) {
    EXPECT_FALSE(flaneur_crowd_has_person(crowd, id));
    EXPECT_EQ(flaneur_crowd_remove_person(crowd, id), FLANEUR_ERROR_ID);
    EXPECT_EQ(flaneur_crowd_set_goal(crowd, id, {40, 40}), FLANEUR_ERROR_ID);
    EXPECT_EQ(flaneur_crowd_clear_goal(crowd, id), FLANEUR_ERROR_ID);
  }
  for (const FlaneurPersonId id :
       {FlaneurPersonId{0, 0}, FlaneurPersonId{UINT32_MAX, 1}, FlaneurPersonId{1, UINT32_MAX}})
    EXPECT_FALSE(flaneur_crowd_has_person(crowd, id));
  EXPECT_TRUE(Step().empty());
}

// Each goal of its own, a thousand times over: what earlier ones needed is used again, also where it was being built.
TEST_F(ACrowd, MayBeSentElsewhereAsOftenAsOneLikes) {
  std::vector<FlaneurPersonId> ids;
  for (int k = 0; k < 20; ++k) ids.push_back(Add({3.0 + k % 5, 25.0 + k / 5}));
  for (int round = 0; round < 200; ++round) {
    const FlaneurPoint shared{40.0 + 0.01 * round, 40};
    for (size_t k = 0; k < ids.size(); ++k) {
      const FlaneurPoint own{2.0 + 0.02 * round, 2.0 + 0.3 * static_cast<double>(k)};
      ASSERT_EQ(flaneur_crowd_set_goal(crowd, ids[k], round % 2 == 0 ? shared : own), FLANEUR_OK)
          << flaneur_crowd_last_error();
    }
    Step();
  }
  std::vector<FlaneurPerson> before = Step(), after;
  for (int step = 0; step < 2000; ++step) after = Step();
  for (const FlaneurPerson& p : after)
    EXPECT_LT(std::hypot(p.position_m.x - 6, p.position_m.y - 5), 8);  // all at their last goals
}

TEST_F(ACrowd, PlacesThatAreNoneAreRefused) {
  FlaneurPersonDef person = flaneur_default_person_def();
  FlaneurPersonId id{};
  const auto add = [&](FlaneurPoint at) {
    person.position_m = at;
    return flaneur_crowd_add_person(crowd, &person, &id);
  };
  EXPECT_EQ(add({25, 15}), FLANEUR_ERROR_INPUT);    // in the house
  EXPECT_EQ(add({19.9, 15}), FLANEUR_ERROR_INPUT);  // against its wall
  EXPECT_EQ(add({10, 10.5}), FLANEUR_ERROR_INPUT);  // in the tree
  EXPECT_EQ(add({-1, 15}), FLANEUR_ERROR_INPUT);    // off the ground
  EXPECT_EQ(add({90'000, 15}), FLANEUR_ERROR_INPUT);
  EXPECT_EQ(add({1e30, 15}), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(add({kNan, 15}), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(id.index1, 0u);
  ASSERT_EQ(add({5, 5}), FLANEUR_OK);
  EXPECT_EQ(flaneur_crowd_set_goal(crowd, id, {25, 15}), FLANEUR_ERROR_INPUT);
  EXPECT_EQ(flaneur_crowd_set_goal(crowd, id, {kInfinity, 15}), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(flaneur_crowd_set_goal(crowd, id, {-500, 15}), FLANEUR_ERROR_INPUT);
  EXPECT_EQ(flaneur_crowd_set_goal(crowd, id, {5, 5}), FLANEUR_OK);  // already there
  Step();
}

TEST(Crowds, GoalsBehindClosedWallsAreRefused) {
  FlaneurCrowdDef def = Square();
  const FlaneurPoint outer[] = {{20, 20}, {40, 20}, {40, 40}, {20, 40}},
                     yard[] = {{25, 25}, {35, 25}, {35, 35}, {25, 35}};
  const FlaneurRing hole{yard, 4};
  const FlaneurPolygon ring{{outer, 4}, &hole, 1};
  def.polygons = &ring;
  FlaneurCrowdId crowd{};
  ASSERT_EQ(flaneur_create_crowd(&def, &crowd), FLANEUR_OK);
  FlaneurPersonDef person = flaneur_default_person_def();
  person.position_m = {30, 30};
  FlaneurPersonId inside{};
  ASSERT_EQ(flaneur_crowd_add_person(crowd, &person, &inside), FLANEUR_OK);
  EXPECT_EQ(flaneur_crowd_set_goal(crowd, inside, {33, 27}), FLANEUR_OK);
  EXPECT_EQ(flaneur_crowd_set_goal(crowd, inside, {5, 5}), FLANEUR_ERROR_INPUT);
  flaneur_destroy_crowd(crowd);
}

FlaneurStatus StatusOf(const std::function<void(FlaneurCrowdDef*)>& change) {
  FlaneurCrowdDef def = Square();
  change(&def);
  FlaneurCrowdId id{};
  const FlaneurStatus status = flaneur_create_crowd(&def, &id);
  EXPECT_EQ(id.index1 != 0, status == FLANEUR_OK);
  if (status == FLANEUR_OK) flaneur_destroy_crowd(id);
  return status;
}

TEST(Crowds, EveryNumberOfADefinitionMayBeAnything) {
  using Def = FlaneurCrowdDef;
  for (float Def::*member : {&Def::largest_radius_m, &Def::preferred_speed_mps, &Def::speed_spread_mps,
                             &Def::top_speed_mps, &Def::discretion, &Def::target_ms, &Def::r_personal_m, &Def::r_high_m,
                             &Def::r_unimportant_m, &Def::r_far_m, &Def::step_hz, &Def::max_yaw_rate_dps})
    for (const float value : {kNan, kInfinity, -1.0f, 3e38f})
      EXPECT_EQ(StatusOf([&](Def* def) { def->*member = value; }), FLANEUR_ERROR_OUT_OF_RANGE) << value;
  for (int Def::*member : {&Def::adaptation, &Def::method, &Def::high_limit, &Def::budget_triangles,
                           &Def::polygon_count, &Def::circle_count})
    for (const int value : {-1, INT32_MIN})
      EXPECT_EQ(StatusOf([&](Def* def) { def->*member = value; }), FLANEUR_ERROR_OUT_OF_RANGE) << value;
  for (const FlaneurPoint max :
       {FlaneurPoint{0, 0}, {-5, 50}, {1, 50}, {50, 2001}, {kNan, 50}, {kInfinity, 50}, {1e300, 50}})
    EXPECT_EQ(StatusOf([&](Def* def) { def->ground_max_m = max; }), FLANEUR_ERROR_OUT_OF_RANGE) << max.x;
  EXPECT_EQ(StatusOf([](Def* def) { def->r_personal_m = def->r_high_m = 5; }), FLANEUR_ERROR_INPUT);
  EXPECT_EQ(StatusOf([](Def* def) { def->r_far_m = def->r_high_m; }), FLANEUR_ERROR_INPUT);
  EXPECT_EQ(StatusOf([](Def* def) { def->r_high_m = 0; }), FLANEUR_OK);
  EXPECT_EQ(StatusOf([](Def* def) { def->high_limit = 0; }), FLANEUR_OK);
  EXPECT_EQ(StatusOf([](Def* def) { def->budget_triangles = 0; }), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(StatusOf([](Def* def) { def->internal_value = 0; }), FLANEUR_ERROR_DEFINITION);
}

TEST(Crowds, EveryObstacleMayBeAnything) {
  using Def = FlaneurCrowdDef;
  const auto polygon = [](const FlaneurPoint* points, int count, const FlaneurRing* holes = nullptr,
                          int hole_count = 0) {
    const FlaneurPolygon p{{points, count}, holes, hole_count};
    return StatusOf([&](Def* def) { def->polygons = &p; });
  };
  const FlaneurPoint not_a_number[] = {{1, 1}, {kNan, 1}, {5, 5}}, far[] = {{1, 1}, {1e9, 1}, {5, 5}},
                     one[] = {{5, 5}, {5, 5}, {5, 5}}, bow[] = {{5, 5}, {15, 15}, {15, 5}, {5, 15}},
                     wide[] = {{-9e4, -9e4}, {9e4, -9e4}, {0, -1}};
  const FlaneurRing empty{nullptr, 0}, two{kHouse, 2}, missing{nullptr, 4};
  EXPECT_EQ(polygon(not_a_number, 3), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(polygon(far, 3), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(polygon(kHouse, 2), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(polygon(kHouse, -4), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(polygon(nullptr, 4), FLANEUR_ERROR_NULL);
  EXPECT_EQ(polygon(kHouse, 4, &empty, 1), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(polygon(kHouse, 4, &two, 1), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(polygon(kHouse, 4, &missing, 1), FLANEUR_ERROR_NULL);
  EXPECT_EQ(polygon(kHouse, 4, nullptr, 1), FLANEUR_ERROR_NULL);
  EXPECT_EQ(polygon(kHouse, 4, nullptr, -1), FLANEUR_ERROR_OUT_OF_RANGE);
  for (const FlaneurPoint* odd : {one, bow, wide}) EXPECT_EQ(polygon(odd, 3), FLANEUR_OK);
  for (const double radius_m : {0.0, -1.0, static_cast<double>(kNan), 1e9}) {
    const FlaneurCircle circle{{25, 25}, radius_m};
    EXPECT_EQ(StatusOf([&](Def* def) { def->circles = &circle; }), FLANEUR_ERROR_OUT_OF_RANGE) << radius_m;
  }
  const FlaneurCircle everything{{25, 25}, 100};
  EXPECT_EQ(StatusOf([&](Def* def) { def->circles = &everything; }), FLANEUR_ERROR_INPUT);
  EXPECT_EQ(StatusOf([](Def* def) { def->polygons = nullptr; }), FLANEUR_ERROR_NULL);
  EXPECT_EQ(StatusOf([](Def* def) { def->circles = nullptr; }), FLANEUR_ERROR_NULL);
}

TEST(Crowds, EveryFigureMayBeAnything) {
  using Def = FlaneurCrowdDef;
  const FlaneurLevelCost good[] = {{5000, 100}, {500, 0}}, no_triangles[] = {{0, 0}}, not_a_number[] = {{100, kNan}};
  const auto figure = [](const FlaneurFigure& f, int count = 1) {
    return StatusOf([&](Def* def) { def->figures = &f, def->figure_count = count; });
  };
  EXPECT_EQ(figure({good, 2, 1.75f, 128, 0.5f}), FLANEUR_OK);
  EXPECT_EQ(figure({good, 2, 1.75f, 128, 0.5f}, 0), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(figure({good, 0, 1.75f, 128, 0.5f}), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(figure({good, 17, 1.75f, 128, 0.5f}), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(figure({nullptr, 2, 1.75f, 128, 0.5f}), FLANEUR_ERROR_NULL);
  EXPECT_EQ(figure({no_triangles, 1, 1.75f, 128, 0.5f}), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(figure({not_a_number, 1, 1.75f, 128, 0.5f}), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(figure({good, 2, kNan, 128, 0.5f}), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(figure({good, 2, 1.75f, 0, 0.5f}), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(figure({good, 2, 1.75f, 128, -1}), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(StatusOf([](Def* def) { def->figure_count = 2; }), FLANEUR_ERROR_NULL);
}

TEST_F(ACrowd, PeopleAndCamerasMayBeAnything) {
  Fill(30);
  using Def = FlaneurPersonDef;
  const auto add = [&](const std::function<void(Def*)>& change) {
    Def def = flaneur_default_person_def();
    def.position_m = {5, 45};
    change(&def);
    FlaneurPersonId id;
    return flaneur_crowd_add_person(crowd, &def, &id);
  };
  for (const float value : {kNan, kInfinity, -1.0f, 3e38f}) {
    EXPECT_EQ(add([&](Def* def) { def->radius_m = value; }), FLANEUR_ERROR_OUT_OF_RANGE) << value;
    EXPECT_EQ(add([&](Def* def) { def->preferred_speed_mps = value; }), FLANEUR_ERROR_OUT_OF_RANGE) << value;
  }
  EXPECT_EQ(add([](Def* def) { def->heading_rad = kNan; }), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(add([](Def* def) { def->heading_rad = 9e5f; }), FLANEUR_OK);
  EXPECT_EQ(add([](Def* def) { def->figure = 1; }), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(add([](Def* def) { def->figure = -1; }), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(add([](Def* def) { def->internal_value = 0; }), FLANEUR_ERROR_DEFINITION);
  const auto step = [&](FlaneurCamera camera, float frame_ms = 16) {
    return flaneur_crowd_step(crowd, &camera, frame_ms);
  };
  for (const float value : {kNan, kInfinity, 3e38f}) {
    EXPECT_EQ(step({{value, 25}, 0, 1, 1280}), FLANEUR_ERROR_OUT_OF_RANGE) << value;
    EXPECT_EQ(step({{25, 25}, value, 1, 1280}), FLANEUR_ERROR_OUT_OF_RANGE) << value;
    EXPECT_EQ(step({{25, 25}, 0, value, 1280}), FLANEUR_ERROR_OUT_OF_RANGE) << value;
    EXPECT_EQ(step({{25, 25}, 0, 1, 1280}, value), FLANEUR_ERROR_OUT_OF_RANGE) << value;
  }
  EXPECT_EQ(step({{25, 25}, 0, 3.1416f, 1280}), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(step({{25, 25}, 0, 1, 0}), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(step({{25, 25}, 0, 1, 1280}, -1), FLANEUR_ERROR_OUT_OF_RANGE);
  // Odd ones that are meant: in the house, far away, spinning, leaping.
  for (int k = 0; k < 200; ++k) {
    const double far_m = k % 3 == 0 ? 25 : k % 3 == 1 ? -9e4 : 9e4;
    ASSERT_EQ(step({{far_m, 15}, 2.5f * static_cast<float>(k * k), k % 2 == 0 ? 0.2f : 2.6f, k % 2 == 0 ? 1 : 65536},
                   static_cast<float>(k)),
              FLANEUR_OK);
    FlaneurPersonSpan people{};
    ASSERT_EQ(flaneur_crowd_people(crowd, &people), FLANEUR_OK);
    for (int i = 0; i < people.count; ++i) {
      EXPECT_TRUE(std::isfinite(people.items[i].position_m.x) && std::isfinite(people.items[i].heading_rad));
      EXPECT_TRUE(people.items[i].position_m.x >= 0 && people.items[i].position_m.x <= 50);
    }
  }
}

// People put on top of each other and the visitor among them: they get apart, and nothing becomes infinite.
TEST_F(ACrowd, MayBePutOnOneSpot) {
  for (int k = 0; k < 40; ++k) Send({40, 40}, {5, 40});
  const FlaneurCamera camera{{40, 40}, 0, 1.05f, 1280};
  std::vector<FlaneurPerson> people;
  for (int step = 0; step < 300; ++step) people = Step(&camera);
  for (const FlaneurPerson& p : people)
    EXPECT_TRUE(std::isfinite(p.position_m.x) && std::isfinite(p.speed_mps) && p.speed_mps < 5);
}

TEST_F(ACrowd, NullAndWhatIsGoneAreRefused) {
  FlaneurPersonSpan people{};
  FlaneurCrowdFigures figures{};
  FlaneurPersonId person{};
  const FlaneurPersonDef def = flaneur_default_person_def();
  const FlaneurCrowdDef crowd_def = Square();
  EXPECT_EQ(flaneur_create_crowd(nullptr, &crowd), FLANEUR_ERROR_NULL);
  EXPECT_EQ(flaneur_create_crowd(&crowd_def, nullptr), FLANEUR_ERROR_NULL);
  EXPECT_EQ(flaneur_crowd_people(crowd, nullptr), FLANEUR_ERROR_NULL);
  EXPECT_EQ(flaneur_crowd_figures(crowd, nullptr), FLANEUR_ERROR_NULL);
  EXPECT_EQ(flaneur_crowd_add_person(crowd, nullptr, &person), FLANEUR_ERROR_NULL);
  EXPECT_EQ(flaneur_crowd_add_person(crowd, &def, nullptr), FLANEUR_ERROR_NULL);
  FlaneurCrowdId gone{};
  ASSERT_EQ(flaneur_create_crowd(&crowd_def, &gone), FLANEUR_OK);
  ASSERT_EQ(flaneur_destroy_crowd(gone), FLANEUR_OK);
  EXPECT_FALSE(flaneur_crowd_is_valid(gone));
  EXPECT_EQ(flaneur_destroy_crowd(gone), FLANEUR_ERROR_ID);
  EXPECT_EQ(flaneur_crowd_step(gone, nullptr, 0), FLANEUR_ERROR_ID);
  EXPECT_EQ(flaneur_crowd_people(gone, &people), FLANEUR_ERROR_ID);
  EXPECT_EQ(flaneur_crowd_figures(gone, &figures), FLANEUR_ERROR_ID);
  EXPECT_EQ(flaneur_crowd_add_person(gone, &def, &person), FLANEUR_ERROR_ID);
  EXPECT_EQ(flaneur_crowd_remove_person(gone, person), FLANEUR_ERROR_ID);
  EXPECT_EQ(flaneur_crowd_set_goal(gone, person, {0, 0}), FLANEUR_ERROR_ID);
  EXPECT_FALSE(flaneur_crowd_has_person(gone, person));
  EXPECT_STRNE(flaneur_crowd_last_error(), "");
  EXPECT_TRUE(flaneur_crowd_is_valid(crowd));
}

TEST(Versions, OfTheCrowdsHeaderAndLibraryAreTheSame) {
  const FlaneurVersion version = flaneur_crowd_version();
  EXPECT_EQ(std::to_string(version.major) + "." + std::to_string(version.minor) + "." + std::to_string(version.patch),
            FLANEUR_VERSION_TEXT);
}

}  // namespace
