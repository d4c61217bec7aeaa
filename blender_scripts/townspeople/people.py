"""The wardrobe: every townsperson as plain data. Lengths are metres on a figure of 1.7 m, colours sRGB 0 to 1.

`wear` lists the garments from the skin outwards; `piece` names the function that makes it (build.py), the rest
are its settings. `cloth` says how each texture cell looks (materials.paint). `proportions` are scales in x, y, z
(to the left, to the back, up) of body regions; `bulges` push the trunk in or out before anything is sewn.
"""

# Texture cells: the material that holds them and their size in the atlas, px.
CELLS = {
    "upper": ("cloth", (192, 192)), "sleeve": ("cloth", (128, 192)), "skirt": ("cloth", (192, 256)),
    "overskirt": ("cloth", (128, 128)), "apron": ("cloth", (128, 160)), "cape": ("cloth", (128, 192)),
    "lining": ("cloth", (64, 64)), "trousers": ("cloth", (128, 128)), "hose": ("cloth", (64, 128)),
    "coif": ("cloth", (96, 96)), "collar": ("cloth", (96, 64)), "hood": ("cloth", (96, 128)),
    "hat": ("cloth", (160, 96)), "hair": ("trim", (160, 96)), "belt": ("trim", (96, 64)),
    "plate": ("trim", (160, 160)), "boots": ("trim", (96, 96)), "pouch": ("trim", (64, 64)),
}

MALE = {"tint": (0.97, 0.95, 0.93), "smooth": 0.0}
FEMALE = {"tint": (1.05, 1.0, 0.97), "smooth": 1.0, "rouge": 1.0}
TANNED = {"tint": (0.86, 0.80, 0.74), "smooth": 0.0}

WOMAN_SHAPE = {"trunk": (0.90, 0.94, 0.98), "arms": (0.92, 0.92, 0.92), "hands": (0.88, 0.88, 0.88),
               "head": (0.95, 0.96, 0.97), "neck": (0.86, 0.88, 1.02), "feet": (0.88, 0.90, 0.9),
               "legs": (0.94, 0.94, 0.97)}
WOMAN_BULGES = [
    {"at": "chest", "by": (0.075, -0.12, -0.005), "radius": (0.11, 0.12, 0.11), "push": (0.008, -0.045, -0.004),
     "mirror": True},
    {"at": "waist", "by": (0.16, 0, 0.03), "radius": (0.14, 0.25, 0.14), "push": (-0.022, 0, 0), "mirror": True},
    {"at": "hip", "by": (0.17, 0.02, 0.02), "radius": (0.16, 0.25, 0.18), "push": (0.022, 0.0, 0), "mirror": True},
]

def eyes_by(swell):
    return {"at": "brow", "by": (0.031, 0.010, -0.018), "radius": (0.028, 0.04, 0.024), "swell": swell, "mirror": True}


WOMAN_FACE = [
    {"at": "nose", "by": (0, 0.012, 0), "radius": (0.03, 0.04, 0.035), "push": (0, 0.008, 0.002), "swell": -0.12},
    {"at": "chin", "by": (0.055, 0.06, 0.01), "radius": (0.05, 0.07, 0.05), "push": (-0.011, 0, 0), "mirror": True},
    {"at": "brow", "by": (0, 0, 0.006), "radius": (0.06, 0.04, 0.026), "push": (0, 0.004, 0)},
    {"at": "mouth", "by": (0, 0, 0), "radius": (0.03, 0.03, 0.02), "push": (0, -0.002, 0), "swell": 0.08},
    {"at": "chin", "by": (0, 0.01, 0), "radius": (0.035, 0.04, 0.03), "push": (0, 0.004, 0.004)}, eyes_by(0.20),
]
CHILD_FACE = [
    {"at": "nose", "by": (0, 0.015, 0), "radius": (0.04, 0.05, 0.045), "push": (0, 0.014, 0.004), "swell": -0.30},
    {"at": "nose", "by": (0.045, 0.035, -0.012), "radius": (0.04, 0.05, 0.04), "push": (0.003, -0.007, 0), "mirror": True},
    {"at": "chin", "by": (0.055, 0.06, 0.01), "radius": (0.05, 0.07, 0.05), "push": (-0.006, 0, 0.003), "mirror": True},
    {"at": "brow", "by": (0, 0, 0.008), "radius": (0.07, 0.05, 0.035), "push": (0, 0.007, 0)},
    {"at": "mouth", "by": (0, 0, 0), "radius": (0.04, 0.04, 0.025), "push": (0, 0.004, 0), "swell": -0.12},
    {"at": "mouth", "by": (0.022, 0.012, 0.0), "radius": (0.015, 0.02, 0.012), "push": (0, 0, 0.004), "mirror": True},
    {"at": "chin", "by": (0, 0.01, 0), "radius": (0.045, 0.05, 0.035), "push": (0, 0.006, 0.007)}, eyes_by(0.22),
]
BELLY = {"at": "waist", "by": (0, -0.10, 0.0), "radius": (0.24, 0.22, 0.24), "push": (0, -0.07, -0.01)}

