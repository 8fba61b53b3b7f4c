"""Print the data dictionary: `python -m signkin.tables > docs/data-dictionary.md`."""

from signkin.tables.dictionary import dictionary

print(dictionary(), end="")
