"""The crowd from Python, by ctypes alone: 50 people leave a room by its door.

python3 crowd.py [PATH_OF_libflaneur_crowd.so]: one line a second, how many are still inside.
"""
import ctypes
import sys
from ctypes import POINTER, Structure, byref, c_bool, c_char_p, c_double, c_float, c_int, c_uint32, c_uint64, c_void_p


def struct(name, **fields):
    """A ctypes structure with these fields, in order: as in flaneur/crowd.h."""
    return type(name, (Structure,), {"_fields_": list(fields.items())})


Point = struct("Point", x=c_double, y=c_double)
Ring = struct("Ring", points=POINTER(Point), count=c_int)
Polygon = struct("Polygon", outer=Ring, holes=POINTER(Ring), hole_count=c_int)
Id = struct("Id", index1=c_uint32, generation=c_uint32)
Version = struct("Version", major=c_int, minor=c_int, patch=c_int)
CrowdDef = struct("CrowdDef", ground_min_m=Point, ground_max_m=Point, polygons=POINTER(Polygon), polygon_count=c_int, circles=c_void_p,
                  circle_count=c_int, figures=c_void_p, figure_count=c_int, seed=c_uint64, largest_radius_m=c_float,
                  preferred_speed_mps=c_float, speed_spread_mps=c_float, top_speed_mps=c_float, adaptation=c_int,
                  discretion=c_float, method=c_int,
                  high_limit=c_int, target_ms=c_float, budget_triangles=c_int, r_personal_m=c_float, r_high_m=c_float,
                  r_unimportant_m=c_float, r_far_m=c_float, step_hz=c_float, max_yaw_rate_dps=c_float, internal_value=c_int)
PersonDef = struct("PersonDef", position_m=Point, heading_rad=c_float, figure=c_int, radius_m=c_float, preferred_speed_mps=c_float,
                   internal_value=c_int)
Person = struct("Person", id=Id, position_m=Point, heading_rad=c_float, speed_mps=c_float, walked_m=c_float, figure=c_int, level=c_int,
                from_level=c_int, fade=c_float, age_s=c_float, arrival=c_int, is_in_view=c_bool)
People = struct("People", items=POINTER(Person), count=c_int)


def load(path):
    library = ctypes.CDLL(path)
    library.flaneur_crowd_last_error.restype = c_char_p
    library.flaneur_crowd_version.restype = Version
    library.flaneur_default_crowd_def.restype = CrowdDef
    library.flaneur_default_person_def.restype = PersonDef
    library.flaneur_crowd_set_goal.argtypes = [Id, Id, Point]
    library.flaneur_crowd_step.argtypes = [Id, c_void_p, c_float]
    version = library.flaneur_crowd_version()
    if (version.major, version.minor) != (0, 2):
        sys.exit("crowd.py: error: the structures above are those of version 0.2")
    return library


def main():
    library = load(sys.argv[1] if len(sys.argv) > 1 else "libflaneur_crowd.so.0.2")

    def check(status):
        if status != 0:
            sys.exit(f"crowd.py: error: {library.flaneur_crowd_last_error().decode()}")

    # Two walls with a door of 1.2 m between them, across a ground of 20 m x 10 m.
    corners = [[(10, -1), (10.3, -1), (10.3, 4.4), (10, 4.4)], [(10, 5.6), (10.3, 5.6), (10.3, 11), (10, 11)]]
    points = [(Point * 4)(*wall) for wall in corners]
    walls = (Polygon * 2)(*(Polygon(Ring(wall, 4), None, 0) for wall in points))
    definition = library.flaneur_default_crowd_def()
    definition.ground_max_m = Point(20, 10)
    definition.polygons, definition.polygon_count = walls, 2
    crowd = Id()
    check(library.flaneur_create_crowd(byref(definition), byref(crowd)))

    for k in range(50):
        person = library.flaneur_default_person_def()
        person.position_m = Point(1 + k % 10 * 0.8, 1 + k // 10 * 1.9)
        identity = Id()
        check(library.flaneur_crowd_add_person(crowd, byref(person), byref(identity)))
        check(library.flaneur_crowd_set_goal(crowd, identity, Point(18, 5)))

    people = People()
    for step in range(60 * 30):
        check(library.flaneur_crowd_step(crowd, None, 0))
        check(library.flaneur_crowd_people(crowd, byref(people)))
        inside = sum(people.items[i].position_m.x < 10 for i in range(people.count))
        for identity in [p.id for p in people.items[:people.count] if p.arrival]:
            check(library.flaneur_crowd_remove_person(crowd, identity))
        if step % 30 == 0:
            print(f"{step // 30:3} s: {inside:2} inside, {people.count:2} on the way")
        if people.count == 0:
            break
    check(library.flaneur_destroy_crowd(crowd))


if __name__ == "__main__":
    main()
