"""The stubs say what the compiled module has: names, arguments and defaults."""

import ast
import inspect
from pathlib import Path

import ralf
from ralf import _ralf

STUBS = ast.parse((Path(ralf.__file__).parent / "_ralf.pyi").read_text())


def told(arguments: ast.arguments):
    names = [argument.arg for argument in [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs]]
    defaults = [ast.literal_eval(default) for default in arguments.defaults]
    return names, defaults


def found(function):
    parameters = inspect.signature(function).parameters.values()
    names = [parameter.name for parameter in parameters]
    return names, [p.default for p in parameters if p.default is not inspect.Parameter.empty]


def public(names):
    return {name for name in names if not name.startswith("_")}


def test_every_name_is_in_both():
    stubs = {node.name for node in STUBS.body if isinstance(node, ast.ClassDef | ast.FunctionDef)}
    assert stubs == public(vars(_ralf))


def test_functions_take_what_the_stubs_tell():
    functions = [node for node in STUBS.body if isinstance(node, ast.FunctionDef)]
    assert functions
    for node in functions:
        assert told(node.args) == found(getattr(_ralf, node.name)), node.name


def test_classes_have_what_the_stubs_tell():
    for node in STUBS.body:
        if not isinstance(node, ast.ClassDef) or node.name == "RalfError":
            continue
        compiled = getattr(_ralf, node.name)
        methods = {item.name: item for item in node.body if isinstance(item, ast.FunctionDef)}
        assert public(methods) == public(vars(compiled)), node.name
        for name, item in methods.items():
            attribute = inspect.getattr_static(compiled, name)
            is_property = any(ast.unparse(mark) == "property" for mark in item.decorator_list)
            assert is_property == inspect.isgetsetdescriptor(attribute), f"{node.name}.{name}"
            if not is_property and name not in {"__len__", "__new__"}:
                names, defaults = told(item.args)
                assert (names, defaults) == found(attribute), f"{node.name}.{name}"


def test_everything_in_all_is_there_and_has_a_sentence():
    for name in ralf.__all__:
        assert getattr(ralf, name).__doc__, name
