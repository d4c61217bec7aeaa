"""How much shows for how much detail: the drawn paths once more with less discretion, and all modes as points of one plot."""
import statistics

from figures import drawn_runs, plots, told_apart

DISCRETIONS = (0, 0.25, 0.5, 0.75)  # 1 is what `full` is played with
GROUP = "less discretion"


def planned_jobs(jobs):
    """Those of the drawn paths with full adaptation, with other discretions."""
    return [{**job, "group": GROUP, "discretion": d, "case": f"{job['case']}, discretion {d}"} for d in DISCRETIONS for job in jobs
            if job["mode"] == "full"]


def sides(runs, seed):
    return {run["path"]: run["pieces"] for run in runs if run["seed"] == seed}


def auc_against(runs, off):
    """Mean AUC over the paths, both seeds against the other seed of off; None where nothing can be told."""
    first, second = drawn_runs.CROWD_SEEDS
    scores = [score for a, b in ((first, second), (second, first)) for score in told_apart.told_apart(sides(runs, a), sides(off, b)).values()]
    return statistics.fmean(scores) if scores else None


def points(drawn, others):
    """[{name, mode, exceeded, told_apart}]: off, the paper's way, and full from the strictest to the most discreet."""
    off = [run for run in drawn if run["mode"] == "off"]
    sets = [(mode, mode, [run for run in drawn if run["mode"] == mode]) for mode in ("off", "paper")]
    sets += [(f"full, discretion {d:g}", "full", [run for run in others if run["discretion"] == d]) for d in DISCRETIONS]
    sets.append(("full, discretion 1", "full", [run for run in drawn if run["mode"] == "full"]))
    return [{"name": name, "mode": mode, "exceeded": statistics.fmean(run["figures"]["exceeded"] for run in some),
             "told_apart": auc_against(some, off)} for name, mode, some in sets if some]


def plot(found, width=760, height=440):
    """AUC over frames exceeded, full's points joined."""
    shown = [p for p in found if p["told_apart"] is not None]
    script = (f'set terminal svg size {width},{height} {plots.FONT} background rgb "#ffffff"\nset output "plot.svg"\n{plots.STYLE}'
              'set encoding utf8\nset xlabel "frames exceeded, mean over the paths, %"\nset ylabel "told apart from off, AUC within 15 m"\n'
              "set offsets 0, graph 0.3, graph 0.1, graph 0.1\nset xrange [0:]\n")
    for k, p in enumerate(shown):
        script += (f'set label {k + 1} "  {p["name"]}" at {100 * p["exceeded"]:.4f},{p["told_apart"]:.4f} left point pt 7 ps 0.8 '
                   f'lc rgb "{plots.COLOURS[p["mode"]]}" textcolor rgb "{plots.COLOURS[p["mode"]]}"\n')
    rows = [[100 * p["exceeded"], p["told_apart"], 1 if p["mode"] == "full" else 0] for p in shown]
    script += (f'plot "all" u 1:2 w p pt 7 ps 0.1 lc rgb "#ffffff", "all" u ($3 > 0.5 ? $1 : NaN):2 w l lc rgb "{plots.COLOURS["full"]}"\n')
    return plots.gnuplot(script, {"all": rows})
