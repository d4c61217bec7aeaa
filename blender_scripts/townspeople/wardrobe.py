"""What several townspeople share: shapes, faces, hair, and garments, as plain data (see
people.py).
"""

# Texture cells: the material that holds them and their size in the atlas, px.
CELLS = {
    "upper": ("cloth", (176, 184)), "sleeve": ("cloth", (128, 184)), "skirt": ("cloth", (208, 184)),
    "overskirt": ("cloth", (128, 128)), "apron": ("cloth", (120, 144)),
    "cape": ("cloth", (128, 184)),
    "lining": ("cloth", (64, 64)), "trousers": ("cloth", (128, 128)), "hose": ("cloth", (64, 128)),
    "coif": ("cloth", (96, 96)), "collar": ("cloth", (96, 64)), "hood": ("cloth", (96, 128)),
    "hat": ("cloth", (160, 96)), "hair": ("trim", (160, 96)), "belt": ("trim", (96, 64)),
    "plate": ("trim", (160, 160)), "boots": ("trim", (96, 96)), "pouch": ("trim", (64, 64)),
}

MALE = {"tone": (0.565, 0.425, 0.345), "smooth": 0.5}
FEMALE = {"tone": (0.575, 0.44, 0.36), "smooth": 1.0, "rouge": 0.9,
          "brow": {"rise": 17.0, "half": 2.1, "arch": 2.8, "strength": 0.65}}
TANNED = {"tone": (0.51, 0.375, 0.30), "smooth": 0.4, "age": 0.2}
OLD = {"tone": (0.56, 0.43, 0.36), "smooth": 0.4, "age": 1.0, "brow": {"half": 3.4, "fall": 4.0}}
CHILDLIKE = {"tone": (0.575, 0.44, 0.36), "smooth": 1.0, "rouge": 0.8,
             "brow": {"rise": 17.0, "half": 2.0, "strength": 0.55}}

WOMAN_SHAPE = {"trunk": (0.90, 0.94, 0.98), "arms": (0.92, 0.92, 0.92), "hands": (0.88, 0.88, 0.88),
               "head": (0.95, 0.96, 0.97), "neck": (0.86, 0.88, 1.02), "feet": (0.88, 0.90, 0.9),
               "legs": (0.94, 0.94, 0.97)}
CHILD_SHAPE = {"head": (1.30, 1.27, 1.20), "neck": (0.95, 0.95, 0.9), "trunk": (0.88, 0.95, 0.90),
               "arms": (0.90, 0.90, 0.90), "hands": (0.95, 0.95, 0.95), "legs": (0.98, 0.98, 0.86),
               "feet": (1.0, 0.98, 1.0)}
WOMAN_BULGES = [
    {"at": "chest", "by": (0.075, -0.12, -0.005), "radius": (0.11, 0.12, 0.11),
     "push": (0.008, -0.045, -0.004),
     "mirror": True},
    {"at": "waist", "by": (0.16, 0, 0.03), "radius": (0.14, 0.25, 0.14), "push": (-0.022, 0, 0),
     "mirror": True},
    {"at": "hip", "by": (0.17, 0.02, 0.02), "radius": (0.16, 0.25, 0.18), "push": (0.022, 0.0, 0),
     "mirror": True},
]


def eyes_by(swell):
    """A bump that opens the eyes wider."""
    return {"at": "brow", "by": (0.031, 0.010, -0.018), "radius": (0.028, 0.04, 0.024),
            "swell": swell, "mirror": True}


