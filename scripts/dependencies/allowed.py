"""What deny.toml says of one package."""

from boolean.boolean import ParseError
from license_expression import ExpressionError, get_spdx_licensing

_SPDX = get_spdx_licensing()


def problems(packages, rules):
    """One sentence for each thing that the rules don't allow."""
    licences = set(rules["licenses"]["allow"])
    denied = {entry["name"]: entry["reason"] for entry in rules["bans"]["deny"]}
    for package in packages:
        place = f"{package['name']} {package['version']}"
        if package["name"] in denied:
            yield f"{place}: is denied, for {denied[package['name']]}"
        if not licensed(package["license"], licences):
            yield f"{place}: its licence is {package['license']}; one that deny.toml allows is expected"
        yield from (f"{place}: {problem}" for problem in sources(package))


def sources(package):
    """Where a package comes from and what it takes; one of the workspace has no source, one of a folder has a path."""
    source = package["source"]
    if source and not source.startswith("registry+"):
        yield f"comes from {source}; a registry is expected"
    for each in package["dependencies"]:
        if each["registry"]:
            yield f"takes {each['name']} from {each['registry']}; Cargo's own registry is expected"
        if source is None and each["req"] == "*" and "path" not in each:
            yield f"takes any version of {each['name']}; a version is expected"


def licensed(text, licences):
    """Whether `licences` are enough for what an SPDX expression asks; a slash is how old packages write OR."""
    if text is None:
        return False
    try:
        return _enough(_SPDX.parse(text.replace("/", " OR "), validate=True), licences)
    except (ExpressionError, ParseError):
        return False


def _enough(expression, licences):
    if isinstance(expression, _SPDX.OR):
        return any(_enough(each, licences) for each in expression.args)
    if isinstance(expression, _SPDX.AND):
        return all(_enough(each, licences) for each in expression.args)
    return str(expression) in licences
