"""The picture of who imports whom is the code's, and says nothing that a contract rules out."""

from tools import flow
from tools.marked import content


def test_no_arrow_is_ruled_out_by_a_contract_and_the_picture_is_current(root):
    there = flow.arrows()
    assert not there & flow.forbidden(root / "pyproject.toml")
    drawn = content((root / "docs" / "architecture.md").read_text(), flow.PLACE)
    assert drawn.strip() == flow.picture(there), "run `python -m tools.flow`"


def test_every_contract_that_says_something_is_read(root):
    pairs = flow.forbidden(root / "pyproject.toml")
    assert ("pages", "studies.naert2017") in pairs
    assert ("studies.naert2017", "studies.endres2013") in pairs
    assert ("studies.endres2013", "studies.one_wrist") not in pairs


def test_a_longer_way_stands_for_an_arrow():
    assert flow.reduced({("a", "b"), ("b", "c"), ("a", "c")}) == [("a", "b"), ("b", "c")]
