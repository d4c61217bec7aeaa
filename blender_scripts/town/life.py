"""Where people work in the town: behind the stalls, on the benches, at the well, before some doors.

Empties of kind `work` as docs/town-convention.md says; their local -y is where people look.
"""

import math

import furnish
import plan

KEEPER = (-0.2, 0.36)   # in a stall, behind its counter
DOGS = {0: (-2.1, -0.5), 4: (2.1, -0.5), 7: (-2.1, -0.5)}  # by stall at the end of a row: beside it, in nobody's way
HORSE_M, TROUGH_M = 2.1, 3.8  # before a cart's middle: the middle of the horse, and what it eats from
BEFORE_BENCH_M = 0.62   # from a bench's middle to where a sitter's feet are
SEAT_M = 0.46
FROM_WELL_M = 1.76      # from its middle
DOORS_SWEPT = 7         # every so many doors somebody sweeps beside it
BROOM_M = 1.4           # swung about who sweeps
BESIDE_DOOR_M = (1.3, 0.95)  # along the front, and out of it


def _turned(x, y, yaw, along, back):
    c, s = math.cos(yaw), math.sin(yaw)
    return x + c * along - s * back, y + s * along + c * back


def before_cart(away_m):
    """(x, y, yaw) of a place between the shafts of the cart with the horse, which looks along local -x."""
    x, y, yaw = furnish.CARTS[furnish.HORSE_CART]
    return (*_turned(x, y, yaw, -away_m, 0.0), yaw)


def _work(town, name, spot, yaw, clip, avatars="", **more):
    extras = {"flaneur_kind": "work", "flaneur_clip": clip, "flaneur_avatars": avatars}
    extras.update({"flaneur_" + key: value for key, value in more.items()})
    x, y = spot
    town.empties.append((name, extras, (x, y, float(plan.pavement_height(x, y))), yaw))


def add_work(town, benches, lamps):
    """benches: (x, y, yaw) of each; lamps: (x, y)."""
    for i, (x, y, yaw) in enumerate(furnish.STALLS):
        _work(town, "keeper_%d" % (i + 1), _turned(x, y, yaw, *KEEPER), yaw, "keep", "merchant, farmer, townswoman")
        if i in DOGS:
            _work(town, "dog_%d" % (i + 1), _turned(x, y, yaw, *DOGS[i]), yaw, "lie", "dog, pale_dog")
    for i, (x, y, yaw) in enumerate(benches):
        side = -0.42 if i % 2 else 0.42
        _work(town, "sitter_%02d" % (i + 1), _turned(x, y, yaw, side, -BEFORE_BENCH_M), yaw, "sit", seat_m=SEAT_M)
    x, y, yaw = before_cart(HORSE_M)
    _work(town, "cart_horse", (x, y), yaw - math.pi / 2, "idle", "horse")
    x, y = furnish.WELL
    for i, angle in enumerate((-2.4, 0.5)):
        spot = (x + FROM_WELL_M * math.cos(angle), y + FROM_WELL_M * math.sin(angle))
        _work(town, "well_%d" % (i + 1), spot, angle - math.pi / 2, "draw_water", "maid", stay_s=90.0)
    doors = [(name, spot, yaw) for name, extras, spot, yaw in town.empties if extras["flaneur_kind"] == "door"]
    for i, (name, (x, y, _), yaw) in enumerate(doors[3::DOORS_SWEPT]):
        sides = [(_turned(x, y, yaw, side * BESIDE_DOOR_M[0], -BESIDE_DOOR_M[1]), yaw + side * 0.9) for side in (1, -1)]
        free = [all(math.dist(spot, lamp) > BROOM_M for lamp in lamps) for spot, _ in sides]
        spot, look = sides[0 if free[0] or not free[1] else 1]
        _work(town, "sweeper_%02d" % (i + 1), spot, look, "sweep", "maid, farmer, craftsman", stay_s=150.0)
