"""The audit: can a printed number be right, and does it hold on other data?

Numbers are strings as printed. This package knows tables only, no recordings and no stage.
"""

from signkin.audit.grim import grim
from signkin.audit.grimmer import grimmer
from signkin.audit.kruskal import kruskal_limit
from signkin.audit.pvalues import p_agrees, p_from, statistic_from
from signkin.audit.rounding import allowed
from signkin.audit.samples import samples
from signkin.audit.significance import power_of, smallest_effect
from signkin.audit.summaries import (
    anova_from_summary,
    chains,
    t_from_summary,
    welch_from_summary,
)

__all__ = [
    "allowed",
    "anova_from_summary",
    "chains",
    "grim",
    "grimmer",
    "kruskal_limit",
    "p_agrees",
    "p_from",
    "power_of",
    "samples",
    "smallest_effect",
    "statistic_from",
    "t_from_summary",
    "welch_from_summary",
]
