"""The page of figures: one HTML file that needs nothing else."""
import html

from figures.summary import FIGURE, LEAST_IS_WORST, PATH_COLUMNS, named, path_rows, shown
from figures.targets import FIGURES, MODES

STYLE = """
:root{--ink:#2b2622;--soft:#7a6f63;--line:#e4dccf;--paper:#fbf8f2;--card:#fff;--accent:#8a4b2a}
body{font:15px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--paper);max-width:1080px;margin:2.5rem auto;padding:0 1.2rem}
h1{font:600 2rem Georgia,serif;margin:0} h2{font:600 1.25rem Georgia,serif;margin:2.4rem 0 .7rem;color:var(--accent)}
.soft{color:var(--soft)} .cards{display:flex;flex-wrap:wrap;gap:.7rem;margin-top:1.2rem}
.card{background:var(--card);border:1px solid var(--line);border-radius:8px;padding:.6rem 1rem;min-width:7.5rem}
.card b{display:block;font-size:1.35rem;font-weight:600} table{border-collapse:collapse;width:100%;background:var(--card)}
td,th{padding:.35rem .6rem;border-bottom:1px solid var(--line);text-align:left;vertical-align:top}
th{font-weight:600;color:var(--soft);font-size:.85rem} .n{text-align:right;white-space:nowrap;font-variant-numeric:tabular-nums}
.plot svg{width:100%;height:auto;background:#fff;border:1px solid var(--line);border-radius:8px}
details{background:var(--card);border:1px solid var(--line);border-radius:8px;padding:.4rem .8rem;margin-bottom:.4rem}
summary{cursor:pointer} .missed{color:#a3271c;font-weight:600} .reached{color:#3c6e3a} dt{font-weight:600} dd{margin:0 0 .5rem 0}
"""


def card(value, meaning):
    return f'<div class="card"><b>{value}</b><span class="soft">{meaning}</span></div>'


def header(facts, results):
    reached = sum(v["reached"] for v in results)
    return (f'<h1>A crowd that keeps the frame steady</h1><div class="soft">{html.escape(facts["pack"])}</div><div class="cards">'
            + card(f"{reached} of {len(results)}", "targets reached") + card(facts["runs"], "runs")
            + card(f"{facts['simulated_s'] / 60:.0f} min", "simulated") + card(f"{facts['seconds']:.0f} s", "taken") + "</div>")


def targets_table(results):
    rows = ""
    for v in results:
        verdict = "reached" if v["reached"] else "missed"
        where = "" if v["reached"] else ": " + html.escape(", ".join(v["missed_in"]))
        rows += (f"<tr><td>{FIGURE[v['figure']].title}<td>{html.escape(v['scenario'].replace('*', 'any'))}<td>{named(v['modes'])}"
                 f'<td class="n">{"≤" if v["sense"] == "most" else "≥"} {shown(v["figure"], v["target"])}'
                 f'<td class="n">{shown(v["figure"], v["median"])}<td class="n">{shown(v["figure"], v["worst"])}'
                 f'<td class="soft">{html.escape(v["worst_in"])}<td><span class="{verdict}">{verdict}</span>'
                 f'<span class="soft">{where}</span></tr>')
    return ('<h2>Figures to reach</h2><p class="soft">Of each: the scenario and mode that meet it least, with the median over the '
            "seeds and the worst seed there. What must never happen is judged by every seed, the rest by the median.</p>"
            '<table><tr><th>Figure<th>Scenario<th>Mode<th class="n">Target<th class="n">Median<th class="n">Worst seed'
            f"<th>There<th>Verdict</tr>{rows}</table>")


def plot(title, text, svg):
    return f'<h2>{html.escape(title)}</h2><p class="soft">{html.escape(text)}</p><div class="plot">{svg}</div>'


def scenario_table(modes):
    rows = ""
    for figure in FIGURES:
        cells = ""
        for mode in MODES:
            value = modes.get(mode, {}).get(figure.key)
            cells += '<td class="n">' + (f'{shown(figure.key, value["median"])}<td class="n soft">{shown(figure.key, value["worst"])}'
                                         if value else '<td class="n">')
        if any(figure.key in values for values in modes.values()):
            rows += f"<tr><td>{figure.title}{cells}</tr>"
    heads = "".join(f'<th class="n">{mode}<th class="n">worst' for mode in MODES)
    return f"<table><tr><th>Median over the seeds{heads}</tr>{rows}</table>"


def scenario_details(name, modes, svg):
    return (f"<details><summary><b>{html.escape(name)}</b></summary>{scenario_table(modes)}"
            f'<p class="soft">People within the nominal r_high over time, and the limit; first seed.</p>'
            f'<div class="plot">{svg}</div></details>')


def meanings():
    items = "".join(f"<dt>{f.title}<dd>{html.escape(f.meaning)}; "
                    f"{'the least' if f.key in LEAST_IS_WORST else 'the greatest'} is the worst</dd>" for f in FIGURES)
    return f"<h2>How it is measured</h2><p>From metrics and trajectories alone, by code apart from the player's.</p><dl>{items}</dl>"


def paths_section(paths):
    """What scenarios.paths_facts says; None: nothing."""
    if not paths:
        return ""
    heads = "".join(f'<th class="n">{FIGURE[key].title}<br>{mode}' for mode, key in PATH_COLUMNS)
    rows = "".join(f"<tr><td>{html.escape(name)}" + "".join(f'<td class="n">{cell}' for cell in cells) + "</tr>"
                   for name, *cells in path_rows(paths["paths"]))
    means = "; ".join(f"{mode} {auc:.3f} ± {error:.3f}" for mode, (auc, error) in paths["told_apart"].items())
    tells = "".join(f"<p>What tells {mode} from off: " + ", ".join(f"{html.escape(name.replace('_', ' '))} {loss:.3f}" for name, loss in some)
                    + ' <span class="soft">(loss of AUC without it)</span></p>' for mode, some in paths["tells"].items())
    told = f"Not told apart: {html.escape(paths['missing'])}." if paths["missing"] else f"Told apart from off, AUC within 15 m: {means}."
    return (f'<h2>Drawn paths</h2><p class="soft">Paths drawn from seed {paths["seed"]}, each with two seeds of the crowd; means of both. '
            f'The last number of a name: people in the town.</p><p>{told}</p>{tells}<div style="overflow-x:auto"><table><tr><th>Path{heads}</tr>'
            f"{rows}</table></div>")


def page(facts, summary, results, figures, small_plots, paths=None):
    """`figures`: (title, text, svg) of the paper's figures; `small_plots`: svg by scenario; `paths`: of the drawn paths."""
    body = header(facts, results) + targets_table(results) + paths_section(paths) + "".join(plot(*figure) for figure in figures)
    body += "<h2>Every scenario</h2>" + "".join(scenario_details(name, modes, small_plots[name]) for name, modes in summary.items())
    return (f'<!doctype html>\n<html lang="en"><meta charset="utf-8"><title>Flaneur: figures of the crowd</title><style>{STYLE}'
            f"</style>\n{body}\n{meanings()}</html>\n")
