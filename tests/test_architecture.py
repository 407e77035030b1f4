"""The rules of the layout, checked on the source: each test lists every place that breaks its rule."""

import ast
import re
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

import assess
from assess.methods import all_methods
from docs.texts import KEYWORDS
from tests.conftest import STAND_ALONE

ROOT = Path(assess.__file__).parents[1]
PACKAGE = ROOT / "assess"

LAYERS = {
    "version": 0, "arrays": 0, "units": 0, "errors": 0, "risk": 0, "resources": 0,
    "text": 0, "compiled": 0, "settings": 1, "i18n": 1, "progress": 1,
    "processes": 1, "pictures": 1, "plans": 1, "environment": 1, "table": 1,
    "delivery": 2, "motion": 2, "fragility": 2, "hazard": 2, "intensity": 2,
    "rocking": 3, "rates": 3, "bracket": 3, "details": 3,
    "methods": 4,
    "model": 5,
    "results": 6, "route_results": 6, "annual_results": 6, "schedule_results": 6,
    "fields": 7,
    "workbook": 8,
    "routes": 9,
    "pipeline": 10,
    "report": 11, "report_formats": 11,
    "studies": 12, "compare": 12, "web": 12, "bim": 12, "portfolio": 12,
    "cli": 13, "__init__": 13, "__main__": 13,
}  # fmt: skip
"""A module imports from lower layers, and inside its own layer or folder without a loop."""

MODULES = sorted(PACKAGE.rglob("*.py"))
LONGEST_FILE, LONGEST_FUNCTION = 800, 60
"""Lines of code: docstrings, comments and blank lines of a file are not counted."""
LONG_FILES = {"assess/results.py"}  # the rows of every table
LATE_IMPORTS = {("assess.results", "assess.fields")}
"""Allowed inside a function: tables are built from the fields, when they are asked for."""
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
PHYSICS = ("assess.methods", "assess.motion", "assess.rocking")
DESCRIPTIONS = {"MethodInfo", "Reason", "Reference"}
"""Types in which a method describes itself: results hold them, and reports may import them from `assess.methods`."""
OPTION = re.compile(r"(?<!brew )(?:^|(?<=[\s(`'\"]))--[a-z][a-z-]*")
"""Options of `assess`; Homebrew has its own."""


@cache
def _tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def _nodes(path: Path) -> tuple[ast.AST, ...]:
    return tuple(ast.walk(_tree(path)))


def _layer(module: str) -> int:
    parts = module.split(".")
    return LAYERS[parts[1] if len(parts) > 1 else "__init__"]


