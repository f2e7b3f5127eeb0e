"""The request for motions: one value that expands into what is shaken with, and what a model takes of it."""

import dataclasses
import math

import numpy as np
import pytest

import stylobate as st
from stylobate.errors import LeftOutWarning
from stylobate.messages import Message
from stylobate.motion import keep_axes, read_motion, write_csv
from stylobate.motion.conditioning import conditioned_alike, trim
from stylobate.motion.orientation import record_of, rotated
from stylobate.motion.request import _reversed
from stylobate.motion.specs import parse_angle
from stylobate.motion.spectra import pseudo_acceleration
from stylobate.simulate import warn_of_north
from stylobate.verdicts.directions import direction_of
from stylobate.verdicts.rocking_spectrum import rocking_block

WAVE = np.sin(np.linspace(0.0, 12.0, 201))


@pytest.fixture
def record(tmp_path):
    path = tmp_path / "two.csv"
    rows = (f"{0.01 * i},{a},{2.0 * a},{0.5 * a}" for i, a in enumerate(WAVE))
    path.write_text("\n".join(["time_s,ax_m_s2,ay_m_s2,az_m_s2", *rows]) + "\n")
    return path


# -- harmonic motions along x and y, and the names of the components -----------------------------------------------------


def test_a_harmonic_across():
    motion = st.harmonic(1.0, 3.0, 2.0, across=(1.0, 1.5, math.pi / 2))
    t = motion.time
    assert motion.acceleration == pytest.approx(3.0 * np.sin(2 * np.pi * t))
    assert motion.lateral == pytest.approx(1.5 * np.cos(2 * np.pi * t))
    assert motion.pga == pytest.approx(3.0)
    finer = st.harmonic(1.0, 3.0, 2.0, across=(4.0, 1.5, 0.0))
    assert finer.steps == 8001  # the faster of the two sines is resolved
    assert finer.lateral == pytest.approx(1.5 * np.sin(8 * np.pi * finer.time))
    only_y = st.harmonic(1.0, 0.0, 2.0, across=(1.0, 1.5, 0.0))
    assert not only_y.acceleration.any()
    assert only_y.lateral == pytest.approx(1.5 * np.sin(2 * np.pi * t))


def test_a_harmonic_along_x_has_the_samples_it_had():
    motion = st.harmonic(0.7, 2.0, 3.0)
    time = np.linspace(0.0, 3.0, 2101)
    assert np.array_equal(motion.samples, np.sin(2.0 * np.pi * 0.7 * time))
    assert (motion.factor, motion.dt, motion.lateral) == (2.0, 3.0 / 2100, None)


def test_components_have_two_names_each():
    a, b, c = WAVE, 2.0 * WAVE, 3.0 * WAVE
    motion = st.Motion(0.01, a, b, c)
    assert st.Motion(0.01, ax=a, ay=b, az=c).digest == motion.digest
    assert st.Motion(0.01, acceleration=a, lateral=b, vertical=c).digest == motion.digest
    assert motion.replace(lateral=None).components.keys() == motion.replace(ay=None).components.keys() == {"x", "z"}
    with pytest.raises(st.InputError, match="given under both of its names"):
        st.Motion(0.01, a, acceleration=a)
    with pytest.raises(st.InputError, match="no horizontal component"):
        st.Motion(0.01, az=c)


def test_a_motion_with_nothing_along_x_is_not_scaled_to_a_peak_there():
    turned = st.MotionRequest(harmonic="1Hz,0.3g,2s", azimuths=(90.0,)).motion()
    assert np.abs(turned.lateral).max() == pytest.approx(0.3 * st.g)
    with pytest.raises(st.InputError, match="zero along x"):
        turned.scaled_to_pga(1.0)


def test_scaling_to_a_peak_along_x_keeps_the_ratio_of_the_components():
    motion = st.Motion(0.01, WAVE, 2.0 * WAVE).scaled_to_pga(3.0)
    assert motion.pga == pytest.approx(3.0)
    assert np.abs(motion.lateral).max() == pytest.approx(6.0)


# -- the request ---------------------------------------------------------------------------------------------------------


