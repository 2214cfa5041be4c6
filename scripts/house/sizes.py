"""Files, functions and lines stay small enough to be read; those of tests apart."""

from pathlib import Path

import rust

FILE_LINES = 300
FUNCTION_LINES = 40
COLUMNS = 120

# Written by people, in languages that are checked by reading.
_CODE = {".rs", ".ts", ".mjs", ".js", ".css", ".html", ".py"}
_SKIPPED = {"target", "node_modules", ".git", "dist", "__pycache__"}


def code_files(root, endings=frozenset(_CODE)):
    """Every file of code in the project."""
    for folder in (Path(root) / name for name in ("crates", "fuzz", "scripts", "testdata")):
        for file in sorted(folder.rglob("*")):
            if file.suffix in endings and file.is_file() and not _SKIPPED & set(file.parts):
                yield file


def is_test(file):
    """Whether a file is part of the tests alone."""
    folders = {"tests", "testdata"} & set(file.parts)
    return bool(folders) or file.stem in {"tests", "testing"} or file.name.startswith("test_")


def problems(root):
    """A sentence for each file, function and line that is too long."""
    for file in code_files(root):
        if not is_test(file):
            text, name = file.read_text(encoding="utf-8"), file.relative_to(root)
            yield from _too_wide(name, file.suffix, text)
            yield from _too_much(name, file.suffix, text)


def _too_wide(name, ending, text):
    """Lines beyond the last column; those of tests in Rust files are left out."""
    code = rust.code(text) if ending == ".rs" else text
    kept = rust.without_tests(code) if ending == ".rs" else text
    lines = zip(text.split("\n"), code.split("\n"), kept.split("\n"))
    for number, (line, with_tests, without) in enumerate(lines, 1):
        if len(line) > COLUMNS and not (with_tests.strip() and not without.strip()):
            yield f"{name}:{number}: {len(line)} columns, at most {COLUMNS}"


def _too_much(name, ending, text):
    """Lines of a file, and of each of its functions; comments, blank lines and tests in Rust files don't count."""
    if ending == ".rs":
        text = rust.without_tests(rust.code(text))
        for function, line, lines in rust.functions(text):
            if lines > FUNCTION_LINES:
                yield f"{name}:{line}: `{function}` has {lines} lines, at most {FUNCTION_LINES}"
    lines = rust.lines_of_code(text)
    if lines > FILE_LINES:
        yield f"{name}: {lines} lines, at most {FILE_LINES}"