SHORT_HAIR = {"piece": "shell", "name": "hair", "thickness": 0.007, "crown_thickness": 0.016, "roughness": 0.003,
              "edge": [[0, 48], [35, 38], [62, 16], [80, 2], [100, -4], [130, -26], [180, -36]]}
LONG_HAIR = {"piece": "shell", "name": "hair", "thickness": 0.014, "crown_thickness": 0.016, "roughness": 0.004,
             "nape": 0.012,
             "edge": [[0, 48], [35, 38], [58, 14], [72, -16], [95, -34], [130, -46], [180, -52]]}
WOMAN_HAIR = {"piece": "shell", "name": "hair", "thickness": 0.006, "crown_thickness": 0.012, "roughness": 0.002,
              "edge": [[0, 50], [30, 44], [58, 20], [78, 0], [100, -6], [130, -26], [180, -36]]}
COIF = {"piece": "shell", "name": "coif", "thickness": 0.014, "crown_thickness": 0.020, "peak": 0.020,
        "cell": "coif", "edge": [[0, 62], [35, 55], [65, 26], [85, -14], [105, -32], [140, -40], [180, -44]]}
BEARD = {"piece": "beard"}
BAND = {"piece": "cape", "name": "band", "top_deg": 70, "bottom_deg": 50, "ease": 0.012, "columns": 28, "cell": "collar"}
STOCKINGS = {"piece": "legs", "name": "hose", "start": 0.4, "end": 2.0}
SHORT_STOCKINGS = {"piece": "legs", "name": "hose", "start": 1.35, "end": 2.0, "rows": 7}
CLOSE_SLEEVE = [[0, 0.074], [0.6, 0.064], [1, 0.058], [1.5, 0.052], [1.93, 0.041]]
WIDE_SLEEVE = [[0, 0.082], [0.6, 0.084], [1, 0.078], [1.6, 0.066], [1.85, 0.046], [1.93, 0.044]]


def dyed(weave, colour, **look):
    return dict(look, weave=weave, colour=colour)


