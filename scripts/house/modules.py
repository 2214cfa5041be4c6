"""The modules of a crate, and which of them looks into which other."""

import re
from dataclasses import dataclass, field
from pathlib import Path

import rust

_PATH = re.compile(r"(?<![\w:])((?:[a-z_]\w*|Self)(?:\s*::\s*\w+)+)")


@dataclass
class Module:
    """One file of a crate."""

    name: tuple
    file: Path
    code: str
    parent: "Module | None" = None
    children: dict = field(default_factory=dict)
    imports: list = field(default_factory=list)
    definitions: set = field(default_factory=set)

    def all(self):
        """This module and all below it."""
        yield self
        for child in self.children.values():
            yield from child.all()

    def root(self):
        """The crate's root."""
        return self if self.parent is None else self.parent.root()


@dataclass(frozen=True)
class Arrow:
    """Code of one module that names something of another."""

    source: tuple
    target: tuple
    place: str


def load(root_file, crate):
    """The modules of a crate, from its `lib.rs` or `main.rs`; those of tests left out."""
    return _load(Path(root_file), (crate,), None, Path(root_file).parent)


def _load(file, name, parent, folder):
    code = rust.without_tests(rust.code(file.read_text(encoding="utf-8")))
    module = Module(name, file, code, parent)
    module.imports = list(rust.imports(code))
    module.definitions = rust.definitions(code)
    for child in re.findall(r"\bmod\s+(\w+)\s*;", code):
        for candidate in (folder / f"{child}.rs", folder / child / "mod.rs"):
            if candidate.is_file():
                module.children[child] = _load(candidate, name + (child,), module, folder / child)
    return module


def arrows(module):
    """Everything that this file names of other files of its crate."""
    for at, passed_on, path, name in module.imports:
        target = _look_up(module, path)
        if target is None or (target.children and _module_at(module, path) is target):
            continue
        # A parent that re-exports what its children define only passes it on, unless it uses it, too.
        if passed_on and _is_below(target, module) and not _mentions(module, name):
            continue
        yield _arrow(module, target, at)
    body = rust.without_imports(module.code)
    for found in _PATH.finditer(body):
        target = _look_up(module, [part.strip() for part in found.group(1).split("::")])
        if target is not None:
            yield _arrow(module, target, found.start())


def _arrow(module, target, at):
    return Arrow(module.name, target.name, f"{module.file}:{rust.line_of(module.code, at)}")


def _mentions(module, name):
    return re.search(rf"\b{re.escape(name)}\b", rust.without_imports(module.code)) is not None


def _is_below(module, ancestor):
    return module.name[: len(ancestor.name)] == ancestor.name and module is not ancestor


def _look_up(module, path, seen=()):
    """The module in which the thing at a path is defined; None where that is no module of this crate."""
    start, rest = _start(module, path, seen)
    return None if start is None else _defined_in(start, rest, seen)


def _start(module, path, seen):
    """The module at which a path begins, and what is left of the path."""
    first, rest = path[0], path[1:]
    if first == "crate":
        return module.root(), rest
    if first == "self":
        return module, rest
    if first == "super":
        while rest[:1] == ["super"] and module is not None:
            module, rest = module.parent, rest[1:]
        return (module.parent if module else None), rest
    if first in module.children:
        return module.children[first], rest
    for _, _, imported, name in module.imports:
        if name == first and imported != path and (module.name, first) not in seen:
            found = _module_at(module, imported, seen + ((module.name, first),))
            return found, rest
    return None, rest


def _module_at(module, path, seen=()):
    """The module that a path names; None where it names something else."""
    start, rest = _start(module, path, seen)
    while start is not None and rest:
        start, rest = start.children.get(rest[0]), rest[1:]
    return start


def _defined_in(module, path, seen):
    """Follows a path from a module on, through what is re-exported on the way."""
    if not path or path[0] == "*":
        return module
    first, rest = path[0], path[1:]
    if first in module.children:
        return _defined_in(module.children[first], rest, seen)
    if first in module.definitions or (module.name, first) in seen:
        return module
    seen = seen + ((module.name, first),)
    for _, _, imported, name in module.imports:
        if name == first:
            return _look_up(module, imported + rest, seen)
        if name == "*":
            found = _look_up(module, imported[:-1] + path, seen)
            if found is not None and first in found.definitions:
                return found
    return module
