#!/usr/bin/python3
"""Makes ricochet/scene.py and ricochet/scene.pyi from docs/scene.schema.json, which the tool prints from the tables of
its reader. The files have one class for every object of a scene, with its keys as keyword arguments.

    python/generate_scene.py            writes both files
    python/generate_scene.py --check    fails if they are not up to date
"""

import json
import keyword
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
HERE = Path(__file__).resolve().parent / "ricochet"

HEADER = '''"""The things of a scene, each with its keys as keyword arguments: made by python/generate_scene.py from the
tool's schema, not to be edited. Each is a dictionary with the keys of a scene file."""
'''

CODE = HEADER + '''
from __future__ import annotations

from typing import Any, Dict


class Thing(Dict[str, Any]):
    """A dictionary with the keys that were given."""

    _fixed: Dict[str, Any] = {}

    def __init__(self, **keys: Any) -> None:
        super().__init__(self._fixed)
        self.update((key, value) for key, value in keys.items() if value is not None)

    def __repr__(self) -> str:
        keys = ", ".join(f"{key}={value!r}" for key, value in self.items() if key not in self._fixed)
        return f"{type(self).__name__}({keys})"
'''

STUB = HEADER + '''
import os
from typing import Any, Dict, Mapping, Optional, Sequence, Union

import numpy.typing as npt

Path = Union[str, "os.PathLike[str]"]
Vector = Union[Sequence[float], npt.NDArray[Any]]

class Thing(Dict[str, Any]):
    def __init__(self, **keys: Any) -> None: ...
'''


def camel(name):
    return "".join(part.capitalize() for part in name.split("_"))


def type_of(key, schema):
    """Returns a type for the stub. A mesh may replace the name of a mesh file."""
    if key == "file":
        return "Any"
    if "const" in schema or "enum" in schema:
        return "str"
    kind = schema.get("type")
    if kind == "array":
        items = schema.get("items", {})
        if items.get("type") in ("number", "integer"):
            return "Vector"
        return "Sequence[Any]"
    simple = {"number": "float", "integer": "int", "string": "str", "boolean": "bool"}
    if kind in simple:
        return simple[kind]
    if kind == "object":
        return "Mapping[str, Any]"
    return "Any"


def things(schema):
    """Yields (class name, fixed keys, schema) for every object with keys."""
    yield "Scene", {"ricochet": schema["properties"]["ricochet"]["maximum"]}, schema
    for name, definition in sorted(schema["$defs"].items()):
        own = "SimulationOptions" if name == "simulation" else camel(name)
        if "properties" in definition:
            yield own, {}, definition
        for alternative in definition.get("oneOf", []):
            kind = alternative.get("properties", {}).get("type", {}).get("const")
            if kind is not None:
                yield camel(kind) + own, {"type": kind}, dict(alternative, of=definition.get("description", ""))


def docstring(schema, keys):
    lines = [schema.get("description", "")]
    if keys:
        lines.append("")
    required = schema.get("required", [])
    for key in keys:
        entry = schema["properties"][key]
        note = " Required." if key in required else ""
        if "default" in entry and entry["default"] not in ([], {}):
            note = f" Default: {json.dumps(entry['default'])}."
        text = f"{key}: {entry.get('description', '')}{note}"
        lines += textwrap.wrap(text, 112, subsequent_indent="    ", break_long_words=False)
    return "\n".join("    " + line if line else "" for line in lines).strip().replace("\\", "\\\\")


def generate(schema):
    code, stub = [CODE], [STUB]
    for name, fixed, definition in things(schema):
        keys = [key for key in definition["properties"] if key not in fixed and key.isidentifier()]
        code.append(f'\n\nclass {name}(Thing):\n    """{docstring(definition, keys)}\n    """\n')
        if fixed:
            code.append(f"\n    _fixed = {fixed!r}\n".replace("'", '"'))
        stub.append(f"\nclass {name}(Thing):\n    def __init__(\n        self,\n        *,\n")
        required = definition.get("required", [])
        for key in keys:
            if keyword.iskeyword(key):
                continue
            kind = type_of(key, definition["properties"][key])
            if key in required or kind == "Any":
                stub.append(f"        {key}: {kind}{'' if key in required else ' = ...'},\n")
            else:
                stub.append(f"        {key}: Optional[{kind}] = ...,\n")
        if any(keyword.iskeyword(key) for key in keys):
            stub.append("        **keys: Any,\n")
        stub.append("    ) -> None: ...\n")
    return "".join(code), "".join(stub)


def main():
    schema = json.loads((ROOT / "docs" / "scene.schema.json").read_text(encoding="utf-8"))
    made = dict(zip(("scene.py", "scene.pyi"), generate(schema)))
    if sys.argv[1:] == ["--check"]:
        old = [name for name, text in made.items() if (HERE / name).read_text(encoding="utf-8") != text]
        if old:
            sys.exit(f"not up to date: {', '.join(old)}; run python/generate_scene.py")
        return
    for name, text in made.items():
        (HERE / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