PEOPLE = {
    "merchant": {
        "height_m": 1.76, "skin": MALE, "bulges": [BELLY],
        "manner": {"arm_swing": 0.3, "arm_forward_deg": 13.0},
        "wear": [
            STOCKINGS,
            {"piece": "trousers", "name": "breeches", "bottom": ["knee", 0.02], "ease": 0.012, "puff": 0.035},
            {"piece": "upper", "name": "doublet", "bottom": ["hip", 0.03], "ease": 0.012, "smooth": 12,
             "sleeve": WIDE_SLEEVE},
            {"piece": "skirt", "name": "doublet", "top": ["waist", -0.02], "hem": ["crotch", -0.02], "ease": 0.014,
             "flare": 0.22, "folds": 14, "fold_depth": 0.012, "rows": 6, "cell": "overskirt"},
            {"piece": "belt", "at": ["waist", -0.02], "height": 0.035},
            {"piece": "pouch", "at": ["waist", -0.05], "angle_deg": -60, "cell": "pouch"},
            {"piece": "brows"}, dict(SHORT_HAIR), dict(BEARD), {"piece": "moustache"},
            {"piece": "cape", "name": "cloak", "top_deg": 65, "bottom_deg": 0, "ease": 0.024, "open_deg": 62,
             "hem": ["crotch", 0.02], "flare": 0.22, "folds": 8, "fold_depth": 0.03, "lining": "lining"},
            {"piece": "standing collar", "height": 0.035, "flare": 0.0, "cell": "upper"}, {"piece": "ruff"},
            {"piece": "hat", "profile": [[0, 0, 0.118], [0.45, 0, 0.120], [0.80, 0, 0.112], [0.93, 0, 0.06], [1, 0, 0],
                                         [1.0, 0.045, -0.004], [1.0, 0.072, 0.002], [1.0, 0.070, -0.006],
                                         [1.0, 0.02, -0.012]], "wave": 0.006},
        ],
        "cloth": {
            "upper": dyed("velvet", (0.36, 0.09, 0.10), placket=[0.03, (0.28, 0.06, 0.07), 12, (0.75, 0.60, 0.28)]),
            "overskirt": dyed("velvet", (0.36, 0.09, 0.10), trim=[[0.86, 0.93, (0.62, 0.48, 0.22)]]),
            "sleeve": dyed("velvet", (0.36, 0.09, 0.10), trim=[[0.88, 0.93, (0.85, 0.82, 0.74)]], stripes=[9, (0.30, 0.07, 0.08)]),
            "trousers": dyed("wool", (0.17, 0.14, 0.13), stripes=[10, (0.24, 0.19, 0.16)]),
            "hose": dyed("wool", (0.28, 0.25, 0.22)), "cape": dyed("wool", (0.13, 0.13, 0.15)),
            "lining": dyed("linen", (0.42, 0.12, 0.11)), "collar": dyed("linen", (0.90, 0.88, 0.83)),
            "hat": dyed("velvet", (0.10, 0.09, 0.09), trim=[[0.42, 0.5, (0.5, 0.38, 0.16)]]),
            "hair": dyed("hair", (0.24, 0.16, 0.10)), "belt": dyed("leather", (0.16, 0.10, 0.07)),
            "pouch": dyed("leather", (0.34, 0.21, 0.12)),
        },
    },
    "farmer": {
        "height_m": 1.72, "skin": TANNED,
        "manner": {"arm_spread_deg": -1.0},
        "wear": [
            dict(STOCKINGS, start=0.2),
            {"piece": "upper", "name": "tunic", "bottom": ["waist", -0.05], "ease": 0.014, "smooth": 10,
             "sleeve": [[0, 0.080], [1, 0.068], [1.7, 0.056], [1.9, 0.052]]},
            {"piece": "skirt", "name": "tunic", "top": ["waist", 0.01], "hem": ["knee", 0.03], "ease": 0.012,
             "flare": 0.20, "folds": 11, "fold_depth": 0.022, "rows": 9},
            {"piece": "belt", "at": ["waist", 0.0], "height": 0.04},
            {"piece": "pouch", "at": ["waist", -0.02], "angle_deg": 50},
            {"piece": "brows"}, dict(BEARD, thickness=0.012), dict(SHORT_HAIR),
            {"piece": "shell", "name": "hood", "thickness": 0.022, "crown_thickness": 0.020, "peak": 0.035,
             "columns": 40, "nape": 0.01, "cell": "hood",
             "drop": 0.07,
             "edge": [[0, 44], [30, 38], [48, 18], [58, -14], [66, -40], [80, -50], [180, -52]]},
            {"piece": "cape", "name": "hood", "top_deg": 68, "bottom_deg": 12, "ease": 0.026, "point": 0.03},
        ],
        "cloth": {
            "upper": dyed("wool", (0.47, 0.40, 0.29)), "sleeve": dyed("wool", (0.47, 0.40, 0.29)),
            "skirt": dyed("wool", (0.47, 0.40, 0.29), hem=0.55, folds=0.2),
            "hose": dyed("wool", (0.30, 0.24, 0.19), hem=0.4), "belt": dyed("leather", (0.24, 0.15, 0.09)),
            "hood": dyed("wool", (0.27, 0.32, 0.20)), "cape": dyed("wool", (0.27, 0.32, 0.20)),
            "hair": dyed("hair", (0.40, 0.28, 0.17)),
        },
    },
    "craftsman": {
        "height_m": 1.75, "skin": TANNED, "bare_arm_from": 0.9,
        "manner": {"arm_spread_deg": 0.0},
        "wear": [
            dict(STOCKINGS, start=0.9),
            {"piece": "trousers", "name": "breeches", "bottom": ["knee", -0.06], "ease": 0.006, "puff": 0.015},
            {"piece": "upper", "name": "shirt", "bottom": ["waist", -0.06], "ease": 0.012, "smooth": 6,
             "sleeve": [[0, 0.085], [0.6, 0.088], [1.0, 0.080], [1.15, 0.058], [1.22, 0.056]]},
            {"piece": "skirt", "name": "shirt", "top": ["waist", 0.0], "hem": ["crotch", -0.06], "ease": 0.012,
             "flare": 0.2, "folds": 12, "fold_depth": 0.014, "rows": 7},
            {"piece": "skirt", "name": "form", "top": ["waist", 0.0], "hem": ["knee", -0.06], "ease": 0.022,
             "flare": 0.16, "folds": 5, "fold_depth": 0.010, "rows": 9, "follow": 0.85, "shin": 0.2, "hidden": True},
            {"piece": "apron", "over": "form", "hem_row": 1.0, "bib_top": ["chest", 0.05], "half_angle_deg": 66},
            {"piece": "belt", "at": ["waist", 0.0], "height": 0.028}, dict(BAND),
            {"piece": "brows"}, dict(SHORT_HAIR), dict(BEARD), {"piece": "moustache"},
            {"piece": "hat", "name": "cap", "sit": 0.024, "tilt_deg": -10, "profile": [
                [0, 0, 0.070], [0.6, 0, 0.072], [1.0, 0.020, 0.058], [1.0, 0.032, 0.034], [1.0, 0.010, 0.006], [1.0, 0.006, -0.014],
                [0.96, 0, -0.018]]},
        ],
        "cloth": {
            "upper": dyed("linen", (0.74, 0.69, 0.58), placket=[0.012, (0.5, 0.45, 0.36), 0, None]),
            "sleeve": dyed("linen", (0.74, 0.69, 0.58)), "skirt": dyed("linen", (0.74, 0.69, 0.58)),
            "apron": dyed("leather", (0.40, 0.26, 0.15), hem=0.3), "trousers": dyed("wool", (0.22, 0.27, 0.34)),
            "hose": dyed("wool", (0.50, 0.45, 0.36)), "belt": dyed("leather", (0.22, 0.13, 0.08)),
            "hair": dyed("hair", (0.16, 0.11, 0.08)), "collar": dyed("linen", (0.76, 0.71, 0.60)), "hat": dyed("wool", (0.36, 0.15, 0.11)),
        },
    },
    "townswoman": {
        "height_m": 1.63, "skin": FEMALE, "proportions": WOMAN_SHAPE, "bulges": WOMAN_BULGES + WOMAN_FACE,
        "manner": {"arm_spread_deg": 4.0, "stride": 0.92},
        "wear": [
            SHORT_STOCKINGS,
            {"piece": "upper", "name": "bodice", "bottom": ["waist", -0.05], "ease": 0.006, "smooth": 10,
             "sleeve": CLOSE_SLEEVE},
            {"piece": "skirt", "name": "skirt", "top": ["waist", 0.01], "hem": ["sole", 0.07], "ease": 0.016,
             "flare": 0.18, "folds": 16, "fold_depth": 0.030, "gather": 0.2},
            {"piece": "apron", "over": "skirt", "hem_row": 0.82, "half_angle_deg": 58},
            {"piece": "belt", "at": ["waist", 0.0], "height": 0.03, "thickness": 0.008},
            {"piece": "brows"}, dict(WOMAN_HAIR), dict(COIF),
            dict(BAND),
        ],
        "cloth": {
            "upper": dyed("wool", (0.20, 0.27, 0.38), placket=[0.07, (0.80, 0.77, 0.68), 9, (0.16, 0.12, 0.1)]),
            "sleeve": dyed("wool", (0.20, 0.27, 0.38), trim=[[0.86, 0.93, (0.85, 0.83, 0.77)]]),
            "skirt": dyed("wool", (0.23, 0.29, 0.38), hem=0.45, folds=0.25, trim=[[0.88, 0.91, (0.12, 0.14, 0.2)]]),
            "apron": dyed("linen", (0.84, 0.81, 0.74), hem=0.2), "coif": dyed("linen", (0.88, 0.86, 0.80)),
            "collar": dyed("linen", (0.88, 0.86, 0.80)), "hose": dyed("wool", (0.3, 0.27, 0.24)),
            "belt": dyed("linen", (0.80, 0.77, 0.70)), "hair": dyed("hair", (0.33, 0.22, 0.13)),
        },
    },
    "noblewoman": {
        "height_m": 1.66, "skin": {"tint": (1.10, 1.06, 1.05), "smooth": 1.0, "rouge": 1.2}, "proportions": WOMAN_SHAPE,
        "bulges": WOMAN_BULGES + WOMAN_FACE,
        "manner": {"arm_spread_deg": 6.0, "arm_swing": 0.3, "arm_forward_deg": 14.0, "stride": 0.86},
        "wear": [
            SHORT_STOCKINGS,
            {"piece": "upper", "name": "bodice", "bottom": ["waist", -0.06], "ease": 0.006, "smooth": 14,
             "sleeve": [[0, 0.090], [0.4, 0.094], [1, 0.070], [1.7, 0.050], [1.93, 0.044]]},
            {"piece": "skirt", "name": "gown", "top": ["waist", 0.0], "hem": ["sole", 0.03], "ease": 0.04,
             "flare": 0.20, "folds": 15, "fold_depth": 0.03, "gather": 0.15, "columns": 60},
            {"piece": "belt", "at": ["waist", -0.01], "height": 0.022, "thickness": 0.007},
            {"piece": "brows"}, dict(WOMAN_HAIR),
            {"piece": "cape", "name": "mantle", "top_deg": 64, "bottom_deg": 0, "ease": 0.022, "open_deg": 82,
             "hem": ["knee", -0.22], "flare": 0.16, "folds": 9, "fold_depth": 0.035, "lining": "lining", "hang_rows": 10},
            {"piece": "standing collar", "height": 0.035, "flare": 0.0, "cell": "upper"}, {"piece": "ruff", "outer": 0.14},
            {"piece": "hat", "sit": 0.036, "tilt_deg": -9, "profile": [
                [0, 0, 0.10], [0.5, 0, 0.102], [0.82, 0, 0.092], [0.95, 0, 0.05], [1.0, 0, 0.0], [1.0, 0.030, 0.0],
                [1.0, 0.045, 0.006], [1.0, 0.043, 0.0], [1.0, 0.01, -0.008]]},
            {"piece": "feather"},
        ],
        "cloth": {
            "upper": dyed("velvet", (0.13, 0.22, 0.17), placket=[0.09, (0.66, 0.55, 0.32), 8, (0.85, 0.75, 0.45)]),
            "sleeve": dyed("velvet", (0.13, 0.22, 0.17), trim=[[0.87, 0.93, (0.90, 0.88, 0.83)]], stripes=[7, (0.55, 0.45, 0.24)]),
            "skirt": dyed("velvet", (0.14, 0.24, 0.18), damask=(0.19, 0.30, 0.22), folds=0.25,
                          placket=[0.10, (0.64, 0.53, 0.31), 0, None], trim=[[0.93, 0.965, (0.62, 0.50, 0.27)]]),
            "cape": dyed("velvet", (0.27, 0.07, 0.10), trim=[[0.95, 1.0, (0.60, 0.48, 0.26)]]),
            "lining": dyed("wool", (0.62, 0.56, 0.46)), "collar": dyed("linen", (0.93, 0.91, 0.87)),
            "hose": dyed("wool", (0.3, 0.27, 0.24)), "belt": dyed("metal", (0.70, 0.56, 0.28)),
            "hair": dyed("hair", (0.42, 0.27, 0.13)), "hat": dyed("velvet", (0.11, 0.09, 0.10), trim=[[0.42, 0.52, (0.6, 0.48, 0.24)]]),
        },
    },
    "maid": {
        "height_m": 1.58, "skin": {"tint": (1.0, 0.94, 0.90), "smooth": 1.0, "rouge": 0.9}, "proportions": WOMAN_SHAPE,
        "bulges": WOMAN_BULGES + WOMAN_FACE,
        "manner": {"arm_spread_deg": 4.0, "stride": 0.98},
        "wear": [
            dict(SHORT_STOCKINGS, start=1.1),
            {"piece": "upper", "name": "bodice", "bottom": ["waist", -0.05], "ease": 0.008, "smooth": 8,
             "sleeve": [[0, 0.082], [0.5, 0.080], [1, 0.066], [1.4, 0.056], [1.5, 0.054]]},
            {"piece": "skirt", "name": "skirt", "top": ["waist", 0.01], "hem": ["ankle", 0.10], "ease": 0.016,
             "flare": 0.20, "folds": 13, "fold_depth": 0.030, "gather": 0.25},
            {"piece": "apron", "over": "skirt", "hem_row": 0.9, "half_angle_deg": 50},
            {"piece": "belt", "at": ["waist", 0.0], "height": 0.025, "thickness": 0.007},
            {"piece": "brows"}, dict(WOMAN_HAIR), dict(COIF, peak=0.03, edge=[[0, 58], [35, 50], [65, 24], [85, 0], [105, -12], [140, -30], [180, -40]]),
            {"piece": "cape", "name": "shawl", "top_deg": 62, "bottom_deg": 16, "ease": 0.018, "point": 0.10},
        ],
        "bare_arm_from": 1.25,
        "cloth": {
            "upper": dyed("wool", (0.44, 0.20, 0.13)), "sleeve": dyed("linen", (0.80, 0.76, 0.68)),
            "skirt": dyed("wool", (0.50, 0.36, 0.17), hem=0.55, folds=0.25), "apron": dyed("linen", (0.68, 0.64, 0.56), hem=0.3),
            "coif": dyed("linen", (0.82, 0.79, 0.72)), "cape": dyed("wool", (0.40, 0.42, 0.44), stripes=[6, (0.33, 0.34, 0.37)]),
            "hose": dyed("wool", (0.35, 0.3, 0.26)), "belt": dyed("linen", (0.62, 0.58, 0.5)),
            "hair": dyed("hair", (0.45, 0.32, 0.18)),
        },
    },
    "monk": {
        "height_m": 1.74, "skin": MALE,         "bulges": [dict(BELLY, push=(0, -0.05, 0))],
        "manner": {"arm_spread_deg": 3.0, "stride": 0.88},
        "wear": [
            SHORT_STOCKINGS,
            {"piece": "upper", "name": "habit", "bottom": ["waist", -0.04], "ease": 0.018, "smooth": 14,
             "sleeve": [[0, 0.075], [1, 0.078], [1.6, 0.095], [1.95, 0.115]]},
            {"piece": "skirt", "name": "habit", "top": ["waist", 0.02], "hem": ["sole", 0.055], "ease": 0.022,
             "flare": 0.12, "folds": 13, "fold_depth": 0.035},
            {"piece": "belt", "at": ["waist", 0.01], "height": 0.026, "thickness": 0.016},
            {"piece": "cord", "start": ["waist", 0.0], "end": ["knee", 0.05], "angle_deg": 30},
            {"piece": "brows"},
            {"piece": "shell", "name": "hair", "thickness": 0.008, "roughness": 0.003,
             "edge": [[0, 44], [40, 34], [70, 10], [95, 4], [130, -25], [180, -34]]},
            {"piece": "cape", "name": "cowl", "top_deg": 66, "bottom_deg": 8, "ease": 0.03},
        ],
        "cloth": {
            "upper": dyed("wool", (0.30, 0.21, 0.14)), "sleeve": dyed("wool", (0.30, 0.21, 0.14)),
            "skirt": dyed("wool", (0.30, 0.21, 0.14), hem=0.5, folds=0.25), "cape": dyed("wool", (0.28, 0.19, 0.13)),
            "hose": dyed("wool", (0.25, 0.2, 0.16)), "belt": dyed("rope", (0.72, 0.65, 0.5)),
            "hair": dyed("hair", (0.22, 0.16, 0.11)),
        },
    },
    "guard": {
        "height_m": 1.80, "skin": TANNED, "proportions": {"trunk": (1.04, 1.03, 1.0)},
        "manner": {"arm_spread_deg": 2.0},
        "wear": [
            dict(STOCKINGS, start=0.9),
            {"piece": "trousers", "name": "breeches", "bottom": ["knee", 0.0], "ease": 0.016, "puff": 0.05},
            {"piece": "legs", "name": "boots", "start": 1.25, "end": 2.02, "ease": 0.010, "rows": 9, "cell": "boots"},
            {"piece": "upper", "name": "jacket", "bottom": ["waist", -0.06], "ease": 0.010, "sleeve": WIDE_SLEEVE},
            {"piece": "skirt", "name": "jacket", "top": ["waist", 0.0], "hem": ["crotch", -0.08], "ease": 0.016,
             "flare": 0.22, "folds": 14, "fold_depth": 0.016, "rows": 7},
            {"piece": "plate", "bottom": ["waist", -0.03]},
            {"piece": "belt", "at": ["waist", -0.03], "height": 0.045},
            {"piece": "brows"}, dict(SHORT_HAIR), dict(BEARD), {"piece": "moustache", "thickness": 0.013},
            dict(BAND),
            {"piece": "hat", "name": "helmet", "sit": 0.020, "tilt_deg": -3, "cell": "plate", "profile": [
                [0, 0, 0.135], [0.35, 0, 0.128], [0.65, 0, 0.108], [0.88, 0, 0.070], [1.0, 0.0, 0.020],
                [1.0, 0.012, 0.004], [1.0, 0.060, -0.022], [1.0, 0.063, -0.030], [1.0, 0.010, -0.012]]},
        ],
        "shoe_tint": (0.42, 0.36, 0.33),
        "cloth": {
            "upper": dyed("wool", (0.50, 0.37, 0.13)), "sleeve": dyed("wool", (0.50, 0.37, 0.13), stripes=[8, (0.16, 0.20, 0.30)]),
            "skirt": dyed("wool", (0.50, 0.37, 0.13), stripes=[12, (0.16, 0.20, 0.30)]),
            "trousers": dyed("wool", (0.44, 0.33, 0.13)),
            "hose": dyed("wool", (0.30, 0.28, 0.27)), "boots": dyed("leather", (0.22, 0.14, 0.09), hem=0.4),
            "plate": dyed("metal", (0.42, 0.43, 0.45)), "belt": dyed("leather", (0.20, 0.12, 0.07)),
            "collar": dyed("linen", (0.80, 0.77, 0.7)), "hair": dyed("hair", (0.20, 0.14, 0.09)),
        },
    },
    "child": {
        "height_m": 1.20, "skin": {"tint": (1.08, 1.01, 0.97), "smooth": 1.0, "rouge": 0.8}, "bulges": CHILD_FACE,         "proportions": {"head": (1.30, 1.27, 1.20), "neck": (0.95, 0.95, 0.9), "trunk": (0.88, 0.95, 0.90), "arms": (0.90, 0.90, 0.90),
                        "hands": (0.95, 0.95, 0.95), "legs": (0.98, 0.98, 0.86), "feet": (1.0, 0.98, 1.0)},
        "manner": {"arm_spread_deg": 1.0, "stride": 1.0},
        "wear": [
            dict(STOCKINGS, start=0.3),
            {"piece": "upper", "name": "tunic", "bottom": ["waist", -0.05], "ease": 0.016, "smooth": 14,
             "sleeve": [[0, 0.082], [1, 0.070], [1.7, 0.056], [1.88, 0.052]]},
            {"piece": "skirt", "name": "tunic", "top": ["waist", 0.01], "hem": ["knee", 0.01], "ease": 0.016,
             "flare": 0.26, "folds": 11, "fold_depth": 0.022, "rows": 9},
            {"piece": "belt", "at": ["waist", 0.0], "height": 0.03},
            {"piece": "brows"}, dict(LONG_HAIR),
            dict(BAND),
            {"piece": "hat", "name": "cap", "sit": 0.040, "tilt_deg": -14, "profile": [
                [0, 0, 0.080], [0.6, 0, 0.078], [1.0, 0.018, 0.056], [1.0, 0.028, 0.026], [1.0, 0.008, 0.004], [1.0, 0.004, -0.012],
                [0.96, 0, -0.016]]},
        ],
        "cloth": {
            "upper": dyed("wool", (0.52, 0.24, 0.15), placket=[0.012, (0.36, 0.15, 0.10), 5, (0.25, 0.18, 0.12)]),
            "sleeve": dyed("wool", (0.52, 0.24, 0.15)),
            "skirt": dyed("wool", (0.52, 0.24, 0.15), hem=0.35, folds=0.2, trim=[[0.90, 0.94, (0.62, 0.52, 0.32)]]),
            "hose": dyed("wool", (0.46, 0.42, 0.34), hem=0.3), "belt": dyed("leather", (0.22, 0.14, 0.08)),
            "collar": dyed("linen", (0.84, 0.81, 0.74)), "hair": dyed("hair", (0.50, 0.36, 0.19)),
            "hat": dyed("wool", (0.24, 0.28, 0.36)),
        },
    },
    "old_man": {
        "height_m": 1.69, "skin": {"tint": (0.98, 0.94, 0.92), "smooth": 0.6},         "bulges": [dict(BELLY, push=(0, -0.035, 0))],
        "manner": {"arm_spread_deg": 1.0, "stride": 0.76, "liveliness": 0.7, "arm_swing": 0.3, "arm_forward_deg": 10.0, "stoop_deg": 8.0},
        "wear": [
            dict(STOCKINGS, start=1.0),
            {"piece": "upper", "name": "coat", "bottom": ["waist", -0.05], "ease": 0.014, "smooth": 12,
             "sleeve": [[0, 0.080], [1, 0.070], [1.6, 0.066], [1.9, 0.062]]},
            {"piece": "skirt", "name": "coat", "top": ["waist", 0.01], "hem": ["knee", -0.20], "ease": 0.016,
             "flare": 0.15, "folds": 12, "fold_depth": 0.028},
            {"piece": "belt", "at": ["waist", 0.0], "height": 0.035},
            {"piece": "brows"}, dict(LONG_HAIR), dict(BEARD, thickness=0.02, length=0.10), {"piece": "moustache", "thickness": 0.014},
            {"piece": "cape", "name": "cloak", "top_deg": 66, "bottom_deg": 0, "ease": 0.028, "open_deg": 64,
             "hem": ["knee", 0.0], "flare": 0.17, "folds": 9, "fold_depth": 0.035, "hang_rows": 9},
            {"piece": "hat", "name": "cap", "sit": 0.024, "tilt_deg": -8, "profile": [
                [0, 0, 0.088], [0.6, 0, 0.085], [1.0, 0.024, 0.060], [1.0, 0.036, 0.026], [1.0, 0.010, 0.004], [1.0, 0.008, -0.016],
                [0.96, 0, -0.02]]},
        ],
        "cloth": {
            "upper": dyed("wool", (0.26, 0.24, 0.27)), "sleeve": dyed("wool", (0.26, 0.24, 0.27)),
            "skirt": dyed("wool", (0.26, 0.24, 0.27), hem=0.4, folds=0.2), "cape": dyed("wool", (0.34, 0.24, 0.16), hem=0.3),
            "hose": dyed("wool", (0.30, 0.28, 0.25)), "belt": dyed("leather", (0.20, 0.13, 0.08)),
            "hair": dyed("hair", (0.70, 0.68, 0.64)), "hat": dyed("velvet", (0.15, 0.12, 0.12)),
        },
    },
}
