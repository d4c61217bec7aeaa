"""Paths of a visitor, drawn from a seed in any tour's town: all kinds of ways to walk, stand and look about, among few people and
many. Each is a scenario's text; the same pack and seed give the same."""
import math
import random

from figures.recording import judge
from random_walks import is_free

PEOPLE = (100, 400, 2000)
SECONDS = 45
CLEARANCE_M = 0.9
MOST_FROM_PLACE_M = 40   # paths begin and stay so near a place that visitors come for
CROWDED_PM2 = (0.2, 0.55)
STREAM_SHARE = 0.6       # of a stream's people walk against the visitor


class Town:
    """What drawing a path needs of a pack's description."""

    def __init__(self, tour):
        self.obstacles = judge.boxed_obstacles({"features": [feature(o) for o in tour["obstacles"]]})
        ground = tour["ground"]
        self.ground = [(low, low + cells * ground["cell_m"])
                       for low, cells in zip(ground["min_m"], (ground["columns"], ground["rows"]))]
        self.cell_m, self.columns, self.kinds = ground["cell_m"], ground["columns"], ground["kinds"]
        doors = [p["position_m"] for p in tour["places"] if p["kind"] in ("door", "exit")]
        loiter = [p["position_m"] for p in tour["places"] if p["kind"] == "loiter"]
        spots = [h["position_m"] for h in tour.get("hotspots", [])]
        stops = [s["position_m"] for s in tour.get("path", [])]
        self.places = stops + spots + loiter or doors
        if not self.places:
            raise ValueError("the pack has no stops, places to stand or doors to draw paths about")
        self.squares = spots + loiter or self.places

    def is_free(self, a, b, clearance_m=CLEARANCE_M):
        on_ground = all(low + clearance_m < v < high - clearance_m for p in (a, b) for v, (low, high) in zip(p, self.ground))
        return on_ground and self.has_ground(a, b, clearance_m) and is_free(a, b, self.obstacles, clearance_m)

    def has_ground(self, a, b, clearance_m):
        """Whether there is something to walk on all the way, in the middle and that far to both sides: no water, no hole."""
        length_m = math.dist(a, b) or 1
        aside = ((a[1] - b[1]) / length_m * clearance_m, (b[0] - a[0]) / length_m * clearance_m)
        steps = math.ceil(length_m / self.cell_m)
        return all(self.kind_at(a[0] + (b[0] - a[0]) * k / steps + side * aside[0], a[1] + (b[1] - a[1]) * k / steps + side * aside[1])
                   for k in range(steps + 1) for side in (0, -1, 1))

    def kind_at(self, x, y):
        column, row = (int((v - low) / self.cell_m) for v, (low, _) in zip((x, y), self.ground))
        return self.kinds[row * self.columns + column]

    def near(self, dice, places, most_m=6):
        """A free place by one of these."""
        for _ in range(2000):
            x, y = dice.choice(places)
            place = (round(x + dice.uniform(-most_m, most_m), 1), round(y + dice.uniform(-most_m, most_m), 1))
            if self.is_free(place, place):
                return place
        raise ValueError("there is no room for a visitor by the stops, places to stand or doors of the pack")

    def way_on(self, dice, place, leg_m, clearance_m=CLEARANCE_M):
        """A place that one can walk to straight from here, or None after many tries."""
        for _ in range(200):
            angle, length_m = dice.uniform(0, 2 * math.pi), dice.uniform(*leg_m)
            to = (round(place[0] + length_m * math.cos(angle), 1), round(place[1] + length_m * math.sin(angle), 1))
            if min(math.dist(to, p) for p in self.places) < MOST_FROM_PLACE_M and self.is_free(place, to, clearance_m):
                return to
        return None


def feature(obstacle):
    """An obstacle of a pack as footprints.geojson has it."""
    name = {"name": obstacle["name"]}
    if "center_m" in obstacle:
        return {"geometry": {"type": "Point", "coordinates": obstacle["center_m"]},
                "properties": {**name, "radius_m": obstacle["radius_m"]}}
    rings = [obstacle["outer_m"], *obstacle.get("holes_m", [])]
    return {"geometry": {"type": "Polygon", "coordinates": [ring + ring[:1] for ring in rings]}, "properties": name}


