"""Makes the clips that Flaneur ships for people whose files bring none: one skeleton, no mesh, as a GLB.

    blender --background --factory-startup --python-exit-code 1 --python build.py -- SETTINGS.json

SETTINGS.json: {"output": "clips.glb", "seed": 1}. assets_src/clips/clips.glb is this script's output: run it anew when a
clip here changes. The skeleton is the demo's townspeople's; every pose and every step is computed here and in
townspeople.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

from clips import gaits  # noqa: E402
from common.settings import load_settings, write_atomically  # noqa: E402
from townspeople import body, scene, work_clips  # noqa: E402
from townspeople import clips as standing  # noqa: E402

HEIGHT_M = 1.72


def main():
    settings = load_settings(required=("output", "seed"), options={"human_rig": body.HUMAN_RIG})
    scene.empty_scene()
    figure = body.proportioned(body.stood(body.load_figure(settings["options"]["human_rig"])), HEIGHT_M, {})
    usual, old = standing.Manner(), standing.Manner(stoop_deg=14.0)
    made = [gaits.walk(figure, gait) for gait in gaits.GAITS]
    made.append(standing.idle_clip(figure, usual))
    made.append(standing.talk_clip(figure, usual))
    made.append(gaits.renamed(standing.idle_clip(figure, old), "idle_old"))
    made += [make(figure, usual) for make in work_clips.CLIPS.values()]
    armature = scene.make_armature(figure.skeleton)
    write_atomically(settings["output"], lambda path: scene.write_glb(path, armature, figure.skeleton, made))
    frames = sum(len(clip.rotations) for clip in made)
    print("clips: %d of %.1f s together" % (len(made), frames / body.WALK_FRAMES_PER_SECOND))


main()
