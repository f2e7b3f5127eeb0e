"""A run for people: its verdict in a sentence, and its measures in lines."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..outcome import Outcome
from . import options as o

if TYPE_CHECKING:
    from ..analysis.other_laws import OtherLaws
    from ..analysis.population import Population
    from ..motion import Motion
    from ..response import Response


#: Most bodies that are told one by one.
MOST_BODIES = 6

#: What losses of stone, which are chosen for one body, do not promise for a stack.
SLIPPING_STACK = "; impacts keep up to 5 % less velocity than those of one body, as joints slip"


def describe(
    response: Response,
    motion: Motion,
    files: list[Path],
    population: Population | None = None,
    laws: OtherLaws | None = None,
) -> None:
    """Print the verdict for people."""
    from ..response.words import doubt_of, opening_words
    from . import console

    found = column_facts(response) if response.measures.blocks is None else assembly_facts(response)
    sentence, what, facts = found
    if population is not None:
        sentence = f"{sentence} {population.sentence} {population.beside(response.summary())}".rstrip()
        facts |= population_facts(population)
    elif response.structure.scattered and response.measures.blocks is not None:
        facts["certainty"] = "one run, of exactly these stones; --replicates 15 runs assemblies like it as well"
    doubt = doubt_of(response) if population is None else population.doubt_about(response)
    if laws is not None:
        doubt = laws.sentence or doubt
        facts["under other laws"] = laws.words
    sentence = f"{sentence} {doubt}".rstrip()
    if opens := opening_words(response.provenance.get("opening")):
        what["rocks at"] = opens
    what |= quiet_facts(response)
    computed = f"{response.model}, step {response.time_step:.3g} s, {response.steps} steps, {response.wall_time:.2f} s"
    console.say(
        sentence, {**what, **o.input_lines(motion), "model": computed, **losses_facts(response), **facts}, files
    )


def losses_facts(response: Response) -> dict[str, str]:
    """What joints lost by name, in numbers."""
    told = response.summary()
    if told["losses"] in (None, "none") or "steps_over_undamped" not in response.provenance:
        return {}
    acting, more = told["losses_acting"], response.provenance["steps_over_undamped"]
    words = ", ".join(f"{name.replace('_', ' ')} {value:.2g}" for name, value in acting.items())
    stack = response.structure.stack
    slips = "" if stack is None or stack.n == 1 or told["losses"] != "stone" else SLIPPING_STACK
    return {"losses": f"{told['losses']}: {words}; {more:.2g} times as many steps as undamped{slips}"}


def quiet_facts(response: Response) -> dict[str, str]:
    """Stepped share of a record, where its quiet was left out."""
    stepped = response.measures.stepped
    if stepped is None:
        return {}
    ends = response.time[-1]
    return {"stepped": f"{stepped[2]:.3g} of {ends:.3g} s, without what is quiet (--whole steps all)"}


def population_facts(population: Population) -> dict[str, str]:
    """Columns like this one, or assemblies, and their displacements; of an assembly where its bodies lie."""
    from ..analysis.debris import OVER_ALL, not_safe, not_yet_debris, only_as_seen
    from ..percent import percents
    from . import console

    facts = {f"{population.like} like this": population.drawn.words}
    spreads = {name.split("_")[0]: spread for name, spread in population.spread.items() if "displacement" in name}
    for name, words in (("peak", "their peak, 16/50/84 %"), ("residual", "their residual, 16/50/84 %")):
        if (spread := spreads[name]) is not None:
            facts[words] = ", ".join("collapse" if one == float("inf") else console.length(one) for one in spread)
    listed = not_safe(population.bodies)
    for body in listed[:MOST_BODIES]:
        half, most = (console.length(one) for one in body.radii)
        x, y = (console.length(one) for one in body.middle)
        open_ = f", {body.open} undecided" * bool(body.open)
        facts[f"body {body.name}"] = (
            f"fell in {body.fell} of {body.runs}{open_} ({percents(*body.interval(population.confidence))}); at the end, "
            f"{OVER_ALL}, {x} along x and {y} along y from where it stood (medians), half of the runs within {half} of "
            f"that and 90 % within {most}"
        )
    if len(listed) > MOST_BODIES:
        facts["other bodies"] = (
            f"{len(listed) - MOST_BODIES} more fell or are undecided in some (bodies.csv with --out)"
        )
    if listed and (seen := only_as_seen(listed[0].runs)):
        facts["regions"] = seen
    if listed and (moving := not_yet_debris(population.bodies)):
        facts["debris"] = f"{moving}: where bodies were is not yet where they lie"
    return facts


def column_facts(response: Response) -> tuple[str, dict[str, str], dict[str, str]]:
    """Verdict on a column, what it is, and its measures."""
    m, column = response.measures, response.column
    drums = f"{column.n} {'drum' if column.n == 1 else 'drums'}"
    shown = f"histories and films show the fall, to {response.time[-1]:.2f} s"
    facts = {"collapse": f"certain at {m.collapse_time:.2f} s; {shown}"} if m.collapsed else {}
    facts |= measure_facts(response, ", before the fall")
    return response.sentence, {"column": f"{column.name}, {drums}, {column.height:g} m high"}, facts


def assembly_facts(response: Response) -> tuple[str, dict[str, str], dict[str, str]]:
    """Verdict on an assembly, what it is, and its measures."""
    from ..response.block_words import moving_at_end

    structure: Any = response.structure
    sentence = response.sentence
    if response.at_rest:
        sentence += " Everything lies still."
    elif response.outcome is not Outcome.FAILED:
        change = "" if response.decided else " and the verdict may change"
        waited = response.provenance.get("until_rest", False)
        damping = "mass_damping=0.5" if structure.space_joints is None else "stiffness_damping=1e-4"
        remedy = f"; damp it with --set {damping}" if waited else "; go on with --until-rest"
        rolls = waited and structure.space_joints is not None and moving_at_end(response)  # which no damping stops
        sentence += f" Not everything lies still{change}{'' if rolls else remedy}."
    fixed = sum(block.fixed for block in structure.bodies[-structure.n :])
    supports = f", {fixed} of them fixed" if fixed else ""
    joined = structure.face_pairs if structure.space_joints is None else structure.space_joints
    joints = f"{len(joined)} {'joint' if len(joined) == 1 else 'joints'}"
    what = f"{structure.name}, {structure.n} blocks{supports}, {joints}"
    return sentence, {"assembly": what}, measure_facts(response, ", until the first block fell")


def measure_facts(response: Response, until: str) -> dict[str, str]:
    """Measures that are declared with a label, in lines; ``until`` says where peaks end that a collapse has ended."""
    from ..response.measures import TOP
    from . import console

    m, facts, base = response.measures, {}, response.structure.base_width
    for one, value in m.shown():
        when = "" if not m.collapsed else until if one.peak else ", at the end"
        share = f" ({value / base:.2f} base widths)" if one.peak and one.of == TOP and base is not None else ""
        facts[one.label + when] = (console.length(value) if one.unit == "m" else f"{value:.4f} {one.unit}") + share
    return facts | {"energy imbalance": f"{m.energy_imbalance:.1e} of the energy at stake"}
