"""A sequence of earthquakes in the report of its run: what had become of the structure after each of them."""

from __future__ import annotations

from stylobate import plots
from stylobate.messages import joined, say
from stylobate.motion import Span
from stylobate.response.events import events_of
from stylobate.results import Numbers, RunResult

from . import numbers as n
from .page import Exact, Item, Rows, Section
from .pictures import picture
from .tables import MOST, table

HEADER = (
    *("", say("earthquake"), say("outcome so far"), say("largest turn"), say("slip added"), say("fell")),
    *(say("links broken"), say("came to rest")),
)


def sequence_section(run: RunResult) -> list[Section]:
    """The earthquakes of a sequence; nothing of any other run."""
    event_rows = run.summary.get("events")
    if not event_rows:
        return []
    spans = [Span(*(row[name] for name in ("motion", "begins_s", "quiet_s", "ends_s"))) for row in event_rows]
    events = events_of(run.response, spans)
    body = []
    for event in event_rows[:MOST]:
        alone = event["alone"]
        cells = [
            str(event["earthquake"]),
            Exact(event["motion"]),
            say(event["outcome"].replace("_", " ")),
            n.angle(alone["peak_rotation_rad"]),
        ]
        cells += [
            n.length(alone["added_slip_m"]),
            joined(", ", alone["fallen"]) or "–",
            joined(", ", alone["links_broken"]) or "–",
        ]
        body.append([*cells, say("yes") if alone["at_rest"] else say("no")])
    caption = say(
        "Each earthquake began as the one before had left the structure; slip added is the largest of a joint."
    )
    caption = joined(" ", [caption, n.first_of(MOST, len(event_rows))])
    items: list[Item] = [
        run.summary.get("sentence", ""),
        Rows(HEADER, body, caption, mark=2, looks=LOOKS, numbers=True),
    ]
    if events:
        shown = say(
            "Displacement and largest tilt over all earthquakes; rest is grey, dots are what each leaves behind."
        )
        items.append(picture(plots.draw_sequence(run.response, events, " "), shown))
        items.append(
            picture(plots.draw_ends(run.response, events, " "), say("The structure before, and at the end of each."))
        )
    return [Section(say("Earthquake by earthquake"), items)]


#: Marks of outcomes, in the words of the table.
LOOKS = {say("at rest"): "good", say("rocked"): "good", say("collapsed"): "bad"}


def until_fall_result(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """How many earthquakes of each kind it takes until the structure falls."""
    s, over = result.summary, result.summary["until_fall"]
    rows = (
        result.tables["until_fall"].astype(object).where(result.tables["until_fall"].notna(), None).to_dict("records")
    )
    first_row = rows[0]
    sentence = say("Earthquakes until it falls, {one[motion]} again and again: {one[earthquakes]}.", one=first_row)
    if len(rows) > 1:
        sentence = say(
            "Earthquakes until it falls, over {rows} kinds, each again and again: {over[sentence]}.",
            rows=len(rows),
            over=over,
        )
    keys = ["motion", "earthquakes", "median_low", "median_high", "interval_low", "interval_high"]
    keys += ["runs", "not_fallen", "failed", "most"]
    caption = say(
        "Each kind by itself, with {rest_s} s of quiet ground after each earthquake.", rest_s=n.plain(s.get("rest_s"))
    )
    fell = any(row["runs"] and row["not_fallen"] < row["runs"] for row in rows)
    return (sentence, " bad" * fell), [
        table(rows, keys, caption),
        say(
            "Each earthquake finds what the one before has left; the next of a kind is its copy, which no two "
            "earthquakes are."
        ),
    ]
