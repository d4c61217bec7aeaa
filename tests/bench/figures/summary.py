"""Medians and worst seeds of the runs, and what they say to the targets."""
import fnmatch
import statistics

from figures.targets import FIGURES, MODES, TARGETS

FIGURE = {figure.key: figure for figure in FIGURES}
LEAST_IS_WORST = {target.key for target in TARGETS if target.sense == "least"}


def summarise(runs):
    """{scenario: {mode: {figure: {median, worst, cases: {case: value}}}}}; figures without values are left out."""
    summary = {}
    for scenario in dict.fromkeys(run["group"] for run in runs):
        for mode in MODES:
            chosen = [run for run in runs if run["group"] == scenario and run["mode"] == mode]
            if chosen:
                summary.setdefault(scenario, {})[mode] = {key: s for key in FIGURE if (s := spread(key, chosen))}
    return summary


def spread(key, runs):
    """Median and worst of one figure over the runs, or None where none has it."""
    cases = {run["case"]: run["figures"][key] for run in runs if run["figures"].get(key) is not None}
    if not cases:
        return None
    worst = min if key in LEAST_IS_WORST else max
    return {"median": statistics.median(cases.values()), "worst": worst(cases.values()), "cases": cases}


def reaches(target, value):
    return value <= target.value if target.sense == "most" else value >= target.value


def verdicts(summary):
    """One dict a target that applies: where it is met least, the median and worst there, and whether it is reached."""
    found = []
    for target in TARGETS:
        places = [(summary[s][m][target.key], s, m) for s in summary if fnmatch.fnmatch(s, target.scenario)
                  for m in target.modes if target.key in summary[s].get(m, {})]
        if not places:
            continue
        order = min if target.sense == "least" else max
        judged, scenario, mode = order(places, key=lambda place: (place[0][target.by], place[0]["worst"]))
        missed = [f"{s} {m}" for figure, s, m in places if not reaches(target, figure[target.by])]
        found.append({"figure": target.key, "scenario": target.scenario, "modes": list(target.modes), "sense": target.sense,
                      "target": target.value, "by": target.by, "worst_in": f"{scenario} {mode}",
                      "median": judged["median"], "worst": judged["worst"], "reached": not missed, "missed_in": missed})
    return found


def shown(key, value):
    """A value of a figure as text."""
    return FIGURE[key].format.format(value)


def terminal_table(results):
    """The verdicts as lines of text."""
    rows = [("figure", "scenario", "target", "median", "worst", "least met in", "")]
    for v in results:
        sign = "≤ " if v["sense"] == "most" else "≥ "
        rows.append((FIGURE[v["figure"]].title, f"{v['scenario']} {named(v['modes'])}", sign + shown(v["figure"], v["target"]),
                     shown(v["figure"], v["median"]), shown(v["figure"], v["worst"]), v["worst_in"],
                     "reached" if v["reached"] else f"MISSED in {len(v['missed_in'])}"))
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows)


# Of each drawn path, for these modes.
PATH_COLUMNS = [("off", "exceeded"), ("paper", "exceeded"), ("full", "exceeded"), ("off", "over"), ("full", "over"), ("full", "filled"),
                ("full", "ring"), ("full", "switches"), ("off", "told_apart"), ("paper", "told_apart"), ("full", "told_apart")]


def path_rows(paths):
    """[path, text, ...] by PATH_COLUMNS; empty where a path has no such figure."""
    return [[path] + [shown(key, modes[mode][key]) if key in modes.get(mode, {}) else "" for mode, key in PATH_COLUMNS]
            for path, modes in paths.items()]


def paths_table(facts):
    """The drawn paths as lines of text."""
    if not facts:
        return ""
    rows = [["path"] + [f"{key} {mode}" for mode, key in PATH_COLUMNS]] + path_rows(facts["paths"])
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows]
    lines += [f"told apart from off, {mode}: AUC {auc:.3f} +- {error:.3f}" for mode, (auc, error) in facts["told_apart"].items()]
    lines += [f"what tells {mode}: " + ", ".join(f"{name} {loss:.3f}" for name, loss in features)
              for mode, features in facts["tells"].items()]
    return "\n".join(lines)


def named(modes):
    return "any" if tuple(modes) == MODES else ", ".join(modes)