# Each kind draws a start, its legs, and what else its scenario says: (place, yaw in degrees, legs, rest).

def leg(**keys):
    lines = "".join(f"{key} = {list(value) if isinstance(value, tuple) else value}\n" for key, value in keys.items())
    return f"\n[[camera.leg]]\n{lines}"


def anywhere_deg(dice):
    return dice.randrange(0, 360)


def walking(dice, town, place, speeds_mps, leg_m=(6, 25), **keys):
    """Legs from place to place all through a path."""
    text, left_s = "", SECONDS
    while left_s > 0:
        to, speed = town.way_on(dice, place, leg_m), round(dice.uniform(*speeds_mps), 2)
        if to is None:
            return text + leg(wait_s=left_s)
        text += leg(walk_to_m=to, speed_mps=speed, **keys)
        left_s -= math.dist(place, to) / speed
        place = to
    return text


def strolling(dice, town, _):
    place = town.near(dice, town.places)
    return place, anywhere_deg(dice), walking(dice, town, place, (0.8, 1.7)), ""


def hurrying(dice, town, _):
    place = town.near(dice, town.places)
    return place, anywhere_deg(dice), walking(dice, town, place, (2.0, 4.0)), ""


def strafing(dice, town, _):
    place = town.near(dice, town.places)
    return place, anywhere_deg(dice), walking(dice, town, place, (0.6, 1.2), facing_deg=dice.choice((-90, 90))), ""


def backwards(dice, town, _):
    place = town.near(dice, town.places)
    return place, anywhere_deg(dice), walking(dice, town, place, (0.6, 1.2), facing_deg=180), ""


def looking_aside(dice, town, _):
    place = town.near(dice, town.places)
    return place, anywhere_deg(dice), walking(dice, town, place, (0.8, 1.5), facing_deg=dice.choice((-60, -35, 35, 60))), ""


def following(dice, town, _):
    place = town.near(dice, town.places)
    legs = leg(follow_s=SECONDS, behind_m=round(dice.uniform(2, 4), 1), speed_mps=1.8)
    return place, anywhere_deg(dice), legs, ""


def looking_about(dice, town, _):
    place = town.near(dice, town.places)
    legs = leg(wait_s=SECONDS, look_about_deg=dice.randrange(20, 90, 5), rate_dps=dice.randrange(10, 60, 5))
    return place, anywhere_deg(dice), legs, ""


def circling(dice, town, _):
    """Round a place where people stand, such as a well."""
    for _ in range(500):
        middle, radius_m, way = dice.choice(town.squares), dice.uniform(3, 8), dice.choice((-1, 1))
        start, speed = dice.uniform(0, 2 * math.pi), round(dice.uniform(0.8, 1.5), 2)
        corners = [(round(middle[0] + radius_m * math.cos(a), 1), round(middle[1] + radius_m * math.sin(a), 1))
                   for a in (start + way * math.pi / 5 * k for k in range(60))]
        if all(town.is_free(a, b, 0.6) for a, b in zip(corners[:10], corners[1:11])):
            break
    else:
        return strolling(dice, town, _)
    count = math.ceil(SECONDS * speed / math.dist(corners[0], corners[1]))
    return corners[0], anywhere_deg(dice), "".join(leg(walk_to_m=c, speed_mps=speed) for c in corners[1:min(count, 59) + 1]), ""


def crowd_area(dice, town, place, people):
    """The crowd is about the visitor, as densely as on a market day."""
    half_m = round(math.sqrt(people / dice.uniform(*CROWDED_PM2)) / 2, 1)
    return (f"\n[crowd_area]\nmin_m = [{place[0] - half_m:.1f}, {place[1] - half_m:.1f}]\n"
            f"max_m = [{place[0] + half_m:.1f}, {place[1] + half_m:.1f}]\n")


def crowded_market(dice, town, people):
    place = town.near(dice, town.squares)
    legs = "".join(leg(wait_s=dice.randrange(4, 12)) + leg(turn_by_deg=dice.choice((-40, -20, 20, 40, 60)), rate_dps=40)
                   for _ in range(6))
    return place, anywhere_deg(dice), legs + leg(wait_s=SECONDS), crowd_area(dice, town, place, people)


