"""Expressions of Grasshopper: parsed to Python's syntax tree, of which only arithmetic and known functions are run."""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable, Mapping
from typing import Any

from hookean_canvas.run.natives.declare import Unfit, native

LONGEST = 1024  # bits of whole numbers; powers above this are computed in floating point
FUNCTIONS: dict[str, Callable[..., Any]] = {
    "abs": abs, "acos": math.acos, "asin": math.asin, "atan": math.atan, "atan2": math.atan2,
    "ceiling": math.ceil, "cos": math.cos, "cosh": math.cosh, "cube": lambda x: _power(x, 3), "deg": math.degrees,
    "exp": math.exp, "fix": math.trunc, "floor": math.floor, "int": lambda x: math.floor(x + 0.5), "ln": math.log,
    "log": lambda x, base=None: math.log10(x) if base is None else math.log(x, base), "log10": math.log10,
    "max": max, "min": min, "mod": math.fmod, "pow": lambda a, b: _power(a, b), "rad": math.radians,
    "round": lambda x, digits=0: _rounded(x, digits),
    "sgn": lambda x: (x > 0) - (x < 0), "sign": lambda x: (x > 0) - (x < 0), "sin": math.sin, "sinh": math.sinh,
    "sqr": lambda x: _product(x, x), "sqrt": math.sqrt, "tan": math.tan, "tanh": math.tanh, "trunc": math.trunc,
}  # fmt: skip
"""Functions by their names in lower case; `if` is known beside them."""
CONSTANTS = {"pi": math.pi, "e": math.e, "true": True, "false": False}

_OPERATORS: dict[type, Callable[..., Any]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: lambda a, b: _product(a, b), ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv, ast.Mod: math.fmod, ast.Pow: lambda a, b: _power(a, b),
    ast.USub: operator.neg, ast.UAdd: operator.pos, ast.Not: operator.not_,
    ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt, ast.GtE: operator.ge,
    ast.Eq: operator.eq, ast.NotEq: operator.ne,
}  # fmt: skip


def _power(a: Any, b: Any) -> Any:
    whole = isinstance(a, int) and isinstance(b, int) and b >= 0 and a.bit_length() * b <= LONGEST
    return a**b if whole else math.pow(a, b)


def _product(a: Any, b: Any) -> Any:
    long = isinstance(a, int) and isinstance(b, int) and a.bit_length() + b.bit_length() > LONGEST
    return float(a) * b if long else a * b


def _rounded(x: Any, digits: Any) -> Any:
    return round(float(x), max(-LONGEST, min(int(digits), LONGEST))) if digits else math.floor(x + 0.5)


def evaluated(text: str, values: Mapping[str, Any]) -> Any:
    """The value of an expression such as `sin(x) + y^2`, with values of variables by name; Unfit where it has none.

    Names of functions, of constants and of words such as `and` are known in any case, those of variables exactly.
    """
    if len(text) > 4000:
        raise Unfit("the expression has more than 4000 characters")
    try:
        value = _value(ast.parse(_python(text), mode="eval").body, values)
    except (SyntaxError, RecursionError, MemoryError):
        raise Unfit(f"{_cut(text)!r} is not an expression that is read here") from None
    except (ArithmeticError, ValueError, TypeError) as error:
        if isinstance(error, Unfit):
            raise
        raise Unfit(f"{_cut(text)!r} has no value: {error}") from None
    if isinstance(value, float) and not math.isfinite(value):
        raise Unfit(f"{_cut(text)!r} has no value: it is beyond floating point")
    return value


def _cut(text: str) -> str:
    return text if len(text) <= 60 else text[:57] + "..."


def _python(text: str) -> str:
    """Grasshopper's notation as Python's: ^ is a power, = and <> compare, \\ divides whole numbers."""
    found = text.strip().replace("^", "**").replace("\\", "//").replace("²", "**2").replace("³", "**3")
    found = re.sub(r"<>|≠", "!=", found.replace("≤", "<=").replace("≥", ">=").replace("π", " pi ").replace("×", "*"))
    found = re.sub(r"(?<![<>=!])=(?!=)", "==", found).replace("&&", " and ").replace("||", " or ")
    found = re.sub(r"\bif\s*\(", "if_(", found, flags=re.IGNORECASE)
    return re.sub(r"\b(and|or|not)\b", lambda word: word[0].lower(), found, flags=re.IGNORECASE)


def _value(node: ast.expr, values: Mapping[str, Any]) -> Any:
    match node:
        case ast.Constant(value=bool() | int() | float() | str() as constant):
            return constant
        case ast.Name(id=name):
            return _named(name, values)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
            return _combined(type(op), _value(left, values), _value(right, values))
        case ast.UnaryOp(op=op, operand=operand) if type(op) in _OPERATORS:
            return _OPERATORS[type(op)](_value(operand, values))
        case ast.Compare(left=left, ops=[op], comparators=[right]) if type(op) in _OPERATORS:
            return _OPERATORS[type(op)](_value(left, values), _value(right, values))
        case ast.BoolOp(op=op, values=parts):
            return (all if isinstance(op, ast.And) else any)(_value(part, values) for part in parts)
        case ast.Call(func=ast.Name(id="if_"), args=[test, yes, no], keywords=[]):
            return _value(yes if _value(test, values) else no, values)
        case ast.Call(func=ast.Name(id=name), args=parts, keywords=[]) if name.lower() in FUNCTIONS:
            return FUNCTIONS[name.lower()](*(_value(part, values) for part in parts))
    raise Unfit(f"{_cut(ast.unparse(node))!r} is not part of an expression that is read here")


def _combined(op: type, a: Any, b: Any) -> Any:
    if op is not ast.Add and (isinstance(a, str) or isinstance(b, str)):
        raise Unfit("text can be added, nothing else")
    return _OPERATORS[op](a, b)


def _named(name: str, values: Mapping[str, Any]) -> Any:
    if name in values:
        return values[name]
    if name.lower() in CONSTANTS:
        return CONSTANTS[name.lower()]
    raise Unfit(f"the variable {name} has no value")


@native("9df5e896-552d-4c8c-b9ca-4fc147ffa022", "Expression", "Expression",
        "Variable x (x): any optional ...", "Result (R)", sees=True)  # fmt: skip
def expression(*given: Any, node: Any) -> Any:
    """The value of the expression written on the component, with its inputs as variables."""
    text = node.container.value("Expression") or node.container.value("InternalExpression") or ""
    return evaluated(str(text), {port.nickname: value for port, value in zip(node.inputs, given, strict=False)})


@native("cc2b626f-6eff-4d08-9829-2877560693f4", "Evaluate", "Eval",
        "Expression (F): text; Variable x (x): any optional ...", "Result (r)", sees=True)  # fmt: skip
def evaluate(text: str, *given: Any, node: Any) -> Any:
    """The value of an expression that comes as text, with the inputs as variables."""
    return evaluated(text, {port.nickname: value for port, value in zip(node.inputs[1:], given, strict=False)})