def test_a_request_is_a_value():
    request = st.MotionRequest.typed(harmonic="1Hz,0.3g,10s", azimuth="30deg", pga="0.4g")
    other = st.MotionRequest(harmonic="1Hz,0.3g,10s", azimuths=(30.0,), pga=0.4 * st.g)
    assert request == other
    assert hash(request) == hash(other)
    with pytest.raises(dataclasses.FrozenInstanceError):
        request.pga = 1.0
    assert request.motion().digest == other.motion().digest


def test_the_whole_motion_is_turned():
    motion = st.MotionRequest(harmonic="1Hz,0.3g,2s", azimuths=(30.0,)).motion()
    straight = st.harmonic(1.0, 0.3 * st.g, 2.0)
    assert motion.acceleration == pytest.approx(math.cos(math.pi / 6) * straight.acceleration)
    assert motion.lateral == pytest.approx(math.sin(math.pi / 6) * straight.acceleration)


def test_every_record_in_every_direction_with_both_signs(record):
    request = st.MotionRequest(files=(record.parent,), azimuths=(0.0, 90.0, 120.0), signs="both")
    assert request.several
    expansion = request.expand()
    assert [motion.name for motion in expansion.motions] == [
        f"two.csv at {angle}°{sign}" for angle in (0, 90, 120) for sign in ("", " reversed")
    ]
    first, reversed_, turned, *_ = expansion.motions
    assert reversed_.acceleration == pytest.approx(-first.acceleration)
    assert reversed_.lateral == pytest.approx(-first.lateral)
    assert reversed_.vertical == pytest.approx(first.vertical)  # turned by half a turn: the vertical stays upward
    assert turned.acceleration == pytest.approx(-first.lateral, abs=1e-12)
    assert turned.lateral == pytest.approx(first.acceleration, abs=1e-12)
    assert [motion.metadata["azimuths"]["x"] for motion in expansion.motions] == [0.0, 180.0, 90.0, 270.0, 120.0, 300.0]
    assert not st.MotionRequest(files=(record,)).several
    with pytest.raises(st.InputError, match="several motions are asked for"):
        st.MotionRequest(files=(record,), signs="both").motion()


def test_a_record_has_one_size_in_all_directions(record):
    as_recorded = st.MotionRequest(files=(record,), azimuths=(0.0, 30.0, 90.0)).expand().motions
    motions = st.MotionRequest(files=(record,), azimuths=(0.0, 30.0, 90.0), pga=0.5 * st.g).expand().motions
    times = 0.5 * st.g / max(motion.pga for motion in as_recorded)
    assert [motion.factor for motion in motions] == pytest.approx([times * motion.factor for motion in as_recorded])
    assert max(motion.pga for motion in motions) == pytest.approx(0.5 * st.g)
    assert min(motion.pga for motion in motions) < 0.3 * st.g
    assert "the strongest of these directions" in motions[0].processing[-1]


def test_all_components_and_the_strongest(record):
    first, second = st.MotionRequest(files=(record,), component="all").expand().motions
    assert (first.pga, second.pga) == pytest.approx((np.abs(WAVE).max(), 2.0 * np.abs(WAVE).max()), rel=1e-6)
    assert second.lateral == pytest.approx(-first.acceleration, abs=1e-12)  # right-handed
    strongest = st.MotionRequest(files=(record,), component="strongest").motion()
    assert strongest.acceleration == pytest.approx(second.acceleration)
    alone = st.MotionRequest(files=(record,), component="2").motion()
    assert alone.lateral is None
    assert alone.acceleration == pytest.approx(second.acceleration, abs=1e-12)


@pytest.mark.parametrize(("step", "size"), [("pgv=0.5m/s", lambda motion: motion.pgv / 0.5), ("sa=0.5s,0.4g", None)])
def test_a_step_that_scales_keeps_what_directions_of_a_record_are_to_each_other(record, step, size):
    azimuths = (0.0, 30.0, 90.0)
    as_recorded = st.MotionRequest(files=(record,), azimuths=azimuths).expand().motions
    motions = st.MotionRequest(files=(record,), azimuths=azimuths, condition=("demean", step)).expand().motions
    sizes = [size(motion) if size else pseudo_acceleration(motion, [0.5])[0] / (0.4 * st.g) for motion in motions]
    assert max(sizes) == pytest.approx(1.0)
    factors = [motion.factor / before.factor for motion, before in zip(motions, as_recorded, strict=True)]
    assert factors == pytest.approx([factors[0]] * 3)
    assert sum("that of the strongest" in motion.processing[-1] for motion in motions) == 3
    (alone,) = st.MotionRequest(files=(record,), azimuths=azimuths[:1], condition=("demean", step)).expand().motions
    assert alone.factor >= motions[0].factor * (1.0 - 1e-12)