def turning_in_a_throng(dice, town, people):
    """The paper's Figure 12."""
    place, rate = town.near(dice, town.squares), dice.randrange(12, 30)
    return (place, anywhere_deg(dice), leg(turn_by_deg=dice.choice((-1, 1)) * rate * SECONDS, rate_dps=rate),
            crowd_area(dice, town, place, people))


def to_and_fro(dice, town, _):
    place, turn = town.near(dice, town.places), dice.randrange(60, 150, 10)
    legs = "".join(leg(turn_by_deg=sign * turn, rate_dps=dice.randrange(40, 121, 10)) + leg(wait_s=round(dice.uniform(0.2, 3), 1))
                   for _ in range(12) for sign in (1, -1))
    return place, anywhere_deg(dice), legs, ""


def standing(dice, town, _):
    place = town.near(dice, town.places)
    legs = "".join(leg(wait_s=dice.randrange(3, 15)) + leg(turn_by_deg=dice.randrange(-180, 181, 10), rate_dps=60) for _ in range(8))
    return place, anywhere_deg(dice), legs, ""


def turning_back(dice, town, _):
    """Some way on, and suddenly round and back."""
    place, legs = town.near(dice, town.places), ""
    for _ in range(8):
        to = town.way_on(dice, place, (5, 14)) or place
        legs += leg(walk_to_m=to, speed_mps=1.4) + leg(turn_by_deg=180, rate_dps=120) + leg(walk_to_m=place, speed_mps=1.4)
    return place, anywhere_deg(dice), legs, ""


def against_a_stream(dice, town, _):
    for _ in range(500):
        place = town.near(dice, town.places)
        to = town.way_on(dice, place, (22, 38), 1.6)
        if to is not None:
            break
    else:
        return strolling(dice, town, _)
    length_m = math.dist(place, to)
    ahead = ((to[0] - place[0]) / length_m, (to[1] - place[1]) / length_m)
    text = ""
    for k in range(round(length_m * 1.5)):
        along, aside = dice.uniform(2, length_m), dice.uniform(-1.2, 1.2)
        p = (place[0] + ahead[0] * along - ahead[1] * aside, place[1] + ahead[1] * along + ahead[0] * aside)
        ends = [place, to] if dice.random() < STREAM_SHARE else [to, place]
        goals = ", ".join(f"[{x}, {y}]" for x, y in ends * 3)
        text += f"\n[[person]]\nposition_m = [{p[0]:.2f}, {p[1]:.2f}]\ngoals_m = [{goals}]\n"
    yaw_deg = round(math.degrees(math.atan2(ahead[1], ahead[0])))
    legs = leg(walk_to_m=to, speed_mps=1.2) + leg(walk_to_m=place, speed_mps=1.2)
    return place, yaw_deg, legs, text


KINDS = {"circling": circling, "crowded-market": crowded_market, "to-and-fro": to_and_fro, "turning-back": turning_back,
         "against-a-stream": against_a_stream, "strolling": strolling, "throng": turning_in_a_throng, "standing": standing,
         "hurrying": hurrying, "strafing": strafing, "backwards": backwards, "looking-aside": looking_aside, "following": following,
         "looking-about": looking_about}
STANDING_KINDS = ("crowded-market", "throng", "standing", "to-and-fro", "looking-about")


def drawn(tour, count, seed):
    """[(name, scenario's text)], the kinds and how many people there are in turn."""
    town, dice = Town(tour), random.Random(seed)
    kinds = list(KINDS)
    dice.shuffle(kinds)
    paths = []
    for number in range(count):
        kind, people = kinds[number % len(kinds)], PEOPLE[(number + number // len(kinds)) % len(PEOPLE)]
        place, yaw_deg, legs, rest = KINDS[kind](dice, town, people)
        name = f"{number + 1:02d}-{kind}-{people}"
        paths.append((name, f'name = "{name}"\npeople = {people}\nseconds = {SECONDS}\n{rest}\n[camera]\n'
                            f"position_m = {list(place)}\nyaw_deg = {yaw_deg}\n{legs}"))
    return paths
