"""The base of every typed table of a design, and plain messages about its problems."""

from voxsoft.records.complaints import plain_error, problems_of, records_in
from voxsoft.records.names import Name, check_name
from voxsoft.records.places import closest, place, steps_of
from voxsoft.records.plain import plain_values
from voxsoft.records.record import Record
from voxsoft.records.table import FrozenDict, Table

__all__ = [
    "FrozenDict",
    "Name",
    "Record",
    "Table",
    "check_name",
    "closest",
    "place",
    "plain_error",
    "plain_values",
    "problems_of",
    "records_in",
    "steps_of",
]
