"""All kinds of tables, by name."""

from __future__ import annotations

from signkin.tables import audit, corpora, endres2013, naert2017, owner, segments
from signkin.tables.schema import Table

SUBJECTS: dict[str, tuple[Table, ...]] = {
    "Corpora": corpora.TABLES,
    "Naert et al. 2017": naert2017.TABLES,
    "Segmentations compared": segments.TABLES,
    "Endres et al. 2013": endres2013.TABLES,
    "Audit": audit.TABLES,
    "Report": owner.TABLES,
}
TABLES = {table.name: table for of_subject in SUBJECTS.values() for table in of_subject}
