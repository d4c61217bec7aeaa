"""What each figure is, and what must be reached: data only."""
import collections

# key, title, how a value is printed, how it is measured
Figure = collections.namedtuple("Figure", "key title format meaning")
# A figure's limit: at most (or at least) `value` in the scenarios whose name matches and in these modes; over the seeds the
# median counts, or every seed (`by`: median, worst).
Target = collections.namedtuple("Target", "key scenario modes sense value by")

MODES = ("off", "paper", "full")
DRAWN = "drawn paths"  # the group of the paths that are drawn from a seed
FREE_SECONDS = {"dead-end": 3}  # not counted when frames are exceeded: the visitor starts among people

FIGURES = [
    Figure("over_budget", "frames over budget", "{:.0f}", "frames whose people have more triangles than the budget in force"),
    Figure("exceeded", "frames exceeded", "{:.2%}",
           "share of frames with more than the limit of visible people within the nominal r_high, counted from the positions; in "
           "dead-end after the first 3 s"),
    Figure("exceeded_of_off", "exceeded over off's", "{:.2f}", "share of frames exceeded over that of the same seed with off"),
    Figure("exceeded_light", "exceeded, where off exceeds less", "{:.2%}",
           "frames exceeded on the paths where off exceeds in at most half of the frames"),
    Figure("over", "people over the limit", "{:.2f}", "visible people within the nominal r_high beyond the limit, mean over the frames"),
    Figure("over_of_off", "people over, of off's", "{:.2f}", "the same over that of off, on the paths where off exceeds in more than half of "
           "the frames"),
    Figure("over_at_start", "people over in the first frame", "{:.0f}", "the same in the run's first frame"),
    Figure("filled", "people within r_high, of the limit", "{:.2f}",
           "visible people within the nominal r_high, counted up to the limit, over the limit: mean of the frames in which off has at "
           "least the limit"),
    Figure("ring", "densest ring over off's", "{:.2f}",
           "density of people in the densest ring of 1 m about a visitor who stands, from 2 m on, over off's at the same distance; both seeds "
           "together"),
    Figure("told_apart", "told apart (AUC)", "{:.3f}",
           "how well a classifier tells how people within 15 m walk from how they do with off and another seed, on paths that it has not "
           "learnt from: 0.5 never, 1 always; for off itself what chance alone makes"),
    Figure("jumps", "jumps in view", "{:.0f}", "visible people who moved farther in a step than top speed × step"),
    Figure("overlaps", "overlaps", "{:.0f}",
           "pairs of visible people that overlap by more than 5 cm where at most 1 person/m² is within 2 m of the pair"),
    Figure("overlaps_dense", "overlaps, any density", "{:.0f}", "the same without regard to density"),
    Figure("born", "births in view", "{:.0f}", "visible people whose first row is farther than 2.5 m from every door and exit"),
    Figure("vanished", "vanished in view", "{:.0f}",
           "visible people whose last row is farther than 2.5 m from every door and exit, and 1 m from their last goal"),
    Figure("unforeseen", "visible without boundary", "{:.0f}", "people who became visible without a step in the boundary"),
    Figure("wrong_view", "wrong view class", "{:.0f}", "rows whose view (visible, boundary, outside) contradicts the wedges of the camera and of the outer volume"),
    Figure("too_near", "personal space entered", "{:.0f}", "frames with somebody's centre within r_personal of the camera"),
    Figure("bunching", "bunching", "{:.2f}",
           "highest local density (kernel exp(−d²/R²)/(πR²), R = 1 m) from 0.5 m inside to 1.5 m outside the outline of the camera "
           "obstacles (circles through the camera that reach to r_high along the view's axis and both edges), over that of "
           "the same seed with off"),
    Figure("bunching_usual", "bunching, 99 of 100 frames", "{:.2f}", "the same with the 99th percentile of frames for the highest"),
    Figure("speeds_ks", "speeds, distance", "{:.3f}",
           "two-sample Kolmogorov–Smirnov distance of visible people's speeds to the same seed with off; for off itself: to the "
           "next seed with off, which is what chance alone makes"),
    Figure("turns_ks", "turn rates, distance", "{:.3f}", "likewise of the amount of their turn rates"),
    Figure("speeds_ks_together", "speeds, all seeds together", "{:.3f}", "the distance of all seeds' speeds to all seeds' with off"),
    Figure("turns_ks_together", "turn rates, all seeds together", "{:.3f}", "likewise of their turn rates"),
    Figure("switches", "level switches", "{:.2f}", "changes of level seen per visible person and minute, with those that still fade when somebody comes into view"),
    Figure("shortfalls", "shortfalls", "{:.2f}", "people drawn as impostors nearer than adequate, mean a frame"),
    Figure("speed_ratio", "user's speed", "{:.2f}", "the visitor's way made over the way asked for"),
    Figure("direction_deg", "user's direction error", "{:.2f}°",
           "greatest angle between the visitor's steps and the way asked for; coordinates in the tables are rounded to 0.1 mm, "
           "which makes up to 0.3°"),
    Figure("control_share", "cost of control", "{:.2%}",
           "control_ms over step_ms, sums over the run: choice of levels (needed in any mode) and the crowd's adaptation"),
    Figure("adaptation_share", "cost of adaptation alone", "{:.2%}",
           "control_ms beyond that of the same seed with off, means a frame, over step_ms"),
]

TARGETS = [
    Target("over_budget", "*", MODES, "most", 0, "worst"),
    Target("exceeded", "walkabout-equal", ("full",), "most", 0, "median"),
    Target("exceeded", "walkabout-fast", ("full",), "most", 0.01, "median"),
    Target("exceeded_of_off", "walkabout-fast", ("full",), "most", 0.1, "median"),
    Target("exceeded", "dead-end", ("full",), "most", 0.02, "median"),
    Target("jumps", "*", MODES, "most", 0, "worst"),
    Target("overlaps", "*", MODES, "most", 0, "worst"),
    Target("born", "*", MODES, "most", 0, "worst"),
    Target("vanished", "*", MODES, "most", 0, "worst"),
    Target("unforeseen", "*", MODES, "most", 0, "worst"),
    Target("wrong_view", "*", MODES, "most", 0, "worst"),
    Target("bunching", "*", ("full",), "most", 1.3, "median"),
    Target("speeds_ks", "*", ("full",), "most", 0.1, "median"),
    Target("turns_ks", "*", ("full",), "most", 0.1, "median"),
    Target("switches", "*", ("full",), "most", 5, "median"),
    Target("switches", DRAWN, ("full",), "most", 2, "median"),
    Target("told_apart", DRAWN, ("full",), "most", 0.58, "median"),
    Target("told_apart", DRAWN, ("full",), "most", 0.70, "worst"),
    Target("exceeded_light", DRAWN, ("full",), "most", 0, "median"),
    Target("exceeded_light", DRAWN, ("full",), "most", 0.03, "worst"),
    Target("over_of_off", DRAWN, ("full",), "most", 0.5, "median"),
    Target("over_at_start", DRAWN, ("full",), "most", 0, "worst"),
    Target("ring", DRAWN, ("full",), "most", 1.25, "median"),
    Target("filled", DRAWN, ("full",), "least", 0.85, "median"),
    Target("adaptation_share", "ten-thousand", ("full",), "most", 0.02, "median"),
    Target("speed_ratio", "walkabout-*", ("full",), "least", 0.9, "median"),
    Target("direction_deg", "walkabout-*", MODES, "most", 0.5, "worst"),
]
