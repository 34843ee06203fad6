#!/usr/bin/env bash
# pint 0.24.3 beside flexparser 0.4: a newly installed pint cannot be imported.
#
# Seen: pip takes flexparser 0.4 for pint's requirement without an upper bound, and `import pint` ends
# in "cannot inherit frozen dataclass from a non-frozen one"; with flexparser 0.3.1 the import works.
# So a lower bound of `pint>=0.24` does not mean what it says today; 0.24.4 is the first that works.
# Exits 1 where that has changed.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
install() { "$folder/venv/bin/pip" install --quiet --disable-pip-version-check "$@"; }

imported() {
  "$folder/venv/bin/python" - <<'SCRIPT'
from importlib.metadata import requires, version

print("pint", version("pint"), "flexparser", version("flexparser"), end=": ")
print([need for need in requires("pint") if need.startswith("flexparser")], end=" ")
try:
    import pint

    print(pint.UnitRegistry()("1 mm"))
except TypeError as error:
    print(f"TypeError: {error}")
SCRIPT
}

install pint==0.24.3 flexparser==0.4
imported | tee "$folder/new"
install flexparser==0.3.1
imported | tee "$folder/old"
install pint==0.24.4 flexparser==0.4
imported | tee "$folder/next"
grep -q "TypeError: cannot inherit frozen" "$folder/new"
grep -q "1 millimeter" "$folder/old"
grep -q "1 millimeter" "$folder/next"
