"""Plots as SVG text, drawn by gnuplot."""
import math
import os
import pathlib
import subprocess
import tempfile

import numpy as np

from figures.runs import MAP_CELL_M, MAP_HALF_M, Failed
from figures.targets import MODES

FONT = 'enhanced font "sans-serif,12"'
COLOURS = {"off": "#9a8f83", "paper": "#c08a2e", "full": "#2f6f73"}
LIMIT_COLOUR = "#a3271c"
STYLE = """
set border 3 lc rgb "#7a6f63" lw 0.8
set tics nomirror scale 0.5 textcolor rgb "#7a6f63"
set key off
"""


def gnuplot(script, data):
    """Runs a script in a folder with the data files {name: array of rows}; the SVG it writes to plot.svg."""
    with tempfile.TemporaryDirectory(prefix="flaneur_plot_") as folder:
        for name, rows in data.items():
            np.savetxt(pathlib.Path(folder, name), rows, fmt="%.5g")
        environment = dict(os.environ, LC_ALL="C.UTF-8")
        try:
            result = subprocess.run(["gnuplot", "-"], input=script, text=True, capture_output=True, cwd=folder, env=environment,
                                    check=False)
        except OSError as error:
            raise Failed("gnuplot not found: install the Debian package gnuplot-nox") from error
        if result.returncode != 0:
            raise Failed("gnuplot: " + (result.stderr.strip().splitlines() or ["failed"])[-1])
        svg = pathlib.Path(folder, "plot.svg").read_text(encoding="utf-8")
    return svg[svg.index("<svg"):]


def candidates_plot(runs, width=1040, height=170):
    """One panel a mode under one another: people within the nominal r_high over time, the limit as a line, what exceeds it
    filled. `runs` are of one case, by mode."""
    modes = [mode for mode in MODES if mode in runs]
    limit, end_s = runs[modes[0]]["limit"], max(run["time_s"][-1] for run in runs.values())
    most = max([limit] + [run["candidates"].max() for run in runs.values()])
    script = (f'set terminal svg size {width},{height * len(modes) + 36} {FONT} background rgb "#ffffff"\n'
              f'set output "plot.svg"\n{STYLE}set encoding utf8\n'
              f"set multiplot layout {len(modes)},1 margins 0.055,0.985,{56 / (height * len(modes) + 36):.4f},0.97 spacing 0,0.06\n"
              f"set xrange [0:{end_s:.3f}]\nset yrange [0:{most + 1:.0f}]\nset ytics {tic(most)}\n")
    data = {}
    for mode in modes:
        run = runs[mode]
        data[mode] = stairs(run["time_s"], run["candidates"])
        last = mode == modes[-1]
        script += (f'set xlabel {chr(34) + "seconds" + chr(34) if last else ""}\n'
                   f'set format x "{"%g" if last else ""}"\nset label 1 "{mode}" at graph 0.005,0.93 textcolor rgb "{COLOURS[mode]}"\n'
                   f'plot "{mode}" u 1:($2 > {limit} ? $2 : {limit}) w filledcurves y={limit} fc rgb "{LIMIT_COLOUR}" fs solid 0.35 noborder, '
                   f'{limit} w l lc rgb "{LIMIT_COLOUR}" dt 2, "{mode}" u 1:2 w l lc rgb "{COLOURS[mode]}" lw 1.3\n')
    return gnuplot(script + "unset multiplot\n", data)


def stairs(time_s, counts):
    """The corners of the curve that stays level until the count changes."""
    change = np.flatnonzero(np.diff(counts)) + 1
    times = np.concatenate([time_s[:1], np.repeat(time_s[change], 2), time_s[-1:]])
    levels = np.concatenate([[counts[0]], np.column_stack([counts[change - 1], counts[change]]).ravel(), [counts[-1]]])
    return np.column_stack([times, levels])


def tic(most):
    """A round distance of tics that makes four to eight of them."""
    for step in (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000):
        if most / step <= 6:
            return step
    return 5000


def maps_plot(runs, width=1040):
    """Density of people around the camera, one map a mode side by side, with the view and the nominal r_high drawn in."""
    modes = [mode for mode in MODES if mode in runs]
    height = round(width / 3 + 40)
    most = max(float(np.quantile(run["map"], 0.995)) for run in runs.values()) or 1
    script = (f'set terminal svg size {width},{height} {FONT} background rgb "#ffffff"\nset output "plot.svg"\n{STYLE}'
              f"set encoding utf8\nset multiplot layout 1,{len(modes)} margins 0.04,0.92,0.1,0.9 spacing 0.04,0\n"
              f"set size ratio -1\nset xrange [{-MAP_HALF_M}:{MAP_HALF_M}]\nset yrange [{-MAP_HALF_M}:{MAP_HALF_M}]\n"
              f'set cbrange [0:{most:.3f}]\nset palette defined (0 "#ffffff", 0.5 "#d9b98a", 1 "#5d2a12")\n')
    data = {}
    middles = np.arange(len(next(iter(runs.values()))["map"])) * MAP_CELL_M - MAP_HALF_M + MAP_CELL_M / 2
    for mode in modes:
        run = runs[mode]
        ahead, right = np.meshgrid(middles, middles, indexing="ij")
        data[mode] = np.column_stack([right.ravel(), ahead.ravel(), run["map"].ravel()])
        data["view"] = view_outline(run["r_high_m"], run["fov_rad"])
        last = mode == modes[-1]
        script += (f'set title "{mode}"\n' + ('set colorbox user origin 0.935,0.15 size 0.015,0.7\nset cblabel "people/m²"\n'
                                              if last else "unset colorbox\n") +
                   f'plot "{mode}" u 1:2:3 w image pixels, "view" w l lc rgb "#2f6f73" lw 1.5\n')
    return gnuplot(script + "unset multiplot\n", data)


def view_outline(r_high_m, fov_rad):
    """The visible high-resolution area, camera at the origin looking up."""
    angles = np.linspace(-fov_rad / 2, fov_rad / 2, 40)
    arc = np.column_stack([r_high_m * np.sin(angles), r_high_m * np.cos(angles)])
    far = MAP_HALF_M / math.cos(fov_rad / 2) if fov_rad < math.pi * 0.8 else r_high_m
    edges = [(far * math.sin(a), far * math.cos(a)) for a in (-fov_rad / 2, fov_rad / 2)]
    return np.vstack([[edges[0]], [(0, 0)], arc[:1], arc, arc[-1:], [(0, 0)], [edges[1]]])
