"""What stands on the ground, each as one body that rocks there with all that it carries: what losses by name look at."""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from .column import Column
from .drum import Drum
from .structure import Bed, Structure

#: Joints whose normals rise less than this carry nothing.
LEVEL = 1e-6

#: Digits to which boxes are told: those of equal columns are equal.
DIGITS = 5

#: Density of boxes, whose joints are as stiff for it as theirs are for what they carry [kg/m³].
DENSITY = 2700.0

#: Azimuths in which the width of a bed is looked for.
AZIMUTHS = 36


def rocking_bodies(structure: Structure) -> tuple[Column, ...]:
    """All that stands on what moves with the ground, each as one drum on its bed with its share of what it carries.

    A column is one body. Of what is no stack each body on fixed ones is a box (or a round drum) on a bed as large, as heavy
    as the body with its share of all above it, which is spread evenly over what carries it, and twice as high as their
    centroid is above the bed. Bodies that would slide before they rock are left out, and equal ones are told once.
    """
    if structure.stack is not None:
        return (one_body(structure.stack),)
    if not structure.gravity:
        return ()
    boxes = dict.fromkeys(_boxes(structure))
    return tuple(box for box in boxes if math.tan(box.slenderness) < box.joint_laws[0].tan_phi)


def one_body(column: Column) -> Column:
    """The column as a single drum of its outline and mass on the joint with the base."""
    first, last = column.drums[0], column.drums[-1]
    ends = first.depth, None if column.section == "circular" else last.upper_depth
    drum = Drum(column.height, first.bottom_width, last.top_width, first.density, column.section, *ends)
    drum = dataclasses.replace(drum, density=first.density * column.mass / drum.mass)
    who = {"name": f"{column.name} as one body", "gravity": column.gravity}
    return Column.of_fields(drums=(drum,), joints=column.joint_laws[:1], **who)


def _boxes(structure: Structure) -> list[Column]:
    """Of every body on fixed ones the box that rocks as it does."""
    bodies, beds = structure.bodies, [_upright(bed) for bed in structure.beds if abs(bed.rise) > LEVEL]
    count, fixed = len(bodies), np.array([body.fixed for body in bodies])
    share = np.zeros((count, count))  # that each body carries of another one
    for bed in beds:
        share[bed.lower, bed.upper] += 1.0
    share /= np.maximum(share.sum(axis=0), 1.0)
    mass, high = np.array([(0.0, 0.0) if body.fixed else (body.mass, body.place[1]) for body in bodies]).T
    carried, moment = np.linalg.lstsq(np.eye(count) - share, np.stack((mass, mass * high), axis=1), rcond=None)[0].T
    boxes = []
    for number in np.flatnonzero(~fixed):
        own = [bed for bed in beds if bed.upper == number and fixed[bed.lower]]
        middle = moment[number] / carried[number] - min((bed.level for bed in own), default=math.inf)
        if middle > 0.0:
            weighs = carried[number] * float(share[fixed, number].sum())
            boxes.append(_box(own, float(weighs), float(2.0 * middle), structure))
    return boxes


def _upright(bed: Bed) -> Bed:
    return bed if bed.rise > 0.0 else bed._replace(lower=bed.upper, upper=bed.lower, rise=-bed.rise)


def _box(beds: list[Bed], mass: float, height: float, structure: Structure) -> Column:
    """A drum as high that rocks over the narrow side of what some beds span, on joints as stiff beside its mass."""
    corners, area, law = np.concatenate([bed.corners for bed in beds]), sum(bed.area for bed in beds), beds[0].law
    azimuth = np.arange(AZIMUTHS) * (math.pi / AZIMUTHS)
    ways = np.stack((np.cos(azimuth), np.sin(azimuth)))[: corners.shape[1], : 1 if corners.shape[1] == 1 else None]
    across = float(np.ptp(corners @ ways, axis=0).min())
    round_ = len(beds) == 1 and beds[0].round
    section, depth = ("circular", 1.0) if round_ else ("rectangular", _rounded(area / across))
    drum = Drum(_rounded(height), _rounded(across), _rounded(across), DENSITY, section, depth)
    stiffness = {
        name: _rounded(getattr(law, name) * drum.mass / mass) for name in ("normal_stiffness", "shear_stiffness")
    }
    who = {"name": "body on the ground", "gravity": structure.gravity}
    return Column.of_fields(drums=(drum,), joints=(law.changed(**stiffness),), **who)


def _rounded(number: float) -> float:
    return float(f"{number:.{DIGITS}g}")
