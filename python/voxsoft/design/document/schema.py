"""The JSON Schema of a design document, for editors and forms."""

from __future__ import annotations

from typing import Any, Final

_FORMULA: Final = {"type": "string", "pattern": r"^\s*="}
_ANNOTATIONS: Final = ("title", "description", "default")


def with_formulas(schema: Any) -> Any:  # noqa: ANN401 - a JSON Schema is nested plain data
    """Allow a formula wherever a schema asks for a number.

    Parameters
    ----------
    schema
        A JSON Schema; it is not changed.

    Examples
    --------
    >>> with_formulas({"type": "integer", "title": "Count"})["anyOf"][0]
    {'type': 'integer'}
    """
    if isinstance(schema, list):
        return [with_formulas(entry) for entry in schema]
    if not isinstance(schema, dict):
        return schema
    if schema.get("type") in ("number", "integer"):
        number = {key: value for key, value in schema.items() if key not in _ANNOTATIONS}
        about = {key: schema[key] for key in _ANNOTATIONS if key in schema}
        return {"anyOf": [number, dict(_FORMULA)], **about}
    if "oneOf" in schema and "discriminator" not in schema:
        # Text may be a name and a quantity at once, as far as a schema can tell.
        schema = {**schema, "anyOf": schema["oneOf"]}
        del schema["oneOf"]
    # A property may itself be called "type"; its value is a schema then, not a word.
    return {key: with_formulas(value) for key, value in schema.items()}
