"""One run of an assembly: closed under its weight, shaken, and followed to the end of the motion or until rest."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...column.assembly import Assembly
from ...constants import LONGEST_WAIT
from ...errors import InputError, warn
from ...kernels.plane.records import BETA
from ...kernels.run_codes import CHUNK
from ...motion import Motion
from ...response import Measures, Response
from ...response.assembly_measures import first_touch, have_fallen, lowest_standing, recorded_blocks
from ..base import Case, RunOptions, refuse_endless, refuse_long_histories
from ..drums.impact import rocking_column
from ..drums.links import acting, link_histories, link_measures, with_links
from ..drums.losses import with_provenance
from ..drums.stepped import StackEngine, SteppedEngine
from ..engine import engine_for
from ..shared import ledger
from ..shared.ground import ground_histories
from ..shared.stable_step import chosen_step, highest_frequency, stable_step
from .links import stiffness_between
from .loose import COST_STANDING, Contacts, Loose

#: Time after the last block has fallen at which a run of a batch ends [s].
AFTER_THE_FALL = 5.0


def step_for(engine: Loose, contacts: Contacts) -> float:
    """Time step of a run [s]; whole chunks of steps fill the motion.

    Raises
    ------
    InputError
        The step asked for is unstable.
    """
    name = repr(engine.structure.name)
    return min(
        chosen_step(stable_step_of(engine), contacts.step_factor, contacts.time_step, name),
        engine.motion.duration / CHUNK,
    )


class LooseInPlane(SteppedEngine):
    """Assemblies of blocks in the plane, any two of which may touch: one by one, each to the end of its run."""

    computes = (Assembly,)
    takes = frozenset({"as found"})
    links = StackEngine.links | {"clamp"}
    rocking = staticmethod(rocking_column)

    def check_start(self) -> None:
        """Refuse a start from a pose."""
        what = self.structure
        raise InputError(f"a start from a pose is for columns, and {what.name!r} is {what.described}; leave start out.")

    def check_length(self, motion: Motion, options: RunOptions) -> None:
        """The step of what may come loose is known once its contacts are: each run asks for itself."""

    def followed(self) -> Assembly:
        """The assembly: any two of its blocks may strike each other."""
        return self.structure

    @property
    def contacts(self) -> Contacts:
        """Numbers of its contacts.

        Raises
        ------
        InputError
            The stone is given a modulus.
        """
        acting = self.acting
        if acting.block_modulus is not None:
            raise InputError(
                f"block_modulus is {acting.block_modulus:g} Pa; the blocks of an assembly are rigid: leave it out."
            )
        return Contacts.of(acting)

    def expected_step(self, motion: Motion) -> tuple[float, float]:
        """Time step, and about what a step costs on one core as long as all stands, both [s]; what falls is dearer."""
        contacts = self.contacts
        loose = Loose(self.structure, contacts, motion, motion.duration)
        return step_for(loose, contacts), COST_STANDING * len(loose.records.body) * contacts.points

    def run(self, motion: Motion, options: RunOptions) -> Response:
        """One run with histories, however much falls."""
        response = run_assembly(self.structure, motion, self.contacts, replace(options, until_end=True))
        return with_provenance(self, motion, response)

    def run_many(self, cases: Sequence[Case], options: RunOptions, threads: int) -> Iterator[tuple[int, Measures]]:
        """Many runs one by one in threads, without histories."""

        def alone(case: Case) -> Response:
            contacts = engine_for(self.model, case.column).contacts
            return run_assembly(case.column, case.motion, contacts, options, recorded=False)

        return one_by_one(alone, cases, threads)


def run_assembly(
    assembly: Assembly, motion: Motion, contacts: Contacts, options: RunOptions, *, recorded: bool = True
) -> Response:
    """One run of an assembly to the end of the motion and its tail, or until rest.

    With neither ``until_end`` nor ``until_rest`` it ends some seconds after the last block has fallen.

    The contacts are closed by the weight they carry. An assembly that is not in equilibrium begins as drawn, with a
    warning, or is refused.

    Parameters
    ----------
    assembly : Assembly
    motion : Motion
    contacts : Contacts
    options : RunOptions
    recorded : bool
        Whether histories are wanted; without them the ledger is drawn up at the end only, and forces of links are not kept.

    Raises
    ------
    InputError
        The step asked for is unstable, or the assembly cannot settle.

    Warns
    -----
    OutOfRangeWarning
        The assembly is not in equilibrium as drawn.
    """
    motion, restitution = motion.multiplied, contacts.given_back
    engine = Loose(assembly, contacts, motion, motion.duration + options.tail, restitution)
    step = step_for(engine, contacts)
    length = engine.duration + (LONGEST_WAIT if options.until_rest else 0.0)
    refuse_endless(f"{assembly.name!r} under {motion.name!r}", length, step, engine.cost)
    refuse_long_histories(length / options.output_interval, len(assembly.blocks))
    engine.start(step)
    balanced = engine.settle()
    if not balanced and contacts.must_settle:
        raise InputError(
            f"{assembly.name!r} is not in equilibrium as drawn; support its blocks, or leave start=settle out to let "
            "it move."
        )
    if not balanced:
        said = f"{assembly.name!r} is not in equilibrium as drawn; it moves from the start."
        warn(said)
    start = engine.energies()
    states, still = follow(engine, options, recorded)
    stack = {key: np.array([state[key] for state in states]) for key in states[0] if key != "links"}
    change = stack["energy"] - np.where([0, 0, 1, 1, 1, 1], start, 0.0)
    imbalance = ledger.imbalance(
        ledger.unaccounted(change[-1]), work=float(np.abs(change[:, 0]).max()), start=float(start[3]), barrier=0.0,
        released=ledger.released(change[-1]),
    )  # fmt: skip
    acceleration, displacement = ground_histories(motion, stack["time"])
    step, poses = int(engine.now["touched"][0]), (stack["x"], stack["z"], stack["rotation"])
    touched = first_touch(assembly, stack["time"], *poses, step * engine.dt) if step >= 0 else None
    made = recorded_blocks(
        assembly,
        stack["time"],
        *poses,
        {name: change[:, k] for k, name in enumerate(ledger.TERMS)},
        acceleration,
        displacement,
        at_rest=still,
        in_equilibrium=balanced,
        failed=engine.failed or bool(ledger.out_of_balance(imbalance)),
        energy_imbalance=imbalance,
        time_step=engine.dt,
        steps=engine.steps,
        model=contacts.name,
        touched=touched,
        links=link_measures(acting(assembly), engine.records.link, 0, engine.dt),
        held=link_histories(states) if recorded else None,
        velocity=stack.get("velocity"),
        provenance={
            "restitution": restitution,
            "joints": len(assembly.joints),
            "deepest_penetration_m": engine.deepest(),
        },
    )
    return Response.of(made)


def follow(engine: Loose, options: RunOptions, recorded: bool = True) -> tuple[list[dict[str, Any]], bool]:
    """Go on to where the run ends; the states on the way, and whether all lies still after the motion.

    It ends with the motion and its tail, when all lies still, or some time after the last block has fallen.
    """
    every = max(1, min(engine.chunks, round(options.output_interval / (CHUNK * engine.dt))))
    keep = engine.state if recorded else engine.pose
    states, still, over = [keep()], False, False
    lowest, rotation = lowest_standing(engine.structure, states[0]["z"]), states[0]["rotation"]
    fallen, since = np.zeros(len(rotation), dtype=bool), 0.0
    while not engine.failed:
        left = engine.chunks - engine.steps // CHUNK
        still, over = engine.at_rest(), left <= 0
        if over:
            waits = options.until_rest or (options.until_decided and not fallen.any())
            if not waits or still or engine.time > engine.duration + LONGEST_WAIT:
                break
            engine.now["dull"] = engine.now["eta"]
        engine.advance(every if over else min(every, left))
        states.append(keep())
        if options.progress:
            options.progress(min(engine.time, engine.duration), engine.duration)
        now = have_fallen(lowest, states[-1]["z"], states[-1]["rotation"] - rotation)
        if (now != fallen).any():
            fallen, since = now, engine.time
        ends = not (options.until_end or options.until_rest)
        if ends and fallen.any() and engine.time - since > AFTER_THE_FALL:
            break
    if not recorded:
        states[-1]["energy"] = engine.energies()
    return states, still and over


def one_by_one(run: Callable[[Case], Response], cases: Sequence[Case], threads: int) -> Iterator[tuple[int, Measures]]:
    """(index of the case, measures) of runs as they finish."""
    from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait

    under_way: dict[Future[Response], int] = {}
    with ThreadPoolExecutor(threads) as pool:
        try:
            for index, case in enumerate(cases):
                if len(under_way) >= 2 * threads:
                    for one in wait(under_way, return_when=FIRST_COMPLETED).done:
                        yield under_way.pop(one), one.result().measures
                under_way[pool.submit(run, case)] = index
            while under_way:
                for one in wait(under_way, return_when=FIRST_COMPLETED).done:
                    yield under_way.pop(one), one.result().measures
        finally:
            for one in under_way:
                one.cancel()


def stable_step_of(loose: Loose) -> float:
    """Largest stable step of the joints as they are closed at the start, and of every block's longest face as a bed [s]."""
    records = loose.records
    body: Any = {name: records.body[name][:, 0] for name in ("x", "z", "im", "ii")}
    joint: Any = {name: records.joint[name][:, 0] for name in ("lc", "ls", "ht", "wl", "wr", "bl", "br", "kn", "ks")}
    xis, shares = records.lane["xi"][0, :, 0], records.lane["sh"][0, :, 0]
    n = len(records.body)
    stiffness = np.zeros((3 * n, 3 * n))
    for k, (lower, upper) in enumerate(records.topology.joints):
        e = {name: values[k] for name, values in joint.items()}
        u, v = (np.array([body["x"][i], body["z"][i]]) for i in (upper, lower))
        t = np.array([e["lc"], e["ls"]])
        normal = np.array([-t[1], t[0]])
        foot = v + e["ht"] * normal
        above = float((u - foot) @ t)
        lo, hi = max(-e["wl"], above - e["bl"]), min(e["wr"], above + e["br"])
        for xi, share in zip(xis, shares, strict=True):
            point = foot + (0.5 * (lo + hi) + 0.5 * xi * (hi - lo)) * t
            for along, stiff in ((normal, e["kn"]), (t, e["ks"])):
                row = np.zeros(3 * n)
                for number, place, sign in ((upper, u, 1.0), (lower, v, -1.0)):
                    arm = point - place
                    row[3 * number : 3 * number + 3] = sign * np.array([*along, arm[0] * along[1] - arm[1] * along[0]])
                stiffness += stiff * (hi - lo) * share * np.outer(row, row)
    omega = highest_frequency(stiffness, np.stack((body["im"], body["im"], body["ii"]), axis=1).ravel())
    for i, block in enumerate(loose.structure.bodies):
        if not block.fixed:
            # between two others on its longest face
            side = np.roll(block.corners, -1, axis=0) - block.corners
            k = (
                float(loose.law[:, :, 0].max())
                * float(loose.shape["depth"][i])
                * float(np.hypot(side[:, 0], side[:, 1]).max())
            )
            omega = max(
                omega,
                0.4 * math.sqrt(4.0 * k * (body["im"][i] + body["ii"][i] * float(loose.shape["r"][i]) ** 2 / 3.0)),
            )
    inverse = np.stack((body["im"], body["im"], body["ii"]), axis=1).ravel()
    beta = float(records.lane["damp"][0, BETA, 0])
    return stable_step(*with_links(stiffness_between(loose.structure, inverse), omega, beta))
