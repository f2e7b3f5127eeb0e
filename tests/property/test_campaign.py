"""How runs are made is one value: its fields are keywords, options and words of help, checked in one place."""

import dataclasses
import inspect

import pytest

import stylobate as st
from stylobate.cli.main import call
from stylobate.verdicts.compare import compare_domains, compare_steps
from stylobate.verdicts.critical import critical_suite

COLUMN = st.preset("paper-monolithic")
GRID = COLUMN, st.HousnerBlock(), [1.0], [2.0, 4.0], 2.0
#: What functions that take a campaign do not take of it.
SINES = {"replicates", "scatter", "seed", "whole"}
WITHOUT = {
    st.suite_table: set(),
    st.ida: set(),
    st.critical_amplitude: set(),
    critical_suite: set(),
    st.collapse_domain: SINES,
    compare_domains: SINES,
    compare_steps: SINES,
    st.collapse_probability: {"whole"},
    st.compare_states: {"ledger"},
    st.compare_models: {*SINES - {"whole"}, "threads", "dask", "device", "mix_devices"},
    st.certainty: {"whole"},
    st.run_study: {*SINES, "tail", "ledger"},
    st.Study: {"threads", "dask", "device", "mix_devices", "progress", "ledger"},
}
OTHER = {
    "replicates": 3, "scatter": st.Scatter(), "seed": 1, "tail": 1.0, "whole": True, "threads": 1, "dask": "local",
    "device": "gpu", "mix_devices": True, "progress": print, "ledger": "runs.sqlite",
}  # fmt: skip


@pytest.mark.parametrize(("made", "without"), WITHOUT.items(), ids=lambda value: getattr(value, "__name__", ""))
def test_its_fields_are_keywords_but_for_those_that_a_function_does_not_take(made, without):
    needed = [
        None
        for parameter in inspect.signature(made).parameters.values()
        if parameter.default is parameter.empty and parameter.kind is parameter.POSITIONAL_OR_KEYWORD
    ]
    assert "**settings" in (inspect.getdoc(made) or "") or "as in" in (inspect.getdoc(made) or "")
    assert [field.name for field in dataclasses.fields(st.Campaign)] == [*OTHER]
    for name, value in OTHER.items():
        refused = TypeError if name in without else Exception
        with pytest.raises(refused) as caught:
            made(*needed, **{name: value})
        assert (f"{made.__name__}: there is no keyword '{name}'" in str(caught.value)) == (name in without)


def test_a_value_and_keywords_ask_for_the_same():
    by_keywords = st.collapse_domain(*GRID, tail=1.0, threads=1)
    as_value = st.collapse_domain(*GRID, campaign=st.Campaign(threads=1), tail=1.0)
    assert by_keywords.provenance == as_value.provenance
    assert by_keywords.table.equals(as_value.table)


def test_what_is_not_taken_is_refused_by_name():
    with pytest.raises(TypeError, match=r"collapse_domain: .*'replicates'"):
        st.collapse_domain(*GRID, replicates=3)
    with pytest.raises(st.InputError, match="collapse_domain takes no seed; leave it out"):
        st.collapse_domain(*GRID, campaign=st.Campaign(seed=3))
    with pytest.raises(st.InputError, match="campaign is 3; allowed is a Campaign"):
        st.collapse_domain(*GRID, campaign=3)  # pyright: ignore[reportArgumentType]
    with pytest.raises(TypeError, match=r"Study: .*'realisations'"):
        st.Study([COLUMN], [], [], realisations=3)


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"replicates": -1}, "`replicates` is -1; allowed is a whole number from 0 to 100000"),
        ({"replicates": 2.5}, "`replicates` is 2.5; allowed is a whole number"),
        ({"seed": True}, "`seed` is True; allowed is a whole number"),
        (
            {"scatter": "friction=10%"},
            r"`scatter` is 'friction=10%'; allowed is a Scatter, such as Scatter\(friction=0.1\)",
        ),
        ({"tail": -1.0}, r"`tail` is -1 s; allowed is \[0, 10000\] s"),
        ({"whole": "no"}, "`whole` is 'no'; allowed is True or False"),
        ({"ledger": 5}, "ledger is 5; allowed is the path"),
        ({"progress": 5}, "progress is 5; allowed is a function"),
        ({"threads": 0}, r"`threads` is 0; allowed is \[1, 1024\]; leave it out"),
    ],
)
def test_a_number_that_is_not_allowed_is_refused_where_the_value_is_made(fields, words):
    with pytest.raises(st.InputError, match=words):
        st.Campaign(**fields)


@pytest.mark.parametrize(
    ("command", "option"),
    [
        (("domain", "paper-monolithic", "--frequencies=1:2:2", "--amplitudes=0.1g:0.2g:2"), "--whole"),
        (("ida", "paper-monolithic", "sample:el-centro-1940"), "--scale=2"),
        (("run", "paper-monolithic", "--harmonic=1Hz,0.1g,1s"), "--dask=local"),
        (("compare", "paper-monolithic", "--models=housner", "--harmonic=1Hz,0.1g,1s"), "--dask=local"),
        (
            ("compare", "paper-monolithic", "--models=housner", "--frequencies=1:2:2", "--amplitudes=0.1g:0.2g:2"),
            "--whole",
        ),
    ],
)
def test_an_option_that_a_command_ignores_is_not_accepted(capsys, command, option):
    assert call([*command, option]) == 2
    assert option.split("=")[0] in capsys.readouterr().err


def test_a_keyword_that_contradicts_the_campaign_is_refused():
    """The keyword won, and nobody was told."""
    campaign = st.Campaign(tail=3.0, threads=1)
    with pytest.raises(
        st.InputError, match=r"`tail` is 1.0, and 3.0 in the campaign; give it in one of the two"
    ) as refused:
        st.collapse_domain(*GRID, campaign=campaign, tail=1.0)
    assert refused.value.field == "tail"
    same = st.collapse_domain(*GRID, campaign=campaign, tail=3.0)
    assert same.provenance["tail"] == 3.0
