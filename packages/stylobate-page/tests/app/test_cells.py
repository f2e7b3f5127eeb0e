"""Cells of a domain while it is computed: the page reads along in the ledger of the command."""

import numpy as np

import stylobate as st
from stylobate_page.curves import new_cells
from stylobate_page.job_request import RESULT, STUDY

DOMAIN = """
column = "paper-monolithic"
model = "housner"
frequencies = [1.0, 2.0]
amplitudes = ["0.2g", "0.3g", "0.5g"]
duration = 2.0
"""


def test_cells_of_the_ledger_are_those_of_the_table_and_none_comes_twice(tmp_path):
    (tmp_path / STUDY).write_text(DOMAIN)
    out, grid = tmp_path / RESULT, (np.array([1.0, 2.0]), np.array([0.2, 0.3, 0.5]) * st.g, 2.0)
    out.mkdir()
    assert new_cells(tmp_path, set()) == []
    st.critical_amplitude(
        st.preset("paper-monolithic"),
        st.harmonic(1.0, 1.0, 2.0),
        st.HousnerBlock(),
        1.0,
        5.0,
        1.0,
        ledger=out / "runs.sqlite",
    )  # what else is in the ledger is no cell
    st.collapse_domain(st.preset("paper-monolithic"), st.HousnerBlock(), *grid, out=out)
    of_the_table = new_cells(tmp_path, set())
    assert [cell[0] for cell in of_the_table] == list(range(6))
    (out / "domain.csv").unlink()
    known = {2, 3}
    of_the_ledger = new_cells(tmp_path, known)
    assert sorted(of_the_ledger) == [cell for cell in of_the_table if cell[0] not in (2, 3)]
    assert known == set(range(6))
    assert new_cells(tmp_path, known) == []
