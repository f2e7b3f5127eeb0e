"""The paper's sentences that need no time history, the table in the documentation, and the choices that are stated."""

import dataclasses
import re
from pathlib import Path

import numpy as np
import pytest

from stylobate.column import preset
from stylobate.constants import g
from stylobate.models.rigid_beam.model import RigidBeam
from stylobate_studies.paper.cases import (
    AMPLITUDES,
    FREQUENCIES,
    MODELS,
    MONOLITH,
    VARIANTS,
    Grids,
    paper_column,
)
from stylobate_studies.paper.equations import equation_statements
from stylobate_studies.paper.sentences import FAILS, HOLDS, PARTLY, Statement, Verdict, judged
from stylobate_studies.paper.statements import markdown_row, order
from stylobate_studies.paper.statics import joint_law, static_statements, static_values

TABLE = Path(__file__).parents[2] / "docs" / "evidence" / "paper_statements.md"


@pytest.fixture(scope="module")
def static():
    return static_statements()


def test_numbers_of_the_paper_that_need_no_time_history(static):
    """Section 3: 0.205 g for both columns; the shape explains the rigid beam's 0.16 g."""
    assert [row.verdict.kind for row in static] == [PARTLY] + [HOLDS] * 5
    values = static_values()
    assert values["prism"] == pytest.approx(0.81 / 5.0, rel=1e-6)
    for name in ("paper-monolithic", "paper-12-drums"):
        assert values[f"limit, {name}, rectangular"] == pytest.approx(0.2046, abs=5e-5)
        assert values[f"limit, {name}, circular"] == pytest.approx(0.2187, abs=5e-5)
        assert values[f"pushover, {name}, rectangular"] == pytest.approx(0.2046, abs=5e-4)


def test_the_table_in_the_documentation_has_them_as_they_are_now(static):
    lines = TABLE.read_text(encoding="utf-8").splitlines()
    for row in static:
        assert markdown_row(row) in lines, f"docs/evidence/paper_statements.md is out of date: {row.sentence}"


def test_equations_are_what_the_models_carry_out():
    """Equations 1 to 8 and Fig. 3: every row of theirs holds, Eq. 2 with the accelerations that are meant."""
    rows = equation_statements()
    kinds = {row.section: row.verdict for row in rows}
    assert [section for section, verdict in kinds.items() if verdict.kind != HOLDS] == ["2.1 ¶3, Eq. 2"]
    assert kinds["2.1 ¶3, Eq. 2"].kind == PARTLY
    assert kinds["2.1 ¶3, Eq. 2"].part.startswith("with ü")


def test_every_equation_and_figure_of_the_paper_has_a_row_in_its_order():
    """Eqs. 1 to 8 and Figs. 1 to 9; rows in the order of sections and paragraphs."""
    places = [line.split(" | ")[0].removeprefix("| ") for line in TABLE.read_text(encoding="utf-8").splitlines()[14:]]
    assert len(places) > 60
    for kind, number in (("Eq", 8), ("Fig", 9)):
        named = " ".join(re.findall(rf"{kind}s?\. ([\d, ]+)", "; ".join(places)))
        assert set(map(int, re.findall(r"\d+", named))) >= set(range(1, number + 1))
    ordered = [order(place.removeprefix("§")) for place in places]
    assert ordered == sorted(ordered)


def test_the_thirty_cases_are_in_the_paper_s_range():
    assert FREQUENCIES.size * AMPLITUDES.size == 30
    assert (FREQUENCIES[0], FREQUENCIES[-1]) == (0.66, 4.0)
    np.testing.assert_allclose(AMPLITUDES / g, [0.1, 0.2, 0.3, 0.4, 0.5])


def test_every_variant_changes_something_of_a_model_of_the_study():
    seen = set()
    for label, model, change, duration in VARIANTS.values():
        assert label in MODELS
        seen.add((label, str(model), str(change), duration))
    assert len(seen) == len(VARIANTS)
    for quick in (True, False):
        assert set(Grids.of(quick).variants) <= set(VARIANTS)


def test_figure_3_is_what_the_paper_draws():
    """Eq. 6 and Fig. 3: K_M φ, then ξ M_u, then M_u (1 − φ/α)."""
    column = preset(MONOLITH)
    seen = column.as_prism()
    ultimate, alpha = 0.5 * seen.joint_weights[0] * seen.joint_widths[0], np.arctan(0.81 / 5.0)
    stiffness = 5e10 * seen.joint_second_moments[0]
    phi = np.array([-0.1, -1e-6, 1e-6, 0.01, 0.1, 1.2 * alpha])
    lines = np.minimum(stiffness * abs(phi), ultimate * np.minimum(0.7, 1.0 - abs(phi) / alpha)) * np.sign(phi)
    moments = joint_law(RigidBeam.paper(moment_law="trilinear", xi=0.7), column, 1, phi)
    np.testing.assert_allclose(moments, lines, rtol=1e-12)
    rigid = joint_law(RigidBeam.paper(moment_law="housner"), column, 1, phi[3:])
    np.testing.assert_allclose(rigid, ultimate * (1.0 - phi[3:] / alpha), rtol=1e-12)


def test_circular_columns_keep_their_widths_as_diameters():
    column = paper_column("paper-12-drums", "circular")
    assert column.section == "circular"
    np.testing.assert_array_equal(column.joint_widths, preset("paper-12-drums").joint_widths)


def test_a_row_of_the_table_survives_its_own_marks():
    row = Statement("3", "a | b", "c", Verdict(FAILS), "d")
    assert markdown_row(row) == "| §3 | a \\| b | c | **does not hold** | d |  |"
    assert dataclasses.asdict(row)["sensitivity"] == ""


def test_a_verdict_names_the_part_for_which_a_sentence_holds():
    assert judged(True, {"drums": False}) == Verdict(HOLDS)
    assert judged(False, {"drums": False}) == judged(False) == Verdict(FAILS)
    assert str(judged(False, {"monolith": True, "drums": False})) == f"{PARTLY}: monolith; not drums"
    many = judged(False, {f"variant {i}": i > 3 for i in range(9)})
    assert str(many) == f"{PARTLY}: 5 of 9, not variant 0; not variant 1; not variant 2; not variant 3"
    few = judged(False, {f"variant {i}": i < 2 for i in range(9)})
    assert str(few) == f"{PARTLY}: 2 of 9, variant 0; variant 1"
