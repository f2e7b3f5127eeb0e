"""Whether the verdict of one run in space is the joints': the same column under laws of joints that fit as well.

Nobody has measured what joints of drums lose, where a round face carries, and how stiff they are to a factor of two. One run
takes one of these for granted. Its companions take the others, one by one: undamped and damped as a contact of stone, each
on rims and on beds where faces are round, and joints 2.3 times as stiff and as soft, which is one standard deviation of
what twins vary by. They are no sample: how likely a collapse is, twins tell.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from ..campaign.campaign import Campaign
from ..campaign.twins import UNDAMPED, on_rim_or_bed
from ..column.column import Column
from ..column.joint import LAWS, Losses
from ..column.materials import CONTACT, ROLLING
from ..column.scatter import spread_of
from ..messages import joined, say
from ..models.base import Case, Model
from ..models.engine import engine_for
from ..motion import Motion
from ..outcome import Outcome
from ..response.response import Response
from ..simulate import run_options
from . import verdicts as v
from .certainty import batch

#: Factor by which joints are stiffer and softer: one standard deviation of a coefficient of variation of 100 %.
FACTOR = math.exp(spread_of(1.0))


@dataclass(frozen=True)
class OtherLaws:
    """Verdicts on a column under other laws of its joints.

    Parameters
    ----------
    own : str
        Verdict of the run itself.
    verdicts : dict of str to str
        By law, in words.
    """

    own: str
    verdicts: dict[str, str]

    @property
    def changes(self) -> bool:
        """Whether the column falls under some of all these laws, the run's own among them, and stands under others."""
        return {v.COLLAPSED, v.STANDS} <= {self.own, *self.verdicts.values()}

    @property
    def sentence(self) -> str:
        """What other laws make of the verdict; empty where they make the same of it."""
        if not self.changes:
            return ""
        other = v.STANDS if self.own == v.COLLAPSED else v.COLLAPSED
        named = [law for law, verdict in self.verdicts.items() if verdict == other]
        made = say("stands") if other == v.STANDS else say("falls")
        return say(
            "The verdict hangs on what nobody knows of the joints: under {some} of {all} other laws it {made} ({laws}); "
            "replicates tell how sure that is.",
            some=len(named), all=len(self.verdicts), made=made, laws=joined(", ", named),
        )  # fmt: skip

    @property
    def words(self) -> str:
        """All verdicts, for people."""
        return joined("; ", (say("{law}: {verdict}", law=law, verdict=say(one)) for law, one in self.verdicts.items()))


def other_laws(response: Response, motion: Motion, model: Model, campaign: Campaign) -> OtherLaws | None:
    """Run a column once more under each other law of its joints; None where no law is at stake.

    None for models in the plane and assemblies, and where nothing opened or slid: then all laws are the same.

    Parameters
    ----------
    response : Response
        Of the run itself.
    motion : Motion
        That shook it.
    model : Model
        That computed it.
    campaign : Campaign
        Its tail, threads and cluster.
    """
    at_stake = engine_for(model, response.structure).draws_laws
    if not at_stake or response.outcome in (Outcome.AT_REST, Outcome.FAILED):
        return None
    column = response.structure
    others = dict(_companions(column, model))
    options = run_options(campaign.tail, quiet=response.provenance["quiet_share"], until_decided=True)
    alone = replace(campaign.of_computing, progress=None, ledger=None, tail=campaign.tail)
    rows = batch([Case(one, motion) for one in others.values()], column, model, alone, options)
    own = v.COLLAPSED if response.collapsed else v.STANDS if response.decided else v.UNDECIDED
    return OtherLaws(own, {law: v.verdict(row) for law, row in zip(others, rows, strict=True)})


def _companions(column: Any, model: Any) -> Iterator[tuple[str, Column]]:
    """Columns under other laws, by these laws in words."""
    acting = model.acting(column)
    damped = acting.damping(column) > UNDAMPED
    whole = on_rim_or_bed(column)
    for law in LAWS if whole else (acting.law,):
        for with_losses in (False, True):
            if law == acting.law and with_losses == damped:
                continue
            faces = (say("on rims, ") if law == "rim" else say("on beds, ")) if whole else ""
            words = faces + (say("damped as stone") if with_losses else say("undamped"))
            rolling = ROLLING.value if with_losses and column.section == "circular" else 0.0
            yield words, column.unwarned(losses=Losses(CONTACT.value if with_losses else 0.0, rolling, law))
    own = Losses(acting.damping(column), acting.rolling_resistance, acting.law)
    for words, factor in ((say("stiffer joints"), FACTOR), (say("softer joints"), 1.0 / FACTOR)):
        joints = tuple(
            joint.changed(
                normal_stiffness=joint.normal_stiffness * factor, shear_stiffness=joint.shear_stiffness * factor
            )
            for joint in column.joint_laws
        )
        yield words, column.unwarned(joints=joints, losses=own)
