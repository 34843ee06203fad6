"""Films of the view, as files that decode."""

import base64
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

pytestmark = pytest.mark.browser

PLAYED = """(data) => new Promise((done) => {
  const video = document.createElement('video');
  video.onerror = () => done({error: video.error.message});
  // A film that is written as it comes tells its length at its end only.
  video.onloadedmetadata = () => { video.currentTime = 1e6; };
  let looks = 0;
  const look = () => {
    const canvas = document.createElement('canvas');
    [canvas.width, canvas.height] = [video.videoWidth, video.videoHeight];
    const context = canvas.getContext('2d');
    context.drawImage(video, 0, 0);
    const pixels = context.getImageData(0, 0, canvas.width, canvas.height).data;
    const colors = new Set(new Uint32Array(pixels.buffer)).size;
    // A picture that was sought may not have been decoded yet.
    if (colors === 1 && looks++ < 100) setTimeout(look, 50);
    else done({size: [canvas.width, canvas.height], seconds: video.duration, colors});
  };
  video.onseeked = look;
  video.src = 'data:video/webm;base64,' + data;
})"""


def record(tab, kind):
    """Record while time runs, and save; the menu may be shut and opened meanwhile."""
    tab.page.get_by_label("Speed of time").select_option("1/50")
    tab.find("view-film").click()
    tab.find(f"record-{kind}").click()
    tab.find("stop-recording").wait_for()
    tab.find("view-film").click()
    tab.find("play").click()
    frame = tab.page.evaluate("voxsoft.frame")
    tab.until(f"voxsoft.frame > {frame} + 40")
    tab.find("view-film").click()
    with tab.page.expect_download() as waiting:
        tab.find("stop-recording").click()
    download = waiting.value
    assert download.suggested_filename.startswith("finger-")
    assert download.suggested_filename.endswith(f".{kind}")
    return Path(download.path())


def test_a_webm_plays_in_a_browser(tab, chromium):
    film = record(tab, "webm").read_bytes()
    assert film[:4] == bytes([0x1A, 0x45, 0xDF, 0xA3])  # EBML
    assert b"webm" in film[:64]
    context = chromium.new_context()
    try:
        played = context.new_page().evaluate(PLAYED, base64.b64encode(film).decode())
    finally:
        context.close()
    box = tab.page.locator(".viewport canvas").bounding_box()
    assert played["size"] == [round(box["width"]), round(box["height"])]
    assert played["seconds"] > 0.2
    assert played["colors"] > 200
    assert tab.errors == []


def test_a_gif_has_frames_that_differ_and_last(tab):
    with Image.open(record(tab, "gif")) as film:
        assert film.format == "GIF"
        assert film.n_frames > 2
        pictures, durations = [], []
        for number in range(film.n_frames):
            film.seek(number)
            durations.append(film.info["duration"])
            pictures.append(np.asarray(film.convert("RGB")).astype(int))
    # Browsers slow down frames that are shorter; the writer caps pauses at half a second.
    assert all(80 <= duration <= 500 for duration in durations)
    assert np.abs(pictures[-1] - pictures[0]).max() > 12
    assert len(np.unique(pictures[-1].reshape(-1, 3), axis=0)) > 50
    assert tab.errors == []
