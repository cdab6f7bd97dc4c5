"""The list of `make quick`: every test that it names exists."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
NAMED = (ROOT / "tests" / "quick.txt").read_text(encoding="utf-8").splitlines()


@pytest.mark.parametrize("named", NAMED)
def test_the_list_names_tests_that_exist(named: str) -> None:
    path, _, test = named.partition("::")
    module = ast.parse((ROOT / path).read_text(encoding="utf-8"))
    functions = {each.name for each in module.body if isinstance(each, ast.FunctionDef)}
    assert not test or test.partition("[")[0] in functions
