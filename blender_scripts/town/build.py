"""Builds a timber-framed town from a seed and writes it as one GLB.

    blender --background --factory-startup --python-exit-code 1 --python build.py -- SETTINGS.json

Settings: "output" (path of the GLB), "seed" (whole number), "options" with any of OPTIONS below.
Equal settings give an equal file. Nodes carry the tags of docs/town-convention.md.
"""

import gc
import math
import os
import random
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

import bpy  # noqa: E402

import ambient_occlusion as light  # noqa: E402
import export  # noqa: E402
import furnish  # noqa: E402
import gardens as backs  # noqa: E402
import layout  # noqa: E402
import life  # noqa: E402
import nature  # noqa: E402
import plan  # noqa: E402
import square  # noqa: E402
import town_wall  # noqa: E402
from church import make_church, make_hands  # noqa: E402
from common.settings import fail, load_settings, write_atomically  # noqa: E402
from ground import far_land, make_ground  # noqa: E402
from house import build_house  # noqa: E402
from mesh import srgb  # noqa: E402
from roof import make_vanes  # noqa: E402
from town_hall import make_town_hall  # noqa: E402

OPTIONS = {
    "ao_samples": 24,        # rays a vertex for the baked light, 4 to 256
    "texture_px": 1024,      # edge of the larger textures, 128 to 4096
    "house_width_m": 7.3,    # mean width of the houses, 5.5 to 9; wider means fewer
}
GROUND_KINDS = ("carriageway", "square", "pavement", "grass")


class Town:
    """What is gathered before anything is handed to Blender."""

    def __init__(self):
        self.parts = []      # (name, mesh, extras, weather): stands where it is
        self.shared = {}     # mesh name -> mesh, used by several nodes
        self.copies = []     # (name, mesh name, extras, (x, y, z), yaw, scale)
        self.empties = []    # (name, extras, (x, y, z), yaw)
        self.doors = 0
        self.turning = 0

    def add(self, name, mesh, kind, weather=0.10):
        self.parts.append((name, mesh, {"flaneur_kind": kind}, weather))
        for which, by, spot, yaw in mesh.turning:
            self.turning += 1
            self.copies.append(("%s_%02d" % (which, self.turning), which, {"flaneur_kind": "none", "flaneur_turns": by}, spot, yaw,
                                1.0))

    def door(self, x, y, nx, ny, width=1.0):
        """An empty whose local -y is (nx, ny)."""
        self.doors += 1
        spot = (x, y, float(plan.pavement_height(x, y)))
        self.empties.append(("door_%02d" % self.doors, {"flaneur_kind": "door", "flaneur_width_m": width}, spot,
                             math.atan2(nx, -ny)))


def check_options(options):
    for key, low, high in (("ao_samples", 4, 256), ("texture_px", 128, 4096), ("house_width_m", 5.5, 9.0)):
        if not low <= options[key] <= high:
            fail("options: '%s' must lie between %s and %s" % (key, low, high))


def add_ground(town, streets, public, gardens, rng):
    for kind, mesh in make_ground(streets, public, gardens, rng).items():
        if kind in GROUND_KINDS:
            town.parts.append(("ground_" + kind, mesh, {"flaneur_kind": "ground", "flaneur_ground": kind}, 0.16))
        else:
            town.add("back_gardens", mesh, "none", 0.2)
    town.add("far_land", far_land(rng), "none", 0.15)


def build_on(plot, rng):
    """The house of a plot, where along its front its door is, and where it would be if nobody walked through the house.

    A gateway draws from `rng` what the closed house would: it changes no other house and nothing in the streets.
    """
    again = random.Random()
    again.setstate(rng.getstate())
    gateway, plot.gateway = plot.gateway, False
    mesh, entries = build_house(plot, rng)
    plot.gateway, u_closed = gateway, entries[0][0]
    if gateway:
        mesh, entries = build_house(plot, again)
    return mesh, entries[0][0], u_closed


def add_houses(town, plots, rng):
    """All houses; returns where along its front each would have its door if none were a gateway."""
    doors, number = [], 0
    for plot in plots:
        if plot.kind not in ("house", "passage"):
            doors.append([0.0])
            continue
        number += 1
        mesh, u, u_closed = build_on(plot, rng)
        doors.append([u_closed])
        spot = plot.at(u, -0.35)
        lean = 0.0 if plot.kind == "passage" or plot.gateway else 1.0
        z = float(plan.pavement_height(*plot.at(u, 0)))
        placed = mesh.moved(plot.origin[0], plot.origin[1], z, plot.yaw, lean * rng.uniform(-0.006, 0.006),
                            lean * rng.uniform(-0.007, 0.003))
        town.add("house_%02d" % number, placed, "building")
        town.door(float(spot[0]), float(spot[1]), -plot.back[0], -plot.back[1])
    return doors


def add_landmarks(town, rng):
    town.shared.update(make_vanes())
    town.shared.update(make_hands())
    for name, make in (("church", make_church), ("town_hall", make_town_hall)):
        mesh, doors = make(rng)
        town.add(name, mesh, "building")
        for x, y, nx, ny in doors:
            town.door(x + 0.35 * nx, y + 0.35 * ny, nx, ny)