WOMAN_FACE = [
    {"at": "nose", "by": (0, 0.012, 0), "radius": (0.03, 0.04, 0.035), "push": (0, 0.008, 0.002),
     "swell": -0.12},
    {"at": "chin", "by": (0.055, 0.06, 0.01), "radius": (0.05, 0.07, 0.05), "push": (-0.011, 0, 0),
     "mirror": True},
    {"at": "brow", "by": (0, 0, 0.006), "radius": (0.06, 0.04, 0.026), "push": (0, 0.004, 0)},
    {"at": "mouth", "by": (0, 0, 0), "radius": (0.03, 0.03, 0.02), "push": (0, -0.002, 0),
     "swell": 0.08},
    {"at": "chin", "by": (0, 0.01, 0), "radius": (0.035, 0.04, 0.03), "push": (0, 0.004, 0.004)},
    eyes_by(0.20),
]
CHILD_FACE = [
    {"at": "nose", "by": (0, 0.015, 0), "radius": (0.04, 0.05, 0.045), "push": (0, 0.014, 0.004),
     "swell": -0.30},
    {"at": "nose", "by": (0.045, 0.035, -0.012), "radius": (0.04, 0.05, 0.04),
     "push": (0.003, -0.007, 0), "mirror": True},
    {"at": "chin", "by": (0.055, 0.06, 0.01), "radius": (0.05, 0.07, 0.05),
     "push": (-0.006, 0, 0.003), "mirror": True},
    {"at": "brow", "by": (0, 0, 0.008), "radius": (0.07, 0.05, 0.035), "push": (0, 0.007, 0)},
    {"at": "mouth", "by": (0, 0, 0), "radius": (0.04, 0.04, 0.025), "push": (0, 0.004, 0),
     "swell": -0.12},
    {"at": "mouth", "by": (0.022, 0.012, 0.0), "radius": (0.015, 0.02, 0.012),
     "push": (0, 0, 0.004), "mirror": True},
    {"at": "chin", "by": (0, 0.01, 0), "radius": (0.045, 0.05, 0.035), "push": (0, 0.006, 0.007)},
    eyes_by(0.22),
]
BELLY = {"at": "waist", "by": (0, -0.10, 0.0), "radius": (0.24, 0.22, 0.24),
         "push": (0, -0.07, -0.01)}

SHORT_HAIR = {"piece": "shell", "name": "hair", "thickness": 0.007, "crown_thickness": 0.016,
              "roughness": 0.003,
              "edge": [[0, 48], [35, 38], [62, 16], [80, 2], [100, -4], [130, -26], [180, -36]]}
LONG_HAIR = {"piece": "shell", "name": "hair", "thickness": 0.014, "crown_thickness": 0.016,
             "roughness": 0.004,
             "nape": 0.012,
             "edge": [[0, 48], [35, 38], [58, 14], [72, -16], [95, -34], [130, -46], [180, -52]]}
WOMAN_HAIR = {"piece": "shell", "name": "hair", "thickness": 0.006, "crown_thickness": 0.012,
              "roughness": 0.002,
              "edge": [[0, 50], [30, 44], [58, 20], [78, 0], [100, -6], [130, -26], [180, -36]]}
COIF = {"piece": "shell", "name": "coif", "thickness": 0.006, "crown_thickness": 0.009,
        "peak": 0.020,
        "cell": "coif", "edge": [[0, 62], [35, 55], [65, 26], [85, -14], [105, -32], [140, -40],
                                 [180, -44]]}
BEARD = {"piece": "beard"}
YOKE = {"piece": "cape", "name": "yoke", "top_deg": 71, "bottom_deg": 46, "ease": 0.008, "columns": 28,
        "cell": "upper"}
BAND = {"piece": "cape", "name": "band", "top_deg": 70, "bottom_deg": 50, "ease": 0.012,
        "columns": 28, "cell": "collar"}
STOCKINGS = {"piece": "legs", "name": "hose", "start": 0.4, "end": 2.0}
SHORT_STOCKINGS = {"piece": "legs", "name": "hose", "start": 1.35, "end": 2.0, "rows": 7}
CLOSE_SLEEVE = [[0, 0.074], [0.6, 0.064], [1, 0.058], [1.5, 0.052], [1.93, 0.041]]
WIDE_SLEEVE = [[0, 0.082], [0.6, 0.084], [1, 0.078], [1.6, 0.066], [1.85, 0.046], [1.93, 0.044]]


def dyed(weave, colour, **look):
    """How a texture cell looks: its weave, its colour and what else materials.paint knows."""
    return dict(look, weave=weave, colour=colour)
