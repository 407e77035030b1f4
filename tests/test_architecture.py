"""The rules of the layout, held by looking at the code itself."""

import ast
import re
from pathlib import Path

import pytest

import assess
from assess.inventory.blank import describe
from assess.inventory.columns import SHEETS
from assess.methods import all_methods

ROOT = Path(assess.__file__).parents[1]
PACKAGE = ROOT / "assess"

LAYERS = {
    "version": 0, "units": 0, "errors": 0, "risk": 0, "resources": 0, "compiled": 0,
    "settings": 1, "language": 1,
    "motion": 2,
    "rocking": 3,
    "methods": 4,
    "inventory": 5,
    "demand": 6,
    "ensembles": 7, "adoption": 7, "verification": 7, "ranking": 7, "cases": 7,
    "remarks": 7, "results": 7, "assessment": 7, "live_values": 7, "routes": 7,
    "report": 8, "start": 8,
    "studies": 9,
    "__init__": 10, "__main__": 10, "cli": 10, "cli_motion": 10, "cli_study": 10, "console": 10, "options": 10,
    "progress": 10, "doctor": 10,
}  # fmt: skip
"""A module imports from lower layers, and inside its own layer or folder without a loop."""

MODULES = sorted(PACKAGE.rglob("*.py"))
LONGEST_FILE, LONGEST_FUNCTION = 300, 30
LONG_FILES = (
    "columns.py",  # one table, a column a line
    "kernel.py",  # compiled functions that call each other: numba sees a change only in the file of the caller
)
LONG_FUNCTIONS = ("_step",)  # of the kernel: the hot loop


def _layer(module):
    parts = module.split(".")
    return LAYERS[parts[1] if len(parts) > 1 else "__init__"]


def _name(path):
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" and len(parts) > 2 else parts)


def _imports(path):
    """Modules of the package that a file imports, whether at its head or inside a function."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                inner = PACKAGE.parent / Path(*node.module.split("."), f"{alias.name}.py")
                found.add(f"{node.module}.{alias.name}" if inner.is_file() else node.module)
    return {name for name in found if name.split(".")[0] == "assess"}


@pytest.mark.parametrize("path", MODULES, ids=_name)
def test_imports_go_to_lower_layers_only(path):
    module = _name(path)
    own = _layer(module)
    for other in _imports(path):
        same_folder = module.split(".")[:2] == other.split(".")[:2]
        assert _layer(other) < own or same_folder or _layer(other) == own, f"{module} imports {other}"


def test_no_loops_inside_a_layer():
    edges = {_name(path): _imports(path) for path in MODULES}
    done = set()

    def visit(module, above):
        assert module not in above, " -> ".join([*above, module])
        if module in done or module not in edges:
            return
        for other in edges[module]:
            visit(other, [*above, module])
        done.add(module)

    for module in edges:
        if module != "assess.__init__":
            visit(module, [])


def test_every_module_has_a_layer():
    assert {_name(path).split(".")[1] for path in MODULES} == set(LAYERS)


def test_reports_import_no_physics():
    for path in (PACKAGE / "report").rglob("*.py"):
        for other in _imports(path):
            assert not other.startswith("assess.rocking"), f"{path.name} imports {other}"


@pytest.mark.parametrize("path", MODULES, ids=_name)
def test_no_group_of_a_pattern_is_possessive(path):
    """Python 3.11.0 to 3.11.4 match them wrongly, and Debian 12 ships 3.11.2."""
    assert not re.search(r"\)[?*+]\+", path.read_text(encoding="utf-8"))


@pytest.mark.parametrize("path", MODULES, ids=_name)
def test_files_and_functions_stay_short(path):
    text = path.read_text(encoding="utf-8")
    if path.name not in LONG_FILES:
        assert text.count("\n") <= LONGEST_FILE
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef) and node.name not in LONG_FUNCTIONS:
            body = node.body[1:] if ast.get_docstring(node) else node.body
            length = (body[-1].end_lineno or 0) - body[0].lineno + 1 if body else 0
            assert length <= LONGEST_FUNCTION, f"{node.name} has {length} lines"


@pytest.mark.parametrize("method", all_methods(), ids=lambda method: method.key)
def test_every_method_is_tested_and_referenced(method):
    tests = ROOT / "tests" / "methods" / f"test_{method.key}.py"
    assert re.search(r"^\s*def test_", tests.read_text(encoding="utf-8"), re.MULTILINE)
    assert method.reference.title
    assert method.reference.source or method.reference.remark
    assert method.equations
    module = PACKAGE / "methods" / f"{method.key}.py"
    docstring = ast.get_docstring(ast.parse(module.read_text(encoding="utf-8"))) or ""
    for heading in ("Reference", "Equations", "Validity", "Departures"):
        assert re.search(rf"^{heading}\n-+$", docstring, re.MULTILINE), heading


def test_readme_table_is_that_of_the_columns():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert readme_table() in text, (
        "run: python -c 'from tests.test_architecture import readme_table; print(readme_table())'"
    )


def readme_table():
    """The README's table of columns, made from columns.py."""
    lines = ["| sheet | column | what to fill in |", "|---|---|---|"]
    for sheet in SHEETS:
        for column in sheet.columns:
            star = " *" if column.required else ""
            lines.append(f"| {sheet.name} | {column.header()}{star} | {describe(column)} |")
    return "\n".join(lines)


@pytest.mark.filterwarnings("ignore:.*extension is not supported")
@pytest.mark.parametrize(("name", "language"), [("blank.xlsx", "en"), ("blank-it.xlsx", "it")])
def test_blank_workbook_is_in_step_with_the_columns(tmp_path, name, language):
    import openpyxl

    from assess.start import start_workbook

    start_workbook(tmp_path / name, "si", language=language)
    fresh, kept = (openpyxl.load_workbook(path) for path in (tmp_path / name, ROOT / "inventories" / name))
    assert fresh.sheetnames == kept.sheetnames
    for name in fresh.sheetnames:
        cells = [
            {cell.coordinate: cell.value for row in book[name].iter_rows() for cell in row} for book in (fresh, kept)
        ]
        assert cells[0] == cells[1], f"{name}: run `make blank`"
