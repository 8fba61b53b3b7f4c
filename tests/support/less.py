"""Settings of runs that show that everything is made, with fewer draws than the shipped ones."""

from support.runs import QUICK, merged

LESS = {
    "refinement": {"draws": 100},
    "durations": {"draws": 200},
    "open_choices": merged(
        QUICK["open_choices"],
        {"naert2017": {"draws": 100, "cutoff_hz": [6.0], "search_window_s": [0.1]}},
    ),
}