@pytest.mark.parametrize("azimuths", [tuple(np.linspace(0.0, 330.0, 12)), (-90.0, 0.0, 90.0)])
def test_a_circle_of_azimuths_with_both_signs_is_told_to_be_computed_twice(record, azimuths):
    with pytest.warns(st.errors.OutOfRangeWarning, match="a full circle holds both signs; leave `signs='both'` out"):
        st.MotionRequest(files=(record,), azimuths=azimuths, signs="both")
    st.MotionRequest(files=(record,), azimuths=azimuths)
    st.MotionRequest(files=(record,), azimuths=(0.0, 30.0, 60.0, 90.0, 120.0, 150.0), signs="both")


@pytest.mark.parametrize("azimuths", [(), (30.0,)])
def test_the_azimuths_of_a_reversed_motion_are_turned_with_it(azimuths, tmp_path):
    """Written, read back and turned to north, both signs are one motion of the ground; rows tell the direction as before."""
    axes_in_words = pytest.importorskip("stylobate_report.shaking").axes_in_words
    path = tmp_path / "two.csv"
    path.write_text(
        "# azimuth_x_deg: 90\n# azimuth_y_deg: 0\ntime_s,ax_g,ay_g\n0,0.1,0.02\n0.01,-0.3,0.08\n0.02,0.2,-0.1\n"
    )
    first, back = st.MotionRequest(files=(path,), azimuths=azimuths, signs="both").expand().motions
    assert [direction_of(motion)["reversed"] for motion in (first, back)] == [False, True]
    assert len({direction_of(motion)["azimuth_deg"] for motion in (first, back)}) == 1
    north = [rotated(read_motion(write_csv(motion, tmp_path / "a.csv")), 0.0) for motion in (first, back)]
    assert north[1].acceleration == pytest.approx(north[0].acceleration)
    assert north[1].lateral == pytest.approx(north[0].lateral)
    direction = {**direction_of(back), "azimuths": back.metadata["azimuths"], "components": ["x"]}
    assert axes_in_words(direction) == f"x {back.metadata['azimuths']['x']:g}°"
    assert axes_in_words(direction | {"azimuths": {}}) == "x, reversed"
    bare = st.MotionRequest(harmonic="1Hz,0.3g,2s", signs="both").expand().motions[1]
    assert direction_of(bare) == {"azimuth_deg": None, "reversed": True}


@pytest.mark.parametrize("azimuths", [(), (0.0, 45.0)])
@pytest.mark.parametrize("size", [{}, {"pga": 3.0}, {"scale": 0.5}])
def test_both_signs_of_a_record_are_that_record_however_it_is_scaled(record, size, azimuths):
    write_csv(st.read_motion(record).scaled(2.0), record.parent / "other.csv")
    request = st.MotionRequest(files=(record.parent,), azimuths=azimuths, signs="both", **size)
    with pytest.warns(st.errors.OutOfRangeWarning, match="recordings of others once more"):
        motions = request.expand().motions
    assert len(motions) == 4 * max(1, len(azimuths))
    assert {record_of(motion) for motion in motions} == {"two.csv", "other.csv"}


def test_what_cannot_be_used_is_named_with_its_reason(record):
    (record.parent / "alone.csv").write_text("time_s,ax_g\n0,0.1\n0.01,-0.2\n0.02,0.1\n")
    expansion = st.MotionRequest(files=(record.parent,), azimuths=(10.0,)).expand()
    assert [motion.name for motion in expansion.motions] == ["two.csv"]
    assert "one horizontal component" in expansion.refused["alone.csv"]


