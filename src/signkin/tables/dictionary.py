"""The data dictionary, from the tables' own descriptions."""

from __future__ import annotations

from signkin.tables.kinds import SUBJECTS


def dictionary() -> str:
    """Return the data dictionary as Markdown."""
    lines = [
        "# Data dictionary",
        "",
        "Made from `src/signkin/tables/` by `python -m signkin.tables`; edit it there.",
        "A `{u}` in a name is the corpus's unit of length, `m` or `px`. An empty cell is a value",
        "that does not exist; where it needs saying, the column `note` says why.",
    ]
    for subject, of_subject in SUBJECTS.items():
        lines += ["", f"## {subject}"]
        for table in of_subject:
            lines += ["", f"### {table.name}", "", f"`{table.path}`: one row is {table.row}.", ""]
            lines += ["| column | unit | meaning |", "|---|---|---|"]
            lines += [f"| `{c.name}` | {c.unit} | {c.meaning} |" for c in table.columns]
    return "\n".join(lines) + "\n"
