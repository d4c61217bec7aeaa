#include "runtime/player/scenario.h"

#include <toml++/toml.h>

#include <algorithm>
#include <functional>

#include "runtime/base/file.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

// Keeps the line, not the node: the document is gone when this is caught.
struct Refused {
  Refused(const toml::node* node, std::string what) : line(node->source().begin.line), why(std::move(what)) {}
  uint32_t line;
  std::string why;
};

// One table read field by field; Finish() refuses what nobody asked for.
class Table {
 public:
  Table(const toml::table& table, std::string name) : table_(table), name_(std::move(name)) {}

  const toml::node* Find(const char* key) {
    known_.push_back(key);
    return table_.get(key);
  }
  template <typename T>
  bool Number(const char* key, double least, double most, T* value) {
    const toml::node* node = Find(key);
    if (node == nullptr) return false;
    const auto number = node->value<double>();
    const bool whole = std::is_integral_v<T>;
    if (!number || node->is_boolean() || node->is_string() || (whole && !node->is_integer()) ||
        !(*number >= least && *number <= most)) {
      throw Refused{node, Name(key) + " must be a " + (whole ? "whole number" : "number") + " from " + Text(least) +
                              " to " + Text(most)};
    }
    *value = static_cast<T>(*number);
    return true;
  }
  template <typename T>
  void Number(const char* key, double least, double most, std::optional<T>* value) {
    T number{};
    if (Number(key, least, most, &number)) *value = number;
  }
  bool String(const char* key, std::string* value) {
    const toml::node* node = Find(key);
    if (node == nullptr) return false;
    if (!node->is_string()) throw Refused{node, Name(key) + " must be text in quotes"};
    *value = *node->value<std::string>();
    return true;
  }
  void Choice(const char* key, std::initializer_list<const char*> allowed, std::optional<std::string>* value) {
    std::string text;
    if (!String(key, &text)) return;
    if (std::find(allowed.begin(), allowed.end(), text) == allowed.end()) {
      std::string list;
      for (const char* a : allowed) list += (list.empty() ? "" : ", ") + std::string(a);
      throw Refused{table_.get(key), Name(key) + " must be one of: " + list};
    }
    *value = text;
  }
  bool Point(const char* key, Vec2* value) {
    const toml::node* node = Find(key);
    if (node == nullptr) return false;
    *value = ToPoint(node, Name(key));
    return true;
  }
  bool Points(const char* key, std::vector<Vec2>* values) {
    const toml::node* node = Find(key);
    if (node == nullptr) return false;
    if (!node->is_array()) throw Refused{node, Name(key) + " must be a list of [x, y]"};
    for (const toml::node& element : *node->as_array()) values->push_back(ToPoint(&element, Name(key)));
    return true;
  }
  bool Flag(const char* key, bool* value) {
    const toml::node* node = Find(key);
    if (node == nullptr) return false;
    if (!node->is_boolean()) throw Refused{node, Name(key) + " must be true or false"};
    *value = *node->value<bool>();
    return true;
  }
  void Sub(const char* key, const std::function<void(Table)>& read) {
    const toml::node* node = Find(key);
    if (node == nullptr) return;
    if (!node->is_table()) throw Refused{node, Name(key) + " must be a table"};
    read(Table(*node->as_table(), Name(key)));
  }
  void Each(const char* key, const std::function<void(Table)>& read) {
    const toml::node* node = Find(key);
    if (node == nullptr) return;
    if (!node->is_array()) throw Refused{node, "write [[" + Name(key) + "]] with two brackets"};
    for (const toml::node& element : *node->as_array()) {
      if (!element.is_table()) throw Refused{&element, Name(key) + " must be a list of tables"};
      read(Table(*element.as_table(), Name(key)));
    }
  }
  void Finish() {
    for (const auto& [key, node] : table_) {
      const std::string name(key.str());
      if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
      throw Refused{&node, "unknown key '" + name + "'" + (name_.empty() ? "" : " in [" + name_ + "]") +
                               DidYouMean(name, known_)};
    }
  }
  const toml::table& table() const { return table_; }
  const std::string& name() const { return name_; }

 private:
  static std::string Text(double number) {
    std::string text = std::to_string(number);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
  }
  std::string Name(const char* key) const { return name_.empty() ? key : name_ + "." + key; }
  static Vec2 ToPoint(const toml::node* node, const std::string& name) {
    const toml::array* array = node->as_array();
    if (array == nullptr || array->size() != 2) throw Refused{node, name + " must be [x, y] in metres"};
    const auto x = (*array)[0].value<double>(), y = (*array)[1].value<double>();
    if (!x || !y || !(std::abs(*x) < 1e6) || !(std::abs(*y) < 1e6)) throw Refused{node, name + " must be [x, y] in metres"};
    return {static_cast<float>(*x), static_cast<float>(*y)};
  }

  const toml::table& table_;
  std::string name_;
  std::vector<std::string> known_;
};

CameraLeg ReadLeg(Table t) {
  CameraLeg leg;
  const bool walk = t.Point("walk_to_m", &leg.to_m);
  const bool turn = t.Number("turn_by_deg", -36000, 36000, &leg.turn_deg);
  const bool wait = t.Number("wait_s", 0, 36000, &leg.wait_s);
  t.Number("speed_mps", 0.01, 20, &leg.speed_mps);
  t.Number("rate_dps", 0.1, 720, &leg.rate_dps);
  t.Finish();
  if (walk + turn + wait != 1) {
    throw Refused{&t.table(), "a camera.leg needs exactly one of walk_to_m, turn_by_deg and wait_s"};
  }
  leg.kind = walk ? CameraLeg::Kind::kWalk : turn ? CameraLeg::Kind::kTurn : CameraLeg::Kind::kWait;
  return leg;
}