def test_an_open_amplitude():
    request = st.MotionRequest(harmonic="1Hz,?g,2s", across="1Hz,?g,90deg")
    motion = request.motion(amplitude_open=True)
    assert (motion.pga, np.abs(motion.lateral).max()) == pytest.approx((1.0, 1.0))
    with pytest.raises(st.InputError, match="leaves the amplitude open"):
        request.motion()
    with pytest.raises(st.InputError, match="write \\?g"):
        st.MotionRequest(pulse="ricker,1Hz,1g").motion(amplitude_open=True)
    with pytest.raises(st.InputError, match="write \\?g for both"):
        st.MotionRequest(harmonic="1Hz,?g,2s", across="1Hz,1g,90deg").motion(amplitude_open=True)


def test_a_pulse_of_open_length_leaves_time_to_rock():
    request = st.MotionRequest(pulse="sine,2Hz,0.3g")
    assert request.motion(2.0).duration == pytest.approx(0.5 + 20.0 / 2.0)
    assert st.MotionRequest(pulse="sine,2Hz,0.3g,4s").motion(2.0).duration == pytest.approx(4.0)


@pytest.mark.parametrize(("text", "value"), [("30deg", 30.0), ("-45 °", -45.0), ("1rad", 180.0 / math.pi)])
def test_angles_as_typed(text, value):
    assert parse_angle(text) == pytest.approx(value, rel=1e-15)


# -- what a model takes --------------------------------------------------------------------------------------------------


def test_what_a_plane_model_leaves_out_is_said_in_the_result():
    motion = st.Motion(0.01, 0.1 * WAVE, 2.0 * WAVE, 0.1 * WAVE, name="three")
    column, model = st.preset("paper-monolithic"), st.HousnerBlock()
    with pytest.warns(
        LeftOutWarning, match="left out of 'three': second horizontal component .* housner takes x and z"
    ):
        response = st.simulate(column, motion, model)
    assert response.provenance["left_out"] == ["second horizontal component (peak 0.204 g, more than along x)"]
    assert response.provenance["motion_digest"] == motion.digest  # of what was asked for
    plane = st.simulate(column, keep_axes(motion, "xz"), model)
    assert np.array_equal(plane.top_displacement, response.top_displacement)


def test_every_model_declares_its_axes():
    from stylobate.models.registry import MODELS, model_class

    for name in MODELS:
        assert model_class(name).axes in ("xz", "xyz")


def test_a_model_in_space_is_given_every_component():
    class Spatial(st.HousnerBlock):
        axes = "xyz"

    motion = st.Motion(0.01, WAVE, WAVE, WAVE)
    assert Spatial().taken(motion) is motion
    assert st.HousnerBlock().taken(motion).components.keys() == {"x", "z"}


def test_scaled_copies_are_one_record_however_they_are_named():
    """Twelve copies of one record counted as twelve, and made a fragility without a word."""
    motion = st.ricker(1.0, 2.0)
    copies = [motion.scaled(1.0 + 0.1 * k) for k in range(12)]
    copies += [copies[1].scaled_to_pga(3.0), motion.scaled_to_pga(1.0).scaled(2.0).replace(name="another")]
    assert len({copy.name for copy in copies}) == len(copies)
    assert {record_of(copy) for copy in copies} == {motion.name}
    table = st.suite_table(rocking_block(2.0, 0.2), copies, st.HousnerBlock())
    assert set(table["record"]) == {motion.name}
    assert table["motion"].tolist() == [copy.name for copy in copies]
    with pytest.raises(st.InputError, match="a fragility of 1 record says nothing"):
        st.fragility(st.evidence(table, "pga"))


def test_motions_of_a_suite_are_called_as_they_were_asked_for():
    options = {"harmonic": "1Hz,0.3g,2s", "scale": 2.0}
    (motion,) = st.MotionRequest(**options).expand().motions
    assert record_of(motion) == motion.name
    assert record_of(motion) != record_of(st.MotionRequest(**options).motion())


def test_runs_of_nothing_are_refused():
    block, model = rocking_block(2.0, 0.2), st.HousnerBlock()
    for run in (
        lambda: st.suite_table([], [st.ricker(1.0, 2.0)], model),
        lambda: st.suite_table(block, [], model),
        lambda: st.simulate_many(block, [], model),
    ):
        with pytest.raises(st.InputError, match="give at least one"):
            run()


