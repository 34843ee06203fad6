"""Natural vibrations by the mouse: found for an equilibrium, drawn as motion, stopped."""

import numpy as np
import pytest
from waiting import until

import voxsoft as vs

pytestmark = pytest.mark.browser


def test_a_mode_is_found_drawn_and_stopped(serving, tmp_path, open_tab, coarse):
    rubber = coarse.replace("ecoflex-00-30-lattice", "ecoflex-00-30")
    server = serving(tmp_path, text=rubber)
    try:
        tab = open_tab(server.address)
        tab.page.get_by_role("button", name="Solve", exact=True).click()
        tab.find("find-modes").wait_for()
        end, rest = tab.page.evaluate(
            """() => {
                const far = [...Array(5000).keys()]
                    .map((v) => [v, window.voxsoft.vertexPosition(v)])
                    .filter(([, at]) => at !== null);
                return far.reduce((best, one) => (one[1][0] > best[1][0] ? one : best));
            }"""
        )

        def offset():
            at = tab.page.evaluate(f"window.voxsoft.vertexPosition({end})")
            return np.subtract(at, rest)

        def far(way):
            """A way of more than a millimeter."""
            return tuple(way) if np.linalg.norm(way) > 1e-3 else None

        tab.find("find-modes").click()
        group = tab.page.get_by_role("group", name="Natural vibrations")
        group.wait_for()
        buttons = group.get_by_role("button")
        (tmp_path / "same.toml").write_text(rubber)
        slowest = vs.modes(vs.simulate(vs.load(tmp_path / "same.toml")), 1).frequencies[0]
        # Three digits are shown.
        shown = float(buttons.first.inner_text().split()[0])
        assert shown == pytest.approx(slowest, rel=5e-3)
        # The end swings to both sides of where it stands, by a part of the body's length.
        one = until(lambda: far(offset()))
        until(lambda: offset() @ one < -1e-3 * np.linalg.norm(one))
        tab.shot("vibration")
        buttons.nth(2).click()
        tab.page.get_by_text("press it again to stop").wait_for()
        tab.shot("vibration-third")
        buttons.nth(2).click()
        tab.page.get_by_text("Press one to see it").wait_for()
        # Frames hold positions to a part in 65,535 of the body.
        until(lambda: np.abs(offset()).max() < 1e-5)
        assert tab.errors == []
    finally:
        server.stop()