def add_walls(town, streets, garden_lines, gardens, rng):
    for index in range(len(plan.WALL_RING)):
        town.add("town_wall_%02d" % (index + 1), town_wall.make_wall_run(index, streets), "wall")
        if index in plan.WALL_GATES:
            mesh, spot, inward = town_wall.make_gate(index, streets, rng)
            name = plan.WALL_GATES[index]
            town.add("gate_" + name, mesh, "building")
            z = float(plan.ground_height(*spot))
            town.empties.append(("exit_" + name, {"flaneur_kind": "exit", "flaneur_width_m": 4.4},
                                 (float(spot[0]), float(spot[1]), z), math.atan2(inward[0], -inward[1])))
        else:
            town.add("town_wall_tower_%02d" % (index + 1), town_wall.make_tower(index, rng), "wall")
    for index, (line, built) in enumerate(zip(garden_lines, layout.before_corners(garden_lines))):
        height, tint = rng.uniform(2.1, 2.6), rng.uniform(0.85, 1.0)
        color = tuple(c * tint for c in srgb("ddd0b8"))
        mesh = town_wall.make_line_wall(built, height, 0.4, color)
        for a, b in zip(line[:-1].tolist(), line[1:].tolist()):
            if math.dist(a, b) > 1.6 and rng.random() < 0.55:
                low, high = float(plan.pavement_height(*a)), float(plan.pavement_height(*b))
                nature.add_ivy(mesh, (a, b), lambda t: low + (high - low) * t, lambda t: low + (high - low) * t + height, rng)
        if index in gardens.openings:
            mesh = town_wall.opened_wall(*backs.cut(line, gardens.openings[index]), height, color)
        if not backs.in_gate(line, streets):
            town.add("garden_wall_%02d" % (index + 1), mesh, "wall")
    town.add("churchyard_wall", town_wall.churchyard_wall(), "wall")


def add_furniture(town, streets, public, plots, doors, rng):
    def put(name, mesh, x, y, yaw, kind="other"):
        z = float(plan.ground_height(x, y))
        if plan.carriage_distance([(x, y)], streets)[0] > 0:
            z += plan.KERB_M
        town.add(name, mesh.moved(x, y, z, yaw), kind)

    put("well", square.make_well(rng), *furnish.WELL, 0.3)
    for i, (x, y, yaw) in enumerate(furnish.STALLS):
        put("market_stall_%d" % (i + 1), square.make_stall(rng), x, y, yaw)
    for i, (x, y, yaw) in enumerate(furnish.CARTS):
        put("cart_%d" % (i + 1), square.make_cart(rng, i == furnish.HORSE_CART), x, y, yaw)
    put("trough", square.make_trough(random.Random("trough")), *life.before_cart(life.TROUGH_M))
    counts, benches = {"bench": 0, "pile": 0}, []
    for kind, x, y, yaw, free in furnish.along_fronts(plots, doors, streets, public, rng):
        mesh = (square.make_bench if kind == "bench" else square.make_pile)(rng)
        if free:
            counts[kind] += 1
            put("%s_%02d" % ("goods" if kind == "pile" else kind, counts[kind]), mesh, x, y, yaw)
            if kind == "bench":
                benches.append((x, y, yaw))
    for i, (x, y, yaw) in enumerate(furnish.graves(rng)):
        put("grave_%02d" % (i + 1), square.make_grave(rng), x, y, yaw)
    for i, (x, y, yaw) in enumerate(furnish.loiter_spots()):
        town.empties.append(("loiter_%02d" % (i + 1), {"flaneur_kind": "loiter"},
                             (x, y, float(plan.ground_height(x, y))), yaw))
    life.add_work(town, benches, furnish.lamps(streets, public))


def add_gardens(town, gardens):
    rng, counts = gardens.rng, {}
    makers = {"bed": lambda: backs.make_bed(4.6, rng), "hedge": lambda: backs.make_hedge(rng.uniform(4.0, 5.5), rng),
              "linen": lambda: backs.make_linen(6.5, rng), "bench": lambda: square.make_bench(rng)}
    for kind, x, y, yaw in backs.places(gardens):
        counts[kind] = counts.get(kind, 0) + 1
        name, z = "garden_%s_%02d" % (kind, counts[kind]), float(plan.pavement_height(x, y))
        if kind == "tree":
            scale = rng.uniform(0.7, 0.95)
            extras = {"flaneur_kind": "tree", "flaneur_radius_m": round(nature.TRUNK_RADIUS_M * scale, 3)}
            sort = furnish.TREE_SORTS[rng.randrange(2, 4)][0]
            town.copies.append((name, sort, extras, (x, y, z - 0.1), rng.uniform(0, 2 * math.pi), scale))
        elif kind == "loiter":
            town.empties.append((name, {"flaneur_kind": "loiter"}, (x, y, z), yaw))
        else:
            town.add(name, makers[kind]().moved(x, y, z, yaw), "other")