@pytest.mark.parametrize("azimuths", [(0.0, 90.0, 360.0), (-90.0, 0.0, 270.0), (30.0, 30.0)])
def test_one_direction_twice_is_refused(record, azimuths):
    with pytest.raises(
        st.InputError, match=r"which are one direction; give each direction once, such as 0:330:12"
    ) as refused:
        st.MotionRequest(files=(record,), azimuths=azimuths)
    assert refused.value.field == "azimuths"
    with pytest.raises(st.InputError, match="0° and 360°, which are one direction"):
        st.MotionRequest.typed(motion=[record], azimuths="0:360:13")


def test_several_scales_are_no_scale(record):
    with pytest.raises(st.InputError, match=r"`scale` is \(1, 2\), not a number"):
        st.MotionRequest(files=(record,), scale=(1, 2))  # pyright: ignore[reportArgumentType]


def test_azimuths_are_taken_in_their_order_whatever_is_typed():
    request = st.MotionRequest.typed(harmonic="1Hz,0.3g,2s", azimuths="0,30deg,10")
    assert request.azimuths == (0.0, 10.0, 30.0)


@pytest.mark.parametrize("azimuth", [0.0, 90.0, 180.0, 270.0, -90.0])
@pytest.mark.parametrize("azimuths", [None, {"x": 0.0, "y": 270.0}])
def test_whole_quarters_leave_nothing_across(azimuth, azimuths):
    shaken = np.sin(0.1 * np.arange(200))
    motion = st.Motion(0.01, shaken, np.zeros(200), metadata={} if azimuths is None else {"azimuths": azimuths})
    turned = rotated(motion, azimuth)
    axis = "y" if azimuth % 180.0 else "x"
    other = turned.samples if axis == "y" else turned.y_samples
    assert not other.any()
    assert turned.horizontal_peak == (motion.pga, axis)
    assert f"PGA {motion.pga / st.g:.3g} g along {axis}" in turned.describe()


# -- the axes of a column whose bearing is known -------------------------------------------------------------------------


def test_a_record_that_is_not_in_the_axes_of_a_column_is_warned_of_and_the_advice_works(recwarn):
    column = st.Column.tapered(
        height=2.0, bottom_width=0.5, top_width=0.5, drums=1, density=2000.0, section="circular",
        joint=st.Joint(normal_stiffness=1e9, shear_stiffness=1e9, friction_angle=35.0),
    )  # fmt: skip
    column = dataclasses.replace(column, north=35.0)
    facts = {"azimuths": {"x": 90.0, "y": 0.0}}
    aligned = rotated(st.Motion(0.01, WAVE, WAVE, metadata=facts), 35.0)
    warn_of_north(column, aligned)
    warn_of_north(column, aligned.replace(metadata={"direction": {"azimuth": 10.0}, **facts}))
    assert not recwarn.list
    askew, twin = st.Motion(0.01, WAVE, WAVE, metadata=facts), dataclasses.replace(column, name="twin 1")
    with pytest.warns(st.errors.OutOfRangeWarning, match=r"x of the record points to 90° .* `azimuth=35deg`") as caught:
        any(warn_of_north(structure, askew) for structure in (column, twin))
    assert len({str(warning.message) for warning in caught}) == 1  # the program says the same but once
    mirrored = st.Motion(0.01, WAVE, WAVE, metadata={"azimuths": {"x": 35.0, "y": 125.0}})
    with pytest.warns(st.errors.OutOfRangeWarning, match=r"y to 125°, and x and y of .* to 35° and 305°"):
        warn_of_north(column, mirrored)


def test_what_was_done_to_a_motion_is_a_message():
    """English text in a report in another language, where it was put together from one."""
    both = st.Motion(0.01, WAVE, 0.5 * WAVE)
    done = [*trim(both, 0.2, 0.8).processing, *_reversed(both, "r").processing]
    done += [motion.processing[-1] for motion in conditioned_alike([both, rotated(both, 30.0)], "pgv=0.3m/s")]
    assert [text for text in done if not isinstance(text, Message)] == []
