"""Circles between modules that stand side by side, and between crates."""

import tomllib
from pathlib import Path

import modules


def crates(root):
    """Every crate of the workspace: its folder and its manifest."""
    for manifest in sorted(Path(root).glob("crates/*/Cargo.toml")):
        yield manifest.parent, tomllib.loads(manifest.read_text(encoding="utf-8"))


def trees(root):
    """The module tree of each library and program of the workspace."""
    for folder, manifest in crates(root):
        for name in ("lib.rs", "main.rs"):
            file = folder / "src" / name
            if file.is_file():
                library = manifest.get("lib", {}).get("name", manifest["package"]["name"])
                yield modules.load(file, library.replace("-", "_"))


def problems(root, parents=False):
    """A sentence for each circle, with the arrows that make it.

    What a parent's own file defines belongs to all its children, as it does for the compiler: a child may use it. With
    `parents` such a file counts as one of the children, so that two that use each other are a circle, too.
    """
    for tree in trees(root):
        arrows = sorted({arrow for module in tree.all() for arrow in modules.arrows(module)}, key=str)
        for module in tree.all():
            yield from _among_children(root, module, arrows, parents)
    yield from _among_crates(root)


def _among_children(root, module, arrows, parents):
    """Circles among the children of a module, each with all below it."""
    depth = len(module.name)
    graph = {}
    for arrow in arrows:
        if arrow.source[:depth] != module.name or arrow.target[:depth] != module.name:
            continue
        source, target = _node(arrow.source, depth), _node(arrow.target, depth)
        own = depth in (len(arrow.source), len(arrow.target))
        if source != target and (parents or not own):
            graph.setdefault(source, {}).setdefault(target, []).append(arrow)
    for circle in circles_of(graph):
        lines = []
        for source, target in zip(circle, circle[1:] + circle[:1]):
            arrow = graph[source][target][0]
            place = Path(arrow.place).relative_to(root)
            lines.append(f"    {'::'.join(arrow.source)} -> {'::'.join(arrow.target)}   ({place})")
        yield f"circle in {'::'.join(module.name)}: {' -> '.join(circle + circle[:1])}\n" + "\n".join(lines)


def _node(name, depth):
    """The child in whose subtree a module lies; the file of the parent stands for itself."""
    return name[depth] if len(name) > depth else f"{name[-1]} itself"


def _among_crates(root):
    """What the manifests say; dependencies of tests are no part of the program."""
    names = {manifest["package"]["name"] for _, manifest in crates(root)}
    graph = {}
    for _, manifest in crates(root):
        needs = {**manifest.get("dependencies", {}), **manifest.get("build-dependencies", {})}
        graph[manifest["package"]["name"]] = {name: [] for name in needs if name in names}
    for circle in circles_of(graph):
        yield f"circle of crates: {' -> '.join(circle + circle[:1])}"


def circles_of(graph):
    """A shortest circle through each node that lies on one and on no circle that was found before."""
    found, covered = [], set()
    for start in sorted(graph):
        circle = None if start in covered else _shortest(graph, start)
        if circle:
            found.append(circle)
            covered.update(circle)
    return found


def _shortest(graph, start):
    """The shortest way from a node back to itself."""
    paths = [[start]]
    seen = set()
    while paths:
        path = paths.pop(0)
        for target in sorted(graph.get(path[-1], {})):
            if target == start:
                return path
            if target not in seen:
                seen.add(target)
                paths.append(path + [target])
    return None
