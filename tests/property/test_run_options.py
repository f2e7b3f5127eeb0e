"""How long a run is followed: every model does what it is asked for, or refuses it."""

import pytest

import stylobate as st
from stylobate.models.registry import MODELS, make_model

PUSHED_OVER = st.harmonic(0.5, 0.5 * st.g, 6.0)


@pytest.mark.parametrize("name", MODELS)
def test_until_end_goes_on_after_a_collapse(name):
    column, model = st.preset("paper-monolithic"), make_model(name)
    first, last = (st.simulate(column, PUSHED_OVER, model, until_end=on).histories for on in (False, True))
    assert last.time[-1] > first.time[-1] + 0.3
    # The column goes on falling to the side to which it fell.
    way = 1.0 if first.drum_rotation[-1, 0] > 0.0 else -1.0
    assert (way * last.drum_rotation[:, 0]).max() > 1.5 * way * first.drum_rotation[-1, 0]


@pytest.mark.parametrize("name", MODELS)
def test_until_rest_is_done_or_refused(name):
    column, model = st.preset("paper-monolithic"), make_model(name)
    if name not in ("dem2d", "dem3d"):
        with pytest.raises(st.InputError, match=f"{name} does not follow how a column comes down; use dem2d or dem3d"):
            st.simulate(column, PUSHED_OVER, model, until_rest=True)
        return
    response = st.simulate(column, PUSHED_OVER, model, until_rest=True)
    assert (response.mechanism or response.measures.blocks).at_rest
    assert response.histories.time[-1] > PUSHED_OVER.duration


@pytest.mark.parametrize(
    ("model", "setting", "words"),
    [
        ("dem2d", {"points": "2.5"}, "parameter points is '2.5'; allowed is a whole number."),
        ("dem2d", {"time_step": "soon"}, "parameter time_step is 'soon'; allowed is a number."),
        ("housner", {"linear": "perhaps"}, "parameter linear is 'perhaps'; allowed is true or false."),
        ("dem2d", {"pionts": "2"}, "dem2d has no parameter 'pionts'; did you mean points? parameters are "),
    ],
)
def test_values_of_set_are_refused_in_one_sentence(model, setting, words):
    with pytest.raises(st.InputError) as error:
        make_model(model, setting)
    assert str(error.value).startswith(words)


def test_values_of_set_have_the_types_of_the_parameters():
    assert make_model("dem2d", {"points": "3", "time_step": "1e-5"}) == st.DistinctElement2D(points=3, time_step=1e-5)
    assert make_model("dem2d", {"time_step": "auto", "start": "settle"}) == st.DistinctElement2D(start="settle")
    for text, value in (("yes", True), ("on", True), ("0", False), ("off", False), ("FALSE", False)):
        assert make_model("housner", {"linear": text}) == st.HousnerBlock(linear=value)