def _name(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" and len(parts) > 2 else parts)


def _place(path: Path, node: ast.expr | ast.stmt | None = None) -> str:
    return path.relative_to(ROOT).as_posix() + (f":{node.lineno}" if node else "")


@cache
def _imports(path: Path) -> frozenset[str]:
    """Return the modules of the package that a file imports, whether at its head or inside a function."""
    found = set()
    for node in _nodes(path):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                inner = ROOT / Path(*node.module.split("."), f"{alias.name}.py")
                found.add(f"{node.module}.{alias.name}" if inner.is_file() else node.module)
    return frozenset(name for name in found if name.split(".")[0] == "assess")


def _texts(path: Path) -> Iterator[ast.Constant]:
    """Yield the string literals of a file, parts of f-strings included, without docstrings."""
    statements = {id(node.value) for node in _nodes(path) if isinstance(node, ast.Expr)}
    for node in _nodes(path):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in statements:
            yield node


# ---------------------------------------------------------------- who imports whom


def test_every_module_has_a_layer():
    assert {_name(path).split(".")[1] for path in MODULES} <= set(LAYERS)


def test_imports_go_to_lower_layers_only():
    def is_allowed(module: str, other: str) -> bool:
        is_lower = module.split(".")[:2] == other.split(".")[:2] or _layer(other) <= _layer(module)
        return is_lower or (module, other) in LATE_IMPORTS

    pairs = [(_name(path), other) for path in MODULES for other in _imports(path)]
    assert [f"{module} imports {other}" for module, other in pairs if not is_allowed(module, other)] == []


def test_no_loops_inside_a_layer():
    late = {path: {other for module, other in LATE_IMPORTS if module == _name(path)} for path in MODULES}
    edges = {_name(path): _imports(path) - late[path] for path in MODULES}
    done = set()

    def visit(module: str, above: list[str]) -> None:
        assert module not in above, " -> ".join([*above, module])
        if module in done or module not in edges:
            return
        for other in sorted(edges[module]):
            visit(other, [*above, module])
        done.add(module)

    for module in edges:
        if module != "assess.__init__":
            visit(module, [])


def _typing_only(path: Path) -> set[int]:
    """Return the nodes that serve type checkers alone."""
    blocks = (one for one in _nodes(path) if isinstance(one, ast.If) and "TYPE_CHECKING" in ast.unparse(one.test))
    return {id(node) for block in blocks for node in ast.walk(block)}


def _imported(path: Path) -> Iterator[tuple[ast.Import | ast.ImportFrom, list[str]]]:
    """Yield what a file imports, but for type checkers alone: the statements and the modules."""
    typing_only = _typing_only(path)
    for node in _nodes(path):
        if isinstance(node, ast.ImportFrom) and id(node) not in typing_only:
            yield node, [node.module or ""]
        elif isinstance(node, ast.Import) and id(node) not in typing_only:
            yield node, [alias.name for alias in node.names]


def test_packages_that_stand_alone_are_imported_by_their_commands_alone_and_late():
    """Studies, building models, the city and the page: the core does without them, and so do they without each other.

    Where one makes use of another, as the city does of COBie files, it imports it inside the function that needs it.
    """
    found = []
    for path in MODULES:
        own = path.relative_to(PACKAGE).parts[0]
        late = {id(node) for one in _nodes(path) if isinstance(one, FUNCTIONS) for node in ast.walk(one)}
        for node, named in _imported(path):
            others = {name.split(".")[1] for name in named if name.startswith("assess.")} & {*STAND_ALONE} - {own}
            if others and (own not in (*STAND_ALONE, "cli") or id(node) not in late):
                found.append(f"{_place(path, node)} {ast.unparse(node)}")
    assert found == []


def test_reports_import_no_physics():
    """What a report shows is in the results; a name that serves type checkers alone may be imported for them."""
    found = [
        f"{_place(path, node)} {ast.unparse(node)}"
        for path in (PACKAGE / "report").rglob("*.py")
        for node, named in _imported(path)
        if not (isinstance(node, ast.ImportFrom) and _describes(node))
        and any(f"{name}.".startswith(f"{one}.") for name in named for one in PHYSICS)
    ]
    assert found == []


def _describes(node: ast.ImportFrom) -> bool:
    return node.module == "assess.methods" and {alias.name for alias in node.names} <= DESCRIPTIONS


def test_what_the_formats_of_records_share_is_their_own():
    """Modules of `assess.motion.formats` with an underscore: in other packages a change of them would be a surprise."""
    own = "assess.motion.formats"
    others = (path for path in MODULES if not _name(path).startswith(own))
    found = [(_place(path), name) for path in others for name in _imports(path) if name.startswith(f"{own}._")]
    assert found == []


def test_no_method_is_named_outside_its_own_file():
    """Studies compare methods and may name them; all others ask a method for its role, tier, title and columns."""
    keys = {method.key for method in all_methods()}
    found = []
    for path in MODULES:
        if path.parent.name == "studies" or path.parent.parent.name == "studies":
            continue
        own = {path.stem} if path.parent.name == "methods" else set()
        named = {f"assess.methods.{key}" for key in keys - own}
        found += [f"{_place(path)} imports {other}" for other in sorted(named & _imports(path))]
        found += [f"{_place(path, node)} {node.value!r}" for node in _texts(path) if node.value in keys - own]
    assert found == []


def test_studies_stand_alone():
    """Nothing but the command line imports them, and no study imports another."""
    studies = {
        _name(path) for path in MODULES if re.search(r"^STUDY = ", path.read_text(encoding="utf-8"), re.MULTILINE)
    }
    assert len(studies) > 5
    found = []
    for path in MODULES:
        module = _name(path)
        if not module.startswith("assess.studies"):
            allowed = {"assess.studies"} if module.startswith("assess.cli") else set()
            found += [
                f"{module} imports {one}"
                for one in _imports(path)
                if one.startswith("assess.studies") and one not in allowed
            ]
        else:
            found += [f"{module} imports {one}" for one in _imports(path) & studies if not module.startswith(one)]
    assert found == []


def test_only_the_command_line_names_options():
    """The options of pipx, in the line that says how to install an extra, are not ours."""
    paths = [
        path for path in MODULES if not path.is_relative_to(PACKAGE / "cli") and path != PACKAGE / "environment.py"
    ]
    found = [
        f"{_place(path, node)} {option}"
        for path in paths
        for node in _texts(path)
        for option in OPTION.findall(node.value)
    ]
    assert found == []


# ---------------------------------------------------------------- files


def test_the_command_line_prints_in_one_place():
    """`assess.cli.console.say` takes out what could command a terminal."""
    files = [path for path in (ROOT / "assess" / "cli").glob("*.py") if path.name != "console.py"]
    assert [path.name for path in files if re.search(r"typer\.echo|\bprint\(", path.read_text(encoding="utf-8"))] == []


def test_names_of_files_are_unique_within_a_package():
    """A folder of modules counts by its own name."""
    names = Counter(
        (file.relative_to(PACKAGE).parts[0], (file.parent if file.name == "__init__.py" else file).stem)
        for file in MODULES
        if file.parent.name != "sections"  # a section of the report is called as what it shows
    )
    assert [name for name, count in names.items() if count > 1] == []


def test_files_and_functions_are_short():
    found = []
    for path in MODULES:
        lines = _count_code(path)
        found += [f"{_place(path)} has {lines} lines"] * (lines > LONGEST_FILE and _place(path) not in LONG_FILES)
        for node in _nodes(path):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                body = node.body[1:] if ast.get_docstring(node) else node.body
                is_table = len(body) == 1 and isinstance(body[0], ast.Return)  # one row written, field by field
                length = (body[-1].end_lineno or 0) - body[0].lineno + 1 if body and not is_table else 0
                found += [f"{_place(path, node)} {node.name} has {length} lines"] * (length > LONGEST_FUNCTION)
    assert found == []


def _count_code(path: Path) -> int:
    described = {
        line
        for node in _nodes(path)
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
        for line in range(node.lineno, (node.end_lineno or node.lineno) + 1)
    }
    lines = enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
    return sum(bool(text.strip()) and not text.lstrip().startswith("#") for at, text in lines if at not in described)


def test_no_group_of_a_pattern_is_possessive():
    """Python 3.11.0 to 3.11.4 match them wrongly, and Debian 12 ships 3.11.2."""
    assert [_place(path) for path in MODULES if re.search(r"\)[?*+]\+", path.read_text(encoding="utf-8"))] == []


def test_every_method_is_tested_and_referenced():
    missing = []
    for method in all_methods():
        tests = ROOT / "tests" / "methods" / f"test_{method.key}.py"
        has = {
            "tests": tests.is_file() and re.search(r"^\s*def test_", tests.read_text(encoding="utf-8"), re.MULTILINE),
            "a reference": method.reference.title and (method.reference.source or method.reference.remark),
            "equations": method.equations,
            "a validity": method.valid or method.assumptions,
        }
        missing += [f"{method.key}: {what}" for what, found in has.items() if not found]
    assert missing == []


# ---------------------------------------------------------------- what is wrong, in every language


def test_no_text_stands_inside_an_f_string():
    """Python 3.11 takes such a string as one piece: the text in it would be collected on later versions alone."""
    texts = [
        (_place(path, node), inner.args[0].value)
        for path in MODULES
        for node in _nodes(path)
        if isinstance(node, ast.JoinedStr)
        for inner in ast.walk(node)
        if isinstance(inner, ast.Call) and isinstance(inner.func, ast.Name) and inner.func.id in KEYWORDS
        if isinstance(inner.args[0], ast.Constant)
    ]
    assert texts == []


def test_messages_of_errors_can_be_translated():
    """The text of an InputError, SettingsError, WorkbookError, RecordError or OutputError is a `Text`, no bare string.

    Their subclasses count too, but for PdfUnavailableError: how to install a native library is printed in English, as
    are the messages of the command line and of studies. A text from elsewhere, such as the message of another
    error, is checked where it is made.
    """
    kinds = _list_errors({"InputError", "OutputError"}) - {"PdfUnavailableError"}
    assert kinds >= {"SettingsError", "WorkbookError", "RecordError"}
    english = (PACKAGE / "cli", PACKAGE / "studies")
    found = {
        _place(path, node)
        for path in MODULES
        if not any(path.is_relative_to(folder) for folder in english)
        for scope in _nodes(path)
        if isinstance(scope, ast.Module | ast.FunctionDef)
        for node in ast.walk(scope)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in kinds
        for text in node.args
        if _is_bare(text) or (isinstance(scope, ast.FunctionDef) and ast.unparse(text) in _list_bare(scope))
    }
    assert sorted(found) == []


def _list_errors(known: set[str]) -> set[str]:
    """Return the names of the errors and of all that derive from them."""
    classes = [node for path in MODULES for node in _nodes(path) if isinstance(node, ast.ClassDef)]
    derived = {node.name for node in classes if known.intersection(map(ast.unparse, node.bases))}
    return known if derived <= known else _list_errors(known | derived)


def _list_bare(function: ast.FunctionDef) -> set[str]:
    """Return the names to which a function assigns a text that is made without `fill`."""
    assigned = [node for node in ast.walk(function) if isinstance(node, ast.Assign) and _is_bare(node.value)]
    return {ast.unparse(target) for node in assigned for target in node.targets}


def _is_bare(node: ast.expr) -> bool:
    """Return whether an expression makes a text without `fill`: a literal, an f-string, or parts put together."""
    if isinstance(node, ast.Call):
        return ast.unparse(node.func) == "str" or getattr(node.func, "attr", "") in {"format", "join"}
    if isinstance(node, ast.BinOp):
        return _is_bare(node.left) or _is_bare(node.right)
    if isinstance(node, ast.IfExp):
        return _is_bare(node.body) or _is_bare(node.orelse)
    return isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str))


# ---------------------------------------------------------------- what is generated from the schema


@pytest.mark.parametrize(("name", "language"), [("blank.xlsx", "en"), ("blank-it.xlsx", "it")])
def test_blank_workbook_is_in_step_with_the_columns(tmp_path, name, language):
    import openpyxl

    from assess.cli.command_new import write_new_workbook

    write_new_workbook(tmp_path / name, "si", language=language)
    fresh, kept = (openpyxl.load_workbook(path) for path in (tmp_path / name, ROOT / "inventories" / name))
    assert fresh.sheetnames == kept.sheetnames
    for name in fresh.sheetnames:
        cells = [
            {cell.coordinate: cell.value for row in book[name].iter_rows() for cell in row} for book in (fresh, kept)
        ]
        assert cells[0] == cells[1], f"{name}: run `make blank`"
