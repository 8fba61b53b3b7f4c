"""YAML that people write: one sentence for what cannot be read."""

import pytest

from signkin import SignkinError
from signkin.yaml_file import read_yaml


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"a: 1\nb: 2\na: 3\n", "line 3: the key 'a' stands in line 1 already"),
        (b"a: caf\xe9\n", "line 1: the byte 0xe9 is not UTF-8"),
        (b"", "no keys"),
        (b"- 1\n", "no keys"),
        (b"a: [1\n", "expected YAML"),
        (b'a: "open\n', "expected YAML"),
        (b"a: " + b"[" * 20_000, "more than 50 levels"),
        (b"a: &x 1\nb: *x\n", "line 2: an alias (*x)"),
        (b"a: 2024-13-45\n", "a value that is none"),
        (b"a: !!python/object:os.system x\n", "expected YAML"),
    ],
)
def test_faults(tmp_path, content, told):
    path = tmp_path / "x.yaml"
    path.write_bytes(content)
    with pytest.raises(SignkinError) as caught:
        read_yaml(path)
    assert told in str(caught.value)
    assert str(path) in str(caught.value)


def test_a_mapping_is_read(tmp_path):
    path = tmp_path / "x.yaml"
    path.write_bytes("\ufeffa: {b: [1, né]}\n".encode())
    assert read_yaml(path) == {"a": {"b": [1, "né"]}}
    with pytest.raises(SignkinError, match="there is no such file"):
        read_yaml(tmp_path / "none.yaml")
