"""Rust source as far as these checks need it: code without comments and strings, without tests, and what it defines."""

import re

# Comments, strings and character literals; a lifetime is none of them.
_NO_CODE = re.compile(
    r'//[^\n]*|/\*.*?\*/|b?r(#*)".*?"\1|b?"(?:\\.|[^"\\])*"|b?\'(?:\\(?:x..|u\{[^}]*\}|.)|[^\'\\])\'', re.S
)
_TEST_ONLY = re.compile(r"#\[cfg\(test\)\]\s*")
_ATTRIBUTE = re.compile(r"#!?\[[^\]]*\]")
_FUNCTION = re.compile(r"\bfn\s+(\w+)")
_DEFINITION = re.compile(r"\b(?:fn|struct|enum|trait|union|type|const|static|mod|macro_rules!)\s+(\w+)")


def code(text):
    """The text with everything blanked that is no code; every line and column stays where it was."""
    return _NO_CODE.sub(lambda found: _blank(found.group()), text)


def without_tests(code_text):
    """Code with all items blanked that only tests have."""
    for found in reversed(list(_TEST_ONLY.finditer(code_text))):
        end = item_end(code_text, found.end())
        code_text = code_text[: found.start()] + _blank(code_text[found.start() : end]) + code_text[end:]
    return code_text


def item_end(code_text, start):
    """Where the item, field or statement ends that begins at `start`."""
    depth = 0
    for at in range(start, len(code_text)):
        letter = code_text[at]
        if letter in "([{":
            depth += 1
        elif letter in ")]}":
            depth -= 1
            if depth < 0:
                return at
            if depth == 0 and letter == "}":
                return at + 1
        elif letter in ";," and depth == 0:
            return at + 1
    return len(code_text)


def definitions(code_text):
    """Names that the code defines, wherever in it."""
    return set(_DEFINITION.findall(code_text))


def functions(code_text):
    """Name, first line and number of lines with code of each function, signature and braces included."""
    for found in _FUNCTION.finditer(code_text):
        text = code_text[found.start() : item_end(code_text, found.end())]
        if text.endswith("}"):
            yield found.group(1), line_of(code_text, found.start()), lines_of_code(text)


def lines_of_code(code_text):
    """How many lines aren't blank."""
    return sum(1 for line in code_text.splitlines() if line.strip())


def line_of(text, at):
    """The number of the line of a place, from 1."""
    return text.count("\n", 0, at) + 1


def imports(code_text):
    """Each path that a `use` names: (place, whether it is re-exported, path as a list, name it gets)."""
    found = re.finditer(r"(\bpub(?:\([^)]*\))?\s+)?\buse\s+([^;{}]*(?:\{[^;]*\})?[^;{}]*);", code_text)
    for use in found:
        for path, name in _paths(use.group(2)):
            yield use.start(2), bool(use.group(1)), path, name


def without_imports(code_text):
    """Code with attributes and every `use` blanked."""
    bare = _ATTRIBUTE.sub(lambda found: _blank(found.group()), code_text)
    return re.sub(r"\buse\s+[^;]*;", lambda found: _blank(found.group()), bare)


def _paths(tree):
    """The paths of one `use`, braces taken apart."""
    tree = tree.strip()
    if "{" in tree:
        head, inside = tree.split("{", 1)
        prefix = [part.strip() for part in head.split("::") if part.strip()]
        for part in _split(inside[: inside.rindex("}")]):
            for path, name in _paths(part):
                # `a::{self}` is `a`.
                path = prefix if path == ["self"] else prefix + path
                yield path, path[-1] if name == "self" else name
    elif tree:
        path, _, name = tree.partition(" as ")
        path = [part.strip() for part in path.split("::") if part.strip()]
        yield path, name.strip() or path[-1]


def _split(inside):
    """The parts between commas that stand in no further braces."""
    depth, part, parts = 0, "", []
    for letter in inside:
        depth += (letter == "{") - (letter == "}")
        if letter == "," and depth == 0:
            parts.append(part)
            part = ""
        else:
            part += letter
    return [part for part in parts + [part] if part.strip()]


def _blank(text):
    return re.sub(r"[^\n]", " ", text)
