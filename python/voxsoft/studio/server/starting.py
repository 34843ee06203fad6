"""Content of the start screen: finished robots, ways to a new one, and files of before."""

from __future__ import annotations

from typing import Final

from voxsoft.design import robots
from voxsoft.studio.protocol import events

#: Address of the pictures of robots on the server.
PICTURES: Final = "/robot/"
#: The robot whose picture moves.
MOVING: Final = robots.ROBOTS[0].name


def start_event(recent: list[events.RecentFile], *, fresh: bool) -> events.Start:
    """Make the event of the start screen.

    Parameters
    ----------
    recent
        Files of before, the newest first.
    fresh
        True if nothing was opened or changed yet, so that the screen opens by itself.
    """
    return events.Start(
        fresh=fresh,
        robots=[
            events.Robot(
                name=each.name,
                title=each.title,
                sentence=each.sentence,
                picture=f"{PICTURES}{each.name}",
                moving=f"{PICTURES}{each.name}?moving=1" if each.name == MOVING else "",
            )
            for each in robots.ROBOTS
        ],
        ways=[
            events.Way(
                name=each.name,
                drive=each.drive,
                form=each.form,
                task=each.task,
                robot=each.robot,
                sentence=each.sentence,
            )
            for each in robots.STARTS
        ],
        recent=recent,
    )
