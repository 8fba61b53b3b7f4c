"""ELAN files as signkin writes them, against the schema itself, where a folder with it is named.

`SIGNKIN_EAF_SCHEMA=folder pytest tests/oracle/test_eaf_schema.py`, the folder with EAFv2.8.xsd and
EAFv3.0.xsd (The Language Archive, and the source package of pympi-ling); wants lxml.
"""

import os
from pathlib import Path

import pytest

from signkin import Interval
from signkin.io.eaf_write import NewTier, elan_copy, insert_tiers, new_eaf
from support.elan_rules import broken

NEW = [
    NewTier("signkin refined right", (Interval(0.1, 0.2, 'Ä<&"', ""), Interval(0.3, 0.4, "", "")))
]


@pytest.fixture(scope="module")
def schemas():
    etree = pytest.importorskip("lxml.etree", reason="lxml is not there")
    folder = os.environ.get("SIGNKIN_EAF_SCHEMA")
    if not folder:
        pytest.skip("the schema of EAF: SIGNKIN_EAF_SCHEMA names no folder")
    files = sorted(Path(folder).glob("EAFv*.xsd"))
    assert files, f"no EAFv*.xsd in {folder}"
    return [etree.XMLSchema(etree.parse(str(file))) for file in files]


def valid(schemas, content):
    from lxml import etree

    return [schema.validate(etree.fromstring(content)) for schema in schemas]


def test_new_files_and_copies_are_valid(schemas, tmp_path):
    made = new_eaf(
        author="a", date="2020-01-01T00:00:00Z", media_url="v ö.mp4",
        tiers=[("G", None, [Interval(0, 1, "A", "")]), ("P", "G", [Interval(0.1, 0.2, "x", "")])],
    )  # fmt: skip
    tags = [Interval(0, 1, "A", "t"), Interval(0.5, 2, "B", "t")]
    about = {"clock_offset_s": 0.0, "media_url": "m.bvh"}
    fresh = elan_copy(tmp_path / "x", NEW, elan=False, tags=tags, **about)
    for content in (made, insert_tiers(made, NEW), fresh, insert_tiers(fresh, NEW)):
        assert all(valid(schemas, content)) and not broken(content)


def test_copies_of_valid_files_are_valid(schemas):
    cases = Path(os.environ.get("SIGNKIN_CASES", "/work/shared/cases")) / "annotation"
    if not cases.is_dir():
        pytest.skip(f"no folder of cases ({cases})")
    done = 0
    for path in sorted(cases.glob("*/*.eaf")):
        content = path.read_bytes()
        if path.name != "out.eaf" and content.startswith(b"<?xml"):
            before = valid(schemas, content)
            assert valid(schemas, insert_tiers(content, NEW)) >= before, path
            done += any(before)
    assert done > 10
