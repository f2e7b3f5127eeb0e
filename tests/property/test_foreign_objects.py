"""A wrong object, a class or None in place of what is wanted ends in one sentence: parameter, what came, what is allowed."""

from pathlib import Path

import pandas
import pytest

import stylobate as st
from stylobate import store
from stylobate.errors import InputError
from stylobate.motion.readers import Suite

COLUMN, M = st.preset("paper-monolithic"), st.DistinctElement2D()
MOTION = st.harmonic(1.0, 0.1 * st.g, 0.5)
JOINT, DRUM = COLUMN.joints[0], COLUMN.drums[0]
STUDY = {"models": [M], "levels": [1.0]}
STONE = st.Stone.box((1.0, 1.0, 1.0), (0.0, 0.0, 0.0), 2500.0)
TAPER = {"height": 2.0, "bottom_width": 1.0, "top_width": 0.8, "drums": 2, "density": 2500.0}

WRONG = {
    "column": lambda: st.simulate(None, MOTION, M),
    "motion": lambda: st.simulate(COLUMN, None, M),
    "motion list": lambda: st.simulate(COLUMN, [MOTION], M),
    "motion file": lambda: st.simulate(COLUMN, "file", M),
    "model": lambda: st.simulate(COLUMN, MOTION, "dem2d"),
    "model class": lambda: st.simulate(COLUMN, MOTION, st.DistinctElement2D),
    "twins": lambda: st.simulate(COLUMN, MOTION, M, twins=3),
    "progress": lambda: st.simulate(COLUMN, MOTION, M, progress=3),
    "start": lambda: st.simulate(COLUMN, MOTION, M, start="x"),
    "motions": lambda: st.simulate_many(COLUMN, None, M),
    "number 2 of motions": lambda: st.simulate_many(COLUMN, [MOTION, None], M),
    "model of many": lambda: st.simulate_many(COLUMN, [MOTION], None),
    "column of many": lambda: st.simulate_many("column", [MOTION], M),
    "columns": lambda: st.suite_table(None, [MOTION], M),
    "model of suite": lambda: st.suite_table(COLUMN, [MOTION], None),
    "study columns": lambda: st.Study(["c"], [MOTION], **STUDY),
    "study models": lambda: st.Study([COLUMN], [MOTION], [st.DistinctElement2D]),
    "study levels": lambda: st.Study([COLUMN], [MOTION], [M], "a"),
    "study": lambda: st.run_study(None),
    "out": lambda: st.run_study(st.Study([COLUMN], [MOTION], [M]), 3),
    "ida column": lambda: st.ida(None, [MOTION], M),
    "ida columns": lambda: st.ida([COLUMN, COLUMN], [MOTION], M),
    "im": lambda: st.ida(COLUMN, [MOTION], M, None),
    "im number": lambda: st.ida(COLUMN, [MOTION], M, 3),
    "levels": lambda: st.ida(COLUMN, [MOTION], M, levels="a"),
    "number 1 of levels": lambda: st.ida(COLUMN, [MOTION], M, levels=["a"]),
    "about": lambda: st.ida(COLUMN, [MOTION], M, about=3),
    "states": lambda: st.compare_states([COLUMN, COLUMN], [MOTION], M),
    "state b": lambda: st.compare_states({"a": COLUMN, "b": 3}, [MOTION], M),
    "state levels": lambda: st.compare_states({"a": COLUMN, "b": COLUMN}, [MOTION], M, 2, out=3),
    "table": lambda: st.evidence(None),
    "table file": lambda: st.evidence("T.csv"),
    "measure": lambda: st.evidence(pandas.DataFrame({"record": ["a"]}), 3),
    "state": lambda: st.evidence(pandas.DataFrame({"record": ["a"]}), state=None),
    "evidence": lambda: st.fragility(None),
    "fragility": lambda: st.risk(None, None),
    "survival": lambda: st.survival(None, 100.0, []),
    "compared models": lambda: st.compare_models(COLUMN, MOTION, "dem2d"),
    "compared motion": lambda: st.compare_models(COLUMN, None, [M]),
    "domain": lambda: st.collapse_domain(None, M, [1.0], [1.0]),
    "critical": lambda: st.critical_amplitude(COLUMN, None, M, 1.0, 2.0),
    "limit": lambda: st.limit_analysis(None),
    "pushover": lambda: st.pushover("column"),
    "directions": lambda: st.limit_directions(None),
    "spectrum": lambda: st.rocking_spectrum(None),
    "certainty": lambda: st.certainty(None, MOTION, M, replicates=3),
    "stones": lambda: st.SpatialAssembly(None, JOINT),
    "number 1 of stones": lambda: st.SpatialAssembly([DRUM], JOINT),
    "joint of stones": lambda: st.SpatialAssembly([STONE], None),
    "name of stones": lambda: st.SpatialAssembly([STONE], JOINT, name=3),
    "settle": lambda: st.SpatialAssembly([STONE], JOINT, settle="yes"),
    "links of stones": lambda: st.SpatialAssembly([STONE], JOINT, links=None),
    "overrides of stones": lambda: st.SpatialAssembly([STONE], JOINT, overrides=None),
    "override of stones": lambda: st.SpatialAssembly([STONE], JOINT, overrides=[("a", "b")]),
    "law of an override": lambda: st.SpatialAssembly([STONE], JOINT, overrides=[("a", "b", 35.0)]),
    "blocks": lambda: st.Assembly(None, JOINT),
    "joint of blocks": lambda: st.Assembly([st.Block([(0, 0), (1, 0), (1, 1)], 2500.0)], "stiff"),
    "parts": lambda: st.Stone(None, (0.0, 0.0, 0.0)),
    "number 1 of parts": lambda: st.Stone(["box"], (0.0, 0.0, 0.0)),
    "name of a stone": lambda: st.Stone.box((1, 1, 1), (0, 0, 0), 2500.0, name=None),
    "surface": lambda: st.Stone.box((1, 1, 1), (0, 0, 0), 2500.0, surface="rough"),
    "fixed": lambda: st.Stone.box((1, 1, 1), (0, 0, 0), 2500.0, fixed="yes"),
    "hull": lambda: st.Stone.hull("corners", 2500.0),
    "domain of stones": lambda: st.collapse_domain(st.SpatialAssembly([STONE], JOINT), M, [1.0], [1.0]),
    "drums": lambda: st.Column(["drum"], [JOINT]),
    "no drums": lambda: st.Column(None, None),
    "joint": lambda: st.Column.of_drums([DRUM], None),
    "joints": lambda: st.Column.of_drums([DRUM], [JOINT]),
    "drum": lambda: st.Column.of_drums(3, JOINT),
    "overrides": lambda: st.Column.of_drums([DRUM], JOINT, overrides=[JOINT]),
    "override": lambda: st.Column.of_drums([DRUM], JOINT, overrides={1: None}),
    "tapered": lambda: st.Column.tapered(**TAPER, joint=None),
    "links class": lambda: COLUMN.replace(links=st.Dowel),
    "links": lambda: COLUMN.replace(links=None),
    "as found": lambda: COLUMN.replace(as_found=None),
    "path": lambda: st.read_motion(None),
    "unit": lambda: st.read_motion("sample:el-centro-1940", unit=9.81),
    "source": lambda: st.read_suite(None),
    "sources": lambda: st.read_suite([1, 2]),
    "dt": lambda: st.read_motion("sample:el-centro-1940", dt="a"),
    "saved": lambda: store.save(None, "domain", None),
    "column file": lambda: st.read_column(None),
    "azimuths": lambda: st.MotionRequest(synthetic="greece,6Mw,10km", azimuths="all"),
    "scale": lambda: st.MotionRequest(synthetic="greece,6Mw,10km", scale=None, pga="a"),
}  # fmt: skip


