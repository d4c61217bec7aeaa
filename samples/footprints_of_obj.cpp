// Footprints of a town in an OBJ file: what stands in a walker's way, and what the check says about it.
//
//   footprints_of_obj TOWN.obj [--y-up]
//
// Each `o` is an object of its own, told by its name: see FLANEUR_OBJECT_BY_NAME. One line an obstacle, then one a
// finding. Exit status: 0 done, 1 errors found, 2 bad usage or input.
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <flaneur/footprints.h>

struct Object {
  std::string name;
  std::vector<uint32_t> indices;  // three a triangle
};

struct Obj {
  std::vector<double> positions_m;
  std::vector<Object> objects{{"town", {}}};
};

static bool ReadObj(const char* path, bool y_up, Obj* obj) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "o") {
      std::string name;
      std::getline(words >> std::ws, name);
      obj->objects.push_back({name, {}});
    } else if (key == "v") {
      double x = 0, y = 0, z = 0;
      if (!(words >> x >> y >> z)) return false;
      obj->positions_m.insert(obj->positions_m.end(), {x, y_up ? -z : y, y_up ? y : z});
    } else if (key == "f") {
      std::vector<uint32_t> corners;
      for (std::string corner; words >> corner;) {
        const long number = std::stol(corner), count = static_cast<long>(obj->positions_m.size() / 3);
        corners.push_back(static_cast<uint32_t>(number > 0 ? number - 1 : count + number));  // the library looks at it
      }
      for (size_t i = 2; i < corners.size(); ++i)
        obj->objects.back().indices.insert(obj->objects.back().indices.end(), {corners[0], corners[i - 1], corners[i]});
    }
  }
  return file.eof();
}

static int Fail(const char* what) {
  std::fprintf(stderr, "footprints_of_obj: error: %s\n", what);
  return 2;
}

int main(int argc, char** argv) {
  const bool y_up = argc == 3 && std::strcmp(argv[2], "--y-up") == 0;
  if (argc != 2 && !y_up) return Fail("usage: footprints_of_obj TOWN.obj [--y-up]");
  Obj obj;
  if (!ReadObj(argv[1], y_up, &obj)) return Fail("the file cannot be read, or a vertex has no three numbers");

  std::vector<FlaneurObject> objects;
  for (const Object& o : obj.objects) {
    if (o.indices.empty()) continue;
    FlaneurObject object{};
    object.name = o.name.c_str();
    object.positions_m = obj.positions_m.data(), object.vertex_count = static_cast<int>(obj.positions_m.size() / 3);
    object.indices = o.indices.data(), object.index_count = static_cast<int>(o.indices.size());
    objects.push_back(object);
  }
  FlaneurFootprintsDef def = flaneur_default_footprints_def();
  def.objects = objects.data(), def.object_count = static_cast<int>(objects.size());
  FlaneurFootprintsId town;
  if (flaneur_create_footprints(&def, &town) != FLANEUR_OK) return Fail(flaneur_footprints_last_error());

  FlaneurObstacleSpan obstacles;
  flaneur_footprints_obstacles(town, &obstacles);
  for (const FlaneurObstacle* o = obstacles.items; o != obstacles.items + obstacles.count; ++o) {
    std::printf("obstacle %s%s:", o->name, o->is_guess ? " (a guess)" : "");
    if (o->outer.count == 0) std::printf(" %.2f m round (%.2f, %.2f)", o->radius_m, o->center_m.x, o->center_m.y);
    for (int i = 0; i < o->outer.count; ++i) std::printf(" (%.2f, %.2f)", o->outer.points[i].x, o->outer.points[i].y);
    std::printf("%s\n", o->hole_count > 0 ? ", with holes" : "");
  }

  FlaneurCheckDef check = flaneur_default_check_def();
  FlaneurFindingSpan findings;
  if (flaneur_footprints_check(town, &check, &findings) != FLANEUR_OK) return Fail(flaneur_footprints_last_error());
  int errors = 0;
  for (const FlaneurFinding* f = findings.items; f != findings.items + findings.count; ++f) {
    std::printf("%s %d at (%.2f, %.2f) %s: %s\n", f->is_error ? "error" : "warning", f->code, f->at_m.x, f->at_m.y,
                f->feature, f->message);
    errors += f->is_error;
  }
  std::printf("%d obstacles, %d findings\n", obstacles.count, findings.count);
  flaneur_destroy_footprints(town);
  return errors > 0 ? 1 : 0;
}
