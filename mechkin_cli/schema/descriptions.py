"""The help text of each key: the string that stands below the field in the model's source.

Read only for messages and for the JSON Schema; reading the sources costs more than a validation.
"""

import ast
import inspect
from functools import cache
from itertools import pairwise
from textwrap import dedent

from mechkin_cli.schema.base import Section


def field_descriptions(section: type[Section]) -> dict[str, str]:
    """Help texts by field name, those of base classes included."""
    descriptions: dict[str, str] = {}
    for model in reversed(section.__mro__):
        if model is not Section and Section in model.__mro__:
            descriptions |= _below_fields(model)
    return descriptions


@cache
def _below_fields(model: type) -> dict[str, str]:
    definition = ast.parse(dedent(inspect.getsource(model))).body[0]
    body = definition.body if isinstance(definition, ast.ClassDef) else []
    found = {}
    for field, below in pairwise(body):
        if not (isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name)):
            continue
        if isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant):
            found[field.target.id] = inspect.cleandoc(str(below.value.value)).replace("\n", " ")
    return found