void ReadCamera(Table t, Scenario* s) {
  s->has_camera = true;
  t.Point("position_m", &s->camera_position_m);
  t.Number("yaw_deg", -36000, 36000, &s->camera_yaw_deg);
  t.Number("fov_deg", 10, 150, &s->fov_deg);
  t.Number("r_high_m", 0, 1000, &s->r_high_m);
  t.Number("eye_height_m", 0.1, 200, &s->eye_height_m);
  t.Number("pitch_deg", -89, 89, &s->pitch_deg);
  t.Each("leg", [&](Table leg) { s->legs.push_back(ReadLeg(leg)); });
  t.Finish();
}

void ReadPerson(Table t, Scenario* s) {
  ScenarioPerson person;
  if (!t.Point("position_m", &person.position_m)) throw Refused{&t.table(), "a [[person]] needs position_m = [x, y]"};
  t.Points("goals_m", &person.goals_m);
  t.Flag("stay", &person.stay);
  t.String("avatar", &person.avatar);
  t.String("group", &person.group);
  t.Number("speed_mps", 0.05, 10, &person.speed_mps);
  t.Number("top_speed_mps", 0.05, 10, &person.top_speed_mps);
  t.Number("radius_m", 0.05, 2, &person.radius_m);
  t.Finish();
  s->persons.push_back(person);
}

void ReadObstacle(Table t, Scenario* s) {
  PackObstacle obstacle;
  const bool polygon = t.Points("polygon_m", &obstacle.outer);
  const bool circle = t.Point("center_m", &obstacle.center) & t.Number("radius_m", 0.01, 1e5, &obstacle.radius_m);
  t.Finish();
  if (polygon == circle || (polygon && obstacle.outer.size() < 3)) {
    throw Refused{&t.table(), "an [[obstacle]] needs polygon_m of at least 3 points, or center_m and radius_m"};
  }
  obstacle.name = "obstacle_" + std::to_string(s->obstacles.size() + 1);
  s->obstacles.push_back(obstacle);
}

void ReadAll(Table root, Scenario* s) {
  root.String("name", &s->name);
  root.Number("people", 0, 1000000, &s->people);
  root.Number("seed", 0, 4294967295.0, &s->seed);
  root.Number("group_share", 0, 1, &s->group_share);
  root.Number("step_hz", 10, 240, &s->step_hz);
  root.Number("seconds", 0, 1e6, &s->seconds);
  root.Choice("adaptation", {"off", "paper", "full"}, &s->adaptation);
  root.Sub("limit", [&](Table t) {
    t.Choice("method", {"count", "frame_time"}, &s->method);
    t.Number("high", 0, 100000, &s->high_limit);
    t.Number("target_ms", 1, 1000, &s->target_ms);
    t.Number("budget_triangles", 0, 1e9, &s->budget_triangles);
    t.Number("draw_base_ms", 0, 1000, &s->draw_base_ms);
    t.Number("draw_ms_per_million_triangles", 0, 1e6, &s->draw_ms_per_million_triangles);
    t.Finish();
  });
  root.Sub("camera", [&](Table t) { ReadCamera(t, s); });
  root.Each("person", [&](Table t) { ReadPerson(t, s); });
  root.Sub("ground", [&](Table t) {
    s->has_ground = true;
    t.Point("min_m", &s->ground_min_m);
    t.Point("max_m", &s->ground_max_m);
    t.Finish();
    const Vec2 size = s->ground_max_m - s->ground_min_m;
    if (!(size.x >= 1 && size.y >= 1 && size.x * size.y <= 4e6f)) {
      throw Refused{&t.table(), "ground must have min_m below max_m, at least 1 m and at most 4 square kilometres"};
    }
  });
  root.Sub("crowd_area", [&](Table t) {
    Area area;
    const bool whole = t.Point("min_m", &area.min_m) & t.Point("max_m", &area.max_m);
    t.Finish();
    if (!whole || !(area.max_m.x > area.min_m.x && area.max_m.y > area.min_m.y)) {
      throw Refused{&t.table(), "crowd_area needs min_m and max_m, min_m below max_m"};
    }
    s->crowd_area = area;
  });
  root.Each("obstacle", [&](Table t) { ReadObstacle(t, s); });
  root.Finish();
}

}  // namespace

Error ReadScenario(const std::filesystem::path& path, Scenario* scenario) {
  std::string text;
  if (Error e = ReadTextFile(path, &text)) return e;
  const auto at = [&](uint32_t line) { return path.string() + ":" + std::to_string(line) + ": "; };
  try {
    const toml::table root = toml::parse(text, path.string());
    Scenario read;
    ReadAll(Table(root, ""), &read);
    *scenario = std::move(read);
    return Ok();
  } catch (const toml::parse_error& e) {
    return Fail(at(e.source().begin.line) + "not TOML: " + OneLine(e.description()));
  } catch (const Refused& e) {
    return Fail(at(e.line) + e.why);
  }
}

}  // namespace flaneur