@pytest.mark.parametrize("call", WRONG.values(), ids=WRONG)
def test_wrong_objects_are_refused_in_one_sentence(call):
    with pytest.raises(InputError, match=r"^.* is .*; allowed is .*\.$") as caught:
        call()
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 250


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (WRONG["model class"], "model is the class DistinctElement2D; allowed is a model, such as DistinctElement2D(); "
         "write DistinctElement2D() with brackets."),
        (WRONG["model"], "model is 'dem2d'; allowed is a model, such as DistinctElement2D()."),
        (WRONG["column"], "column is None; allowed is a Column, Specimen or Assembly."),
        (WRONG["links class"], "links is the class Dowel; allowed is a list, each a Dowel, Bar, Tie, Core, Layer or Pad."),
        (WRONG["progress"], "progress is 3; allowed is a function."),
        (WRONG["drums"], "number 1 of drums is 'drum'; allowed is a Drum."),
        (lambda: st.Column.of_drums([DRUM], JOINT, overrides={7: JOINT}),
         "override index is 7; allowed is a whole number from 1 to 1; 1 is at the base."),
        (lambda: st.read_suite([]), "source is an empty list; give a folder of records, or a list of files."),
        (lambda: st.ida(COLUMN, [MOTION], M, levels=[-1.0]),
         "one of the levels is -1; allowed is (0, 1e+06]."),
        (lambda: st.MotionRequest(synthetic="greece,6Mw,10km", scale="a"),
         "`scale` is 'a', not a number; allowed is [-1e+06, 1e+06]."),
        (lambda: st.suite_table(COLUMN, MOTION, st.HousnerBlock(), ledger="no folder/x"),
         "no folder/x cannot keep the progress: it is a folder, or has none; choose another folder."),
        (lambda: MOTION.scaled("a"), "factor is 'a', not a number; allowed is [-1e+06, 1e+06]."),
        (lambda: st.ida(COLUMN, [MOTION], M, runs=0), "runs is 0; allowed is [4, 1000]."),
    ],
)  # fmt: skip
def test_the_sentence_says_parameter_value_and_what_is_allowed(call, sentence):
    with pytest.raises(InputError) as caught:
        call()
    assert str(caught.value) == sentence


