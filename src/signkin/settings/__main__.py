"""`python -m signkin.settings FOLDER`: write config.yaml, its schema and its page anew."""

import sys
from pathlib import Path

from signkin.settings.corpus_text import corpus_page_text
from signkin.settings.text import config_text, corpus_schema_text, page_text, schema_text


def generated(root: Path) -> dict[Path, str]:
    """Return the generated files of a checkout and their content."""
    schemas = root / "src" / "signkin" / "schemas"
    return {
        root / "config.yaml": config_text(),
        root / "docs" / "configuration.md": page_text(),
        root / "docs" / "corpus-reference.md": corpus_page_text(),
        schemas / "config.schema.yaml": schema_text(),
        schemas / "corpus.schema.yaml": corpus_schema_text(),
    }


if __name__ == "__main__":
    for path, text in generated(Path(sys.argv[1] if len(sys.argv) > 1 else ".")).items():
        path.write_text(text, encoding="utf-8")
