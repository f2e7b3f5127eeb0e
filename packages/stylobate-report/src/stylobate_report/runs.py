"""Runs in a report: verdict, motion, histories, film strip, statics and energy of one; a table of several."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from stylobate import plots
from stylobate.bibliography import cite_run
from stylobate.constants import g
from stylobate.messages import digits, joined, percent, say
from stylobate.outcome import Outcome
from stylobate.response import Response
from stylobate.response.words import doubt_of, each_doubt, opening_words, to_decide
from stylobate.results import RunResult, SeveralRuns
from stylobate.verdicts.directions import harm
from stylobate.verdicts.limit_states import codes_of, shares
from stylobate.verdicts.population import CHANCE, chance_words
from stylobate.verdicts.verdict import verdict

from . import numbers as n
from .certainty import OF_TWINS, beside_them, certainty_section, certainty_sentence
from .page import Exact, Facts, Item, Note, Rows, Section
from .pictures import picture
from .record import (
    headline,
    model_section,
    noted,
    record_section,
    request_section,
    sources_section,
    titled,
    versions_of,
    warnings_of,
)
from .sequence import sequence_section
from .shaking import motion_section
from .statics import statics_section
from .structure import structure_section

#: An imbalance of the ledger beyond which a report warns [-].
IMBALANCE = 0.05

#: Marks of outcomes.
LOOKS = {"at_rest": "good", "rocked": "good", "displaced": "fair", "collapsed": "bad", "failed": "bad"}


#: Caption of the uplift of joints.
UPLIFT = say(
    "Largest uplift along the rim of the drum above each joint, by direction. Where that rim lies beyond the "
    "face below, it is larger than the opening, which is measured where faces overlap."
)


def run_sections(run: RunResult) -> list[Section]:
    """All sections of one run."""
    r, summary = run.response, run.summary
    column = r.structure.stack
    motion_facts = run.request.motions[0] if run.request is not None and run.request.motions else None
    parts = [
        Section(say("Verdict"), [_verdict(run), *warnings_of(run, _doubts(run))]),
        request_section(run, _request_rows(r)),
    ]
    parts.append(structure_section(r.structure))
    parts.append(motion_section(run.motion, r, motion_facts, column))
    parts += sequence_section(run)
    parts += _motion_of_what_stood(r, summary)
    sure = certainty_section(summary)
    parts += [sure] if sure is not None else []
    parts += [statics_section(column, run)] if column is not None else []
    parts.append(_energy(r))
    parts.append(model_section([r.model]))
    parts.append(record_section(r.provenance.get("parameters", {}), _versions(run)))
    parts.append(sources_section(cite_run(r.provenance)))
    return parts


# -- parts ---------------------------------------------------------------------------------------------------------


def verdict_look(response: Response, doubted: bool = False) -> str:
    """Words that set a verdict apart; one that most columns like it do not share is no good one."""
    if response.outcome in (Outcome.COLLAPSED, Outcome.FAILED):
        return "verdict bad"
    return "verdict" if response.decided and not doubted else "verdict fair"


def _verdict(run: RunResult) -> Note:
    r = run.response
    texts = [headline(run, joined(" ", [r.sentence, *_how_far(r)]))]
    if r.structure.scattered:
        if r.outcome is not Outcome.FAILED:
            texts.append(certainty_sentence(run.summary))
    else:
        texts.append(
            say(
                "How sure this verdict is was not computed: only columns and assemblies in space are computed with "
                "varied properties. It is that of exactly this geometry, these joints and this motion, and near "
                "collapse small differences decide."
            )
        )
    return Note(
        [*texts, _scope(run)],
        verdict_look(r, bool(beside_them(run.summary) or run.summary.get("law_changes_verdict"))),
        first=len(texts),
    )


def _doubt(run: RunResult) -> str:
    """What stands beside its verdict: as told with those like it, whichever the version that wrote it of the run itself."""
    return run.summary.get("doubt") or doubt_of(run.response)


def _how_far(r: Response) -> list[str]:
    """When it fell, or how far it moved and where it rests."""
    m = r.measures
    if m.collapsed:
        return [say("The collapse was certain {m.collapse_time:.2f} s after the start.", m=m)]
    width, angle = r.structure.base_width, r.structure.slenderness
    if r.outcome is Outcome.FAILED or width is None or angle is None:
        return []
    rests = say(
        "Its top moved by up to {far}, {share:.2f} of the width of the base, and rests {left} from where it stood."
    )
    was = say("Its top moved by up to {far}, {share:.2f} of the width of the base, and was at the end {left} from where it "
              "stood.")  # fmt: skip
    far, residual = n.length(m.peak_top_displacement), n.length(abs(m.residual_top_displacement))
    sentences = [(rests if r.decided else was).of(far=far, share=m.peak_top_displacement / width, left=residual)]
    plain = len(r.structure.shapes) == 1 and not (r.structure.as_found or r.structure.links) and r.dims != "xyz"
    if plain and math.isfinite(m.peak_rotation):
        turned = say("It turned by up to {share:.2f} of the slenderness α, at which it is balanced on its edge.")
        sentences.append(turned.of(share=m.peak_rotation / angle))
    return sentences


def _scope(run: RunResult) -> str:
    return say(
        "This is the verdict of one model, {model}, under the one motion below. It is no statement about other "
        "earthquakes, and no check against a code. What the model leaves out stands under “What the model "
        "assumes, and where it ends”.",
        model=titled(run.response.model),
    )


def _doubts(run: RunResult) -> list[str]:
    r, doubts = run.response, [*filter(None, [_doubt(run)])]
    if not r.decided and r.outcome is not Outcome.FAILED:
        known, waited = r.provenance, bool(r.provenance.get("until_decided"))
        cure = to_decide(r.structure, known.get("parameters", {}), float(known.get("tail_s", 0.0)), waited)
        doubts.append(say("the run ended before the verdict was certain; {cure}: do not rely on it before.", cure=cure))
    if abs(r.energy_imbalance) > IMBALANCE:
        doubts.append(
            say(
                "the energy balance misses {energy_imbalance} of the energy at stake: halve the time step (a smaller "
                "step factor) and compare.",
                energy_imbalance=percent(abs(r.energy_imbalance)),
            )
        )
    motions = run.request.motions if run.request is not None else ()
    if left_out := (motions[0].get("left_out") if motions else None) or r.provenance.get("left_out"):
        words = say("left out of the motion, which the model does not take: {names}.")
        doubts.append(words.of(names=joined("; ", left_out)))
    return doubts


def _request_rows(r: Response) -> list[tuple[str, str]]:
    p = r.provenance
    pairs = [(say("structure"), Exact(r.structure.name)), (say("motion"), Exact(p.get("motion", n.NONE)))]
    pairs.append((say("model"), say("{r.model}, step {r.time_step:.3g} s, {r.steps} steps", r=r)))
    pairs.append((say("time computed"), say("{time:.2f} s from the start of the motion", time=float(r.time[-1]))))
    if opens := opening_words(p.get("opening")):
        pairs.append((say("largest static acceleration that it stands"), opens))
    if (stepped := r.measures.stepped) is not None:
        pairs.append(
            (
                say("of which stepped"),
                say("{stepped[2]:.2f} s, without the quiet in which the column lies at rest", stepped=stepped),
            )
        )
    if p.get("until_rest"):
        pairs.append((say("followed"), say("until everything lies still")))
    else:
        tail = say("{time:g} s", time=float(p.get("tail_s", 0.0)))
        pairs.append((say("quiet time asked for after the motion"), tail))
    return pairs


def _motion_of_what_stood(r: Response, summary: dict[str, Any]) -> list[Section]:
    before = say("Measures of the response. Peaks are those before the fall; the pictures below go on to "
                 "{time:.2f} s and show the fall itself.", time=r.time[-1])  # fmt: skip
    items: list[Item] = [Facts(_measures(r), before if r.collapsed else say("Measures of the response"))]
    space, top = r.dims == "xyz", r.histories.top is not None
    of_top = say("Histories: displacement of top and base relative to the ground, over the acceleration of the ground.")
    texts = [of_top if top else say("Histories: displacement of the blocks, over the acceleration of the ground.")]
    if r.collapsed:
        texts.append(say("The dotted line is where the collapse became certain, at {r.collapse_time:.2f} s.", r=r))
    items.append(picture(plots.draw_histories(r, " "), joined(" ", texts)))
    sides = say("Film strip: what stood, at chosen instants, seen along y (x to the right) and against x (y to "
                "the right), in true proportion unless the title says a factor.")  # fmt: skip
    plain = say("Film strip: what stood, at chosen instants, in true proportion unless the title says a factor.")
    most = say("Under each time: how far the block that moved most is from where it was.")
    texts = [sides if space else plain]
    texts.append(say("Under each time: how far its top is from where it was.") if top else most)
    if r.structure.space_joints is not None and r.collapsed:
        texts.append(
            say("Where pieces come to lie is one draw of many: take regions over assemblies like it (`replicates`).")
        )
    items.append(picture(plots.draw_filmstrip(r, title=" "), joined(" ", texts)))
    if top:
        items.append(picture(plots.draw_joints(r, " "), say("Opening of every joint over time, each to its own peak.")))
    if space and top:
        items.append(picture(plots.draw_orbit(r, " "), say("Orbit of the top in plan, relative to the base.")))
        items.append(picture(plots.draw_uplift(r, " "), UPLIFT))
        items.append(
            picture(
                plots.draw_residuals(r, " "),
                say(
                    "Each drum over what it stands on, in plan, at the end or where the collapse became certain. "
                    "Offsets and twists may be drawn larger; the numbers are true."
                ),
            )
        )
    joints = _joints(r, summary)
    return [Section(say("What it did"), [*items, *joints])]


def _measures(r: Response) -> list[tuple[str, str]]:
    m = r.measures
    until = (
        "" if not m.collapsed else say(" before the fall") if m.blocks is None else say(" until the first block fell")
    )
    pairs = [(say("outcome"), _outcome(r))]
    if m.collapsed:
        pairs.append((say("collapse certain at"), say("{m.collapse_time:.2f} s", m=m)))
    measures, base = [pair for pair in m.shown(space=True) if not math.isnan(pair[1])], r.structure.base_width
    far = [(measure, value) for measure, value in measures if measure.peak and "displacement" in measure.field]
    for measure, value in far:
        share = "" if base is None else say(" ({base:.2f} base widths)", base=value / base)
        pairs.append((measure.phrase + until, n.length(value) + share))
    if m.blocks is not None and r.fell_at:
        fell = (say("{name} ({time:.2f} s)", name=name, time=when) for name, when in r.fell_at.items())
        pairs.append((say("fell"), joined(", ", fell)))
    pairs += [(measure.phrase, n.length(value)) for measure, value in measures if measure.residual and not m.collapsed]
    others = [(measure, value) for measure, value in measures if measure.peak and (measure, value) not in far]
    shown = {"m": n.length, "rad": n.angle}
    return pairs + [(measure.phrase + until, shown[measure.unit](value)) for measure, value in others]


def _outcome(r: Response) -> str:
    return say(r.outcome.label.replace("_", " ")) + ("" if r.decided else say(", undecided"))


def _joints(r: Response, summary: dict[str, Any]) -> list[Item]:
    opening = summary.get("peak_opening_per_joint_m")
    if not isinstance(opening, list):
        return []
    if r.measures.blocks is not None:
        return [*_bodies(r), *_joints_of_blocks(r, opening)]
    slip, twist = summary.get("residual_slip_per_joint_m"), summary.get("residual_twist_per_joint_rad")
    header = [say("joint"), say("peak opening [mm]"), say("residual slip [mm]")] + (
        [say("residual twist [°]")] if twist else []
    )
    body = []
    for i, gap in enumerate(opening):
        row = [str(i + 1), n.NONE if gap is None else digits(1000.0 * gap, ".2f")]
        joint_slip = slip[i] if isinstance(slip, list) and i < len(slip) else None
        row.append(n.NONE if joint_slip is None else digits(1000.0 * joint_slip, ".2f"))
        if twist:
            row.append(n.NONE if twist[i] is None else digits(math.degrees(twist[i]), ".2f"))
        body.append(row)
    texts = [say("Joints, from the base up.")]
    if r.collapsed:
        texts.append(say("Openings are the largest recorded until the collapse was certain, the beginning of the "
                         "fall included, which the measures above leave out. Slips and twists are those at the "
                         "end; –: the joint that failed and all above."))  # fmt: skip
    return [Rows(header, body, joined(" ", texts), numbers=True)]


def _bodies(r: Response) -> list[Item]:
    """Each body of an assembly: its tilt, when and to which side it fell, how far it is displaced."""
    blocks = r.measures.blocks
    assert blocks is not None
    header = [
        say("body"),
        say("peak tilt [°]"),
        say("fell at [s]"),
        say("towards azimuth [°]"),
        say("residual displacement [mm]"),
    ]
    body = []
    for block in blocks.bodies:
        side = n.NONE if block.fall_azimuth is None else digits(math.degrees(block.fall_azimuth), ".0f")
        far = n.NONE if block.fell_at is not None else digits(1000.0 * math.hypot(*block.moved), ".2f")
        fell = n.NONE if block.fell_at is None else digits(block.fell_at, ".2f")
        body.append([block.name, digits(math.degrees(block.peak_tilt), ".2f"), fell, side, far])
    caption = say("Bodies that can move; tilts over the whole run, the fall included. Azimuths from x towards y.")
    return [Rows(header, body, caption, numbers=True)] if body else []


def _joints_of_blocks(r: Response, opening: list[float | None]) -> list[Item]:
    """Joints of an assembly by the bodies that they join."""
    structure, gone = r.structure, r.collapsed
    joints = structure.joined_faces
    slip = np.linalg.norm(r.slip[-1], axis=-1)
    header = [
        say("joint"),
        say("between"),
        say("peak opening [mm]"),
        *([] if gone else [say("residual slip [mm]"), say("residual twist [°]")]),
    ]
    body = []
    for k, (joint, gap) in enumerate(zip(joints, opening, strict=True)):
        names = joined(" – ", (structure.bodies[joint.lower].name, structure.bodies[joint.upper].name))
        row = [str(k + 1), names, n.NONE if gap is None else digits(1000.0 * gap, ".2f")]
        row += [] if gone else [digits(1000.0 * slip[k], ".2f"), digits(math.degrees(r.twist[-1, k]), ".2f")]
        body.append(row)
    caption = say("Joints until the first body fell.") if gone else say("Joints.")
    return [Rows(header, body, caption, numbers=True)] if body else []


def _energy(r: Response) -> Section:
    share = abs(r.energy_imbalance)
    text = say(
        "The energy that the motion put in is found again as kinetic energy, height, elastic energy of the "
        "joints and what friction, damping and impacts took. Missing at the end: {share:.2g} % of the energy at "
        "stake, the largest of what was put in, what it takes to overturn, and what a fall sets free. A run that "
        "misses more than {imbalance} is warned of under the verdict.",
        share=100.0 * share,
        imbalance=percent(IMBALANCE),
    )
    return Section(
        say("Energy balance"),
        [
            text,
            picture(
                plots.draw_energy(r, " "),
                say("Energy over time (gravity: of height), and below the share that the balance misses."),
            ),
        ],
    )


def _versions(run: RunResult) -> dict[str, Any]:
    p = run.response.provenance
    known = versions_of(run)
    return {
        "stylobate": p.get("version"),
        "Python": p.get("python"),
        "machine": p.get("machine"),
        "digest of what stood": p.get(f"{run.response.structure.kind}_digest") or known.get("digest of what stood"),
        "digest of the motion": p.get("motion_digest"),
        "states recorded every": say("{time:g} s", time=float(p.get("output_interval_s", math.nan))),
    }


# -- several -------------------------------------------------------------------------------------------------------


def worst_of(runs: Sequence[RunResult]) -> int:
    """Number of the run with the most harm."""
    return max(range(len(runs)), key=lambda i: harm(runs[i].response.measures.row()))


def _record_of(run: RunResult) -> str:
    """The record that its motion is of; the motion itself where the folder does not tell."""
    motions = run.request.motions if run.request is not None else ()
    return str((motions[0].get("record") if motions else None) or run.folder.name)


def several_sections(result: SeveralRuns) -> list[Section]:
    """A table of all runs, and the one with the most harm in full."""
    runs = result.runs
    codes = codes_of(np.array([verdict(run.response.summary()) for run in runs]))
    (share,) = shares({runs[0].response.structure.name: codes}, [_record_of(run) for run in runs])
    header = [say("motion"), say("PGA [g]"), say("outcome"), CHANCE, say("peak displacement"), say("folder")]
    body = []
    for run in runs:
        r, s = run.response, run.summary
        m = r.measures
        moved = m.peak_top_displacement if m.blocks is None else m.blocks.peak_displacement
        peak = n.NONE if run.motion is None else digits(run.motion.horizontal_peak[0] / g, ".3f")
        body.append(
            [
                Exact(r.provenance.get("motion", "")),
                peak,
                _outcome(r),
                chance_words(s) or n.NONE,
                n.length(moved),
                Exact(run.folder.name),
            ]
        )
    looks = {say(name.replace("_", " ")): look for name, look in LOOKS.items()}
    worst = worst_of(runs)
    doubts = each_doubt(_doubt(run) for run in runs)
    lead = Section(
        say("All runs"),
        [
            Note([headline(result, share.collapses)], "verdict bad" if share.exceeded else "verdict"),
            *noted(doubts),
            Rows(
                header,
                body,
                joined(" ", [say("One row per motion."), OF_TWINS]),
                mark=2,
                looks=looks,
                numbers=True,
            ),
        ],
    )
    title = say("The run with the most harm: {motion}", motion=Exact(runs[worst].response.provenance.get("motion", "")))
    return [
        lead,
        Section(title, [say("Every other run has a folder of its own, which can be reported by itself.")]),
        *run_sections(runs[worst]),
    ]
