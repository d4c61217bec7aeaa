"""The skin that garments leave to be seen."""

import numpy as np

from townspeople import body, clearance, garments
from townspeople import surface as sf

FACE_HALF_WIDTH, FACE_DEPTH = 0.10, 0.22  # of what is made finer, in heights of the head


def visible_skin(tailor, person):
    """Head, neck and hands: whatever the garments leave to be seen."""
    figure = tailor.figure
    skin = figure.parts["body"]
    centres = sf.face_centres(skin)
    arms = body.joint_share(figure, skin, ("shoulder02", "upperarm", "lowerarm", "wrist", "finger"))
    legs = body.joint_share(figure, skin, ("upperleg", "lowerleg", "foot"))
    keep = []
    arms, legs = sf.face_means(arms, skin.faces), sf.face_means(legs, skin.faces)
    for on_arm, on_leg, centre in zip(arms, legs, centres):
        if on_leg > 0.5:
            keep.append(False)
        elif on_arm > 0.5:
            side = "_L" if centre[0] > 0 else "_R"
            place = garments.arm_place(tailor, side, centre)
            keep.append(place > person.get("bare_arm_from", 1.7))
        else:
            keep.append(centre[2] > tailor.height(("shoulder", -0.02)))
    return _rounded_face(figure, _lengthened_neck(tailor, _tucked(tailor, sf.keep_faces(skin, keep))))


def _rounded_face(figure, skin):
    """Nose and lips finer, whose few corners show from nearby."""
    marks, centres = figure.landmarks, sf.face_centres(skin)
    head = marks["crown"][2] - marks["chin"][2]
    chosen = np.abs(centres[:, 0]) < FACE_HALF_WIDTH * head
    chosen &= (centres[:, 2] > marks["mouth"][2] - 0.09 * head) & (centres[:, 2] < marks["nose"][2] + 0.2 * head)
    chosen &= centres[:, 1] < marks["nose"][1] + FACE_DEPTH * head
    return sf.refined(skin, chosen)


def _tucked(tailor, skin):
    """Skin below the neckline drawn in beneath the cloth."""
    cloth = next(worn for name, worn in tailor.worn.items() if name.startswith("upper"))
    middle = tailor.height("neck")
    line = next(
        cloth.vertices[loop]
        for loop in sf.boundary_loops(cloth)
        if abs(cloth.vertices[loop][:, 2].mean() - middle) < 0.12 * tailor.size
        and abs(cloth.vertices[loop][:, 0].mean()) < 0.03
    )
    gaps = np.linalg.norm(skin.vertices[:, None, :2] - line[None, :, :2], axis=2)
    below = skin.vertices[:, 2] < line[gaps.argmin(axis=1), 2] - 0.006 * tailor.size
    below &= body.joint_share(tailor.figure, skin, ("spine", "clavicle", "neck", "shoulder")) > 0.5
    points = skin.vertices.copy()
    points[below] = clearance.drawn_in(points[below], sf.tree_of([cloth]), 0.008 * tailor.size)
    return sf.with_parts(skin, vertices=points)


def _lengthened_neck(tailor, skin):
    """The neck's open foot drawn down beneath the garments, so that no gap shows at a neckline."""
    loop = next(
        loop
        for loop in sf.boundary_loops(skin)
        if abs(skin.vertices[loop][:, 0].mean()) < 0.02
        and len(loop) > 12
        and skin.vertices[loop][:, 2].mean() < tailor.height("neck")
    )
    edge = skin.vertices[loop]
    rings = [
        edge * [1.02, 1.0, 1.0] - [0, 0, 0.03 * tailor.size],
        edge * [1.0, 1.0, 1.0] - [0, 0, 0.07 * tailor.size],
    ]
    corners = {v: uv for v, uv in zip((v for face in skin.faces for v in face), skin.corner_uv)}
    uv = np.array([corners[v] for v in loop])
    grown = garments.extruded(
        skin, loop, np.array(rings), np.array([skin.weights[loop]] * 2), uv[:, 0], [0.0] * 3, "body"
    )
    added = len(grown.corner_uv) - len(skin.corner_uv)
    ring_uv = np.array(
        [uv[i] for c in range(len(loop)) for i in (c, (c + 1) % len(loop), (c + 1) % len(loop), c)]
    )
    grown.corner_uv[-added:] = np.concatenate([ring_uv] * 2)
    return grown
