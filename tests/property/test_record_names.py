"""Names of records that hold what a file may mean otherwise."""

from stylobate.probability.evidence import evidence, read_table


def test_a_name_with_a_number_sign_is_not_cut(tmp_path):
    table = tmp_path / "runs.csv"
    table.write_text("# by hand\nrecord,im,collapsed\nathens#1.csv,0.1,false\n#2.csv,0.2,true\n")
    read = read_table(table)
    assert list(read["record"]) == ["athens#1.csv", "#2.csv"]
    assert list(evidence(read).im) == [0.1, 0.2]