def add_copies(town, streets, public, rng):
    for name, height, crown, tint, detail in furnish.TREE_SORTS:
        town.shared[name] = nature.make_tree(random.Random(name), height, crown, tint, detail)  # however many leaves, the town stays
    town.shared["lamp"] = nature.make_lamp()
    for i, (x, y, scale, sort) in enumerate(furnish.trees(public, rng)):
        z = float(plan.pavement_height(x, y)) - (0.1 if public([(x, y)])[0] < 0 else 0.15)
        outside = plan.distance_to_polygon([(x, y)], plan.WALL_RING)[0] > 0
        extras = {"flaneur_kind": "none" if outside else "tree"}
        if not outside:
            extras["flaneur_radius_m"] = round(nature.TRUNK_RADIUS_M * scale, 3)
        town.copies.append(("tree_%03d" % (i + 1), furnish.TREE_SORTS[sort][0], extras, (x, y, z - (0.4 if outside else 0)),
                            rng.uniform(0, 2 * math.pi), scale))
    for i, (x, y) in enumerate(furnish.lamps(streets, public)):
        z = float(plan.ground_height(x, y)) + (plan.KERB_M if plan.carriage_distance([(x, y)], streets)[0] > 0 else 0)
        town.copies.append(("lamp_%02d" % (i + 1), "lamp", {"flaneur_kind": "lamp", "flaneur_radius_m": nature.LAMP_RADIUS_M},
                            (x, y, z), 0.0, 1.0))


def bake(town, samples):
    """Vertex colours of everything: name -> (corner arrays, colours)."""
    parts = [light.Corners(mesh) for _, mesh, _, _ in town.parts]
    shared = {name: light.Corners(mesh) for name, mesh in town.shared.items()}
    solids = [(part.points, part.sizes) for part, (name, *_) in zip(parts, town.parts) if name != "far_land"]
    solids += [(_placed(shared[which].points * scale, spot, yaw), shared[which].sizes)
               for _, which, _, spot, yaw, scale in town.copies]
    counts = [max(4, samples // 3) if name in ("back_gardens", "far_land") else samples for name, *_ in town.parts]
    tree = light.make_tree(solids)
    baked = {name: (part, light.vertex_colors(part, light.occlusion(part, tree, count), weather))
             for (name, _, _, weather), part, count in zip(town.parts, parts, counts)}
    for name, part in shared.items():
        own = light.occlusion(part, light.make_tree([(part.points, part.sizes)]), samples)
        baked[name + "_mesh"] = (part, light.vertex_colors(part, own, 0.0))
    return baked


def _placed(points, spot, yaw):
    c, s = math.cos(yaw), math.sin(yaw)
    return points @ [[c, s, 0], [-s, c, 0], [0, 0, 1]] + spot


def to_blender(town, baked, options, seed, folder):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    used = sorted({m for _, mesh, _, _ in town.parts for m in mesh.materials}
                  | {m for mesh in town.shared.values() for m in mesh.materials})
    materials = export.make_materials(used, options["texture_px"], seed, folder)
    for name, mesh, extras, _ in town.parts:
        export.add_object(name, export.make_blender_mesh(name, mesh, *baked[name], materials), extras)
    shared = {name: export.make_blender_mesh(name, mesh, *baked[name + "_mesh"], materials)
              for name, mesh in town.shared.items()}
    for name, which, extras, spot, yaw, scale in town.copies:
        export.add_object(name, shared[which], extras, spot, yaw, scale)
    for name, extras, spot, yaw in town.empties:
        export.add_object(name, None, extras, spot, yaw)


def triangle_count(town):
    single = sum(mesh.triangle_count() for _, mesh, _, _ in town.parts)
    return single, single + sum(town.shared[which].triangle_count() for _, which, *_ in town.copies)


def gather(seed, options):
    """The whole town as meshes and places."""
    rng = random.Random(seed)
    town = Town()
    streets, public, plots, garden_lines = layout.make_layout(rng, options["house_width_m"])
    gardens = backs.Gardens(streets, public, plots, garden_lines, random.Random("gardens %d" % seed))
    add_ground(town, streets, public, gardens, rng)
    doors = add_houses(town, plots, rng)
    add_landmarks(town, rng)
    add_walls(town, streets, garden_lines, gardens, rng)
    add_furniture(town, streets, public, plots, doors, rng)
    add_copies(town, streets, public, rng)
    add_gardens(town, gardens)
    return town


def main():
    gc.disable()      # millions of small tuples, none in a circle: looking through them takes a seventh of the time
    settings = load_settings(required=("output", "seed"), options=OPTIONS)
    options = settings["options"]
    check_options(options)
    town = gather(settings["seed"], options)
    baked = bake(town, options["ao_samples"])
    with tempfile.TemporaryDirectory() as folder:
        to_blender(town, baked, options, settings["seed"], folder)
        write_atomically(settings["output"], export.write_glb)
    houses = sum(name.startswith("house_") for name, *_ in town.parts)
    print("flaneur: town: %d houses, %d doors, %d triangles stored, %d drawn" % (houses, town.doors, *triangle_count(town)))


main()
