"""What the code looks like: no file and no function that is too long to read."""

import ast

MOST_LINES = 500
MOST_LINES_OF_A_FUNCTION = 80


def test_files_and_functions_are_short(root):
    long = []
    for path in sorted((root / "src").rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        lines = len(text.splitlines())
        if lines > MOST_LINES:
            long.append(f"{path.name}: {lines} lines")
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                span = node.end_lineno - node.lineno + 1
                if span > MOST_LINES_OF_A_FUNCTION:
                    long.append(f"{path.name}, {node.name}: {span} lines")
    assert not long


def test_scripts_of_the_workflow_have_no_logic(root):
    """A script reads, calls the library and writes: it defines nothing and decides nothing."""
    scripts = sorted((root / "workflow" / "scripts").rglob("*.py"))
    assert scripts
    for path in scripts:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            wrong = ast.FunctionDef | ast.ClassDef | ast.Lambda | ast.Try | ast.While
            assert not isinstance(node, wrong), f"{path}: {type(node).__name__}"
