"""What code and pages name must be there: pages and their sections, linked files, functions of the method's table."""

import re
from pathlib import Path

import circles
import rust
import sizes

# Pages that only whoever wrote them has, and LaTeX's labels, which no reader of a printed paper sees.
_ELSEWHERE = re.compile(r"\b(?:METHOD|FORMATS)(?:\.md)? \d[\d.]*|\b(?:eq|alg|tab|sec|fig)(?:\. |:)[a-z]+_[a-z_]+")
_SECTION = re.compile(r"docs/([\w-]+)\.md\]?(?:\([^)]*\))?,? (?:section )?(\d+)\b")
_PAGE = re.compile(r"\bdocs/[\w-]+\.(?:md|png)\b")
_LINK = re.compile(r"\]\(([^)\s]+)\)")
_FUNCTION = re.compile(r"`([a-z_]\w*(?:::\w+)+)(?:\(\))?`")
_FUNCTIONS_PAGE = "docs/method.md"


def problems(root):
    """A sentence for each reference that leads nowhere."""
    root = Path(root)
    for file in sizes.code_files(root):
        if not file.is_relative_to(root / "scripts" / "house"):
            yield from _references(root, file)
    for file in _pages(root):
        yield from _links(root, file)
        yield from _references(root, file)
    yield from _functions(root)


def _pages(root):
    crates = (page for folder, _ in circles.crates(root) for page in folder.glob("*.md"))
    return sorted([*root.glob("*.md"), *root.glob("docs/*.md"), *root.glob(".github/**/*.md"), *crates])


def _references(root, file):
    text = file.read_text(encoding="utf-8")

    def place(found):
        return f"{file.relative_to(root)}:{rust.line_of(text, found.start())}"

    for found in _ELSEWHERE.finditer(text):
        yield f"{place(found)}: `{found.group()}` names something that isn't in the project"
    for found in _PAGE.finditer(text):
        if not (root / found.group()).is_file():
            yield f"{place(found)}: there is no page {found.group()}"
    for found in _SECTION.finditer(text):
        page, section = root / "docs" / f"{found.group(1)}.md", found.group(2)
        if page.is_file() and section not in _sections(page):
            yield f"{place(found)}: {page.relative_to(root)} has no section {section}"


def _sections(page):
    """The numbers of a page's headings; none of a page whose headings have none."""
    return set(re.findall(r"^#+ (\d+)\b", page.read_text(encoding="utf-8"), re.M))


def _links(root, file):
    text = file.read_text(encoding="utf-8")
    for found in _LINK.finditer(text):
        target, _, anchor = found.group(1).partition("#")
        if re.match(r"[a-z]+:", target):
            continue
        page = (file.parent / target) if target else file
        place = f"{file.relative_to(root)}:{rust.line_of(text, found.start())}"
        if not page.exists():
            yield f"{place}: there is no {target}"
        elif anchor and page.suffix == ".md" and anchor not in _anchors(page):
            yield f"{place}: {page.name} has no heading #{anchor}"


def _anchors(page):
    """The anchors that a page's headings get."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-") for heading in headings}


def _functions(root):
    """Each function that a row of a table of the method's page names is where the row says."""
    page = root / _FUNCTIONS_PAGE
    if not page.is_file():
        return
    trees = {tree.name[0]: tree for tree in circles.trees(root)}
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        for path in _FUNCTION.findall(line) if line.startswith("|") else []:
            crate, *rest = path.split("::")
            if crate in trees and not _is_defined(trees[crate], rest):
                yield f"{_FUNCTIONS_PAGE}:{number}: there is no `{path}`"


def _is_defined(module, path):
    """Whether a path of modules ends at a function, or at a function of a type, that is defined there."""
    while path and path[0] in module.children:
        module, path = module.children[path[0]], path[1:]
    return 0 < len(path) <= 2 and all(name in module.definitions for name in path)
