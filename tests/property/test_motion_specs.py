"""What a person types for a motion: understood, or refused with the way to write it."""

import contextlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stylobate.constants import g
from stylobate.errors import InputError
from stylobate.motion import parse_acceleration, parse_frequency, parse_harmonic, parse_pulse, parse_time
from stylobate.motion.specs import PULSES


@pytest.mark.parametrize(
    ("text", "value"),
    [("0.3g", 0.3 * g), ("0.3 g", 0.3 * g), ("2.5m/s2", 2.5), ("2.5 m/s²", 2.5), ("300gal", 3.0), ("1e3 mm/s2", 1.0)],
)
def test_accelerations(text, value):
    assert parse_acceleration(text) == pytest.approx(value, rel=1e-15)


def test_times_and_frequencies():
    assert parse_time("5s") == 5.0
    assert parse_time("20 ms") == pytest.approx(0.02)
    assert parse_frequency("1.5 Hz") == 1.5


@pytest.mark.parametrize("text", ["", "0.3", "g", "0.3s", "0.3 lb", "?g", "0.3g,1", "nan g", "0.3g g", "--3g"])
def test_accelerations_that_are_refused(text):
    with pytest.raises(InputError, match=r"0\.3g"):
        parse_acceleration(text)


def test_a_number_beyond_all_numbers_is_refused():
    with pytest.raises(InputError, match="finite"):
        parse_acceleration("1e999g")


def test_harmonic():
    motion = parse_harmonic("1.0Hz,0.3g,10s")
    assert (motion.duration, motion.factor) == (10.0, 0.3 * g)
    assert parse_harmonic("2Hz , 1m/s2").duration == 10.0
    motion, unknown = parse_harmonic("1.0Hz,?g,10s", allow_unknown=True)
    assert (motion.factor, unknown) == (1.0, True)
    assert parse_harmonic("1.0Hz,0.1g", allow_unknown=True)[1] is False


@pytest.mark.parametrize("kind", sorted(PULSES))
def test_pulses(kind):
    motion = parse_pulse(f"{kind},2.0Hz,0.3g,10s")
    assert motion.factor == 0.3 * g
    assert motion.duration == pytest.approx(10.0, abs=1e-3)
    assert parse_pulse(f"{kind},2.0Hz,0.3g", 7.0).duration == pytest.approx(7.0, abs=1e-3)
    alone = parse_pulse(f"{kind},2.0Hz,0.3g", 0.01)
    assert alone.duration == pytest.approx(alone.metadata["pulse_length"])
    assert parse_pulse(f"{kind},2.0Hz,?g", allow_unknown=True)[1] is True


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("1.0Hz,?g", "leaves the amplitude open"),
        ("1.0,0.3g", "has no unit"),
        ("1.0Hz", "no acceleration"),
        ("0.3g", "no frequency"),
        ("1Hz,2Hz,0.3g", "two values"),
        ("1Hz,0.3g,0s", "duration"),
        ("1Hz,0.3parsec", "unknown"),
    ],
)
def test_harmonics_that_are_refused(text, message):
    with pytest.raises(InputError, match=message):
        parse_harmonic(text)


def test_a_misspelt_kind_is_answered_with_the_right_one():
    with pytest.raises(InputError, match="did you mean ricker"):
        parse_pulse("riker,1Hz,0.3g")


@pytest.mark.parametrize("kind", sorted(PULSES))
@pytest.mark.parametrize("rest", ["1Hz", "0.3g", "1.0,0.3g", "1Hz,0.3parsec", "1Hz,0.3g,30deg", "1Hz,2Hz,0.3g"])
def test_a_bad_pulse_is_answered_with_an_example_of_its_own_kind(kind, rest):
    with pytest.raises(InputError, match=f"as '{kind},1.0Hz,0.3g'"):
        parse_pulse(f"{kind},{rest}")


@given(st.text(max_size=40))
def test_any_text_is_understood_or_refused(text):
    for parse in (parse_acceleration, parse_time, parse_frequency):
        with contextlib.suppress(InputError):
            parse(text)


@given(st.text(alphabet="0123456789.,?HhzZgGsm/-+eE ricker", max_size=24))
def test_any_specification_is_understood_or_refused(text):
    for parse in (parse_harmonic, parse_pulse):
        with contextlib.suppress(InputError):
            parse(text)