def test_one_is_a_list_of_one_and_a_suite_a_list_of_its_motions():
    suite = Suite((MOTION, MOTION.scaled(0.5)), {})
    assert len(suite) == 2
    assert list(suite) == list(suite.motions)
    assert len(st.simulate_many(COLUMN, suite, st.HousnerBlock())) == 2
    assert len(st.simulate_many(COLUMN, MOTION, st.HousnerBlock())) == 1
    assert len(st.suite_table(COLUMN, suite, st.HousnerBlock())) == 2
    assert st.Study(COLUMN, suite, M, 1.0).shape == (1, 1, 2, 1, 1)
    assert st.Column(DRUM, JOINT) == st.Column([DRUM], [JOINT])
    assert st.MotionRequest(synthetic="greece,6Mw,10km", azimuths=30).azimuths == (30,)
    assert st.MotionRequest(files="a.AT2").files == ("a.AT2",)
    assert not st.MotionRequest(files=Path("a.AT2")).several


def test_fields_that_there_are_not_are_told_with_those_that_there_are():
    with pytest.raises(
        TypeError,
        match=r"a joint has no field 'frictn'; did you mean friction_angle. it has normal_stiffness, .*ring_width",
    ):
        COLUMN.with_joint(frictn=0.5)
    with pytest.raises(TypeError, match=r"a column has no field 'link'; did you mean links. it has drums"):
        COLUMN.replace(link=())


def test_pictures_refuse_what_they_do_not_draw():
    for draw in (st.plots.draw_fragility, st.plots.draw_domain, st.plots.draw_motion, st.plots.draw_boundaries):
        with pytest.raises(InputError, match=r"^\w+ is None; allowed is a "):
            draw(None)
