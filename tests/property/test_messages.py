"""Messages are English texts everywhere, and keep their templates and values on every way that results take."""

import copy
import json
import pickle

import pytest

from stylobate.cli.console import in_options, write_json
from stylobate.errors import InputError
from stylobate.messages import Message, digits, joined, messages_in, restored, say
from stylobate.results.command_request import read_json

MESSAGE = say("{n} drums are shifted by up to {far}.", n=2, far=say("{value:.3g} mm", value=12.3456))


def test_a_message_is_its_english_text():
    assert MESSAGE == "2 drums are shifted by up to 12.3 mm."
    assert str(MESSAGE) is MESSAGE
    assert f"{MESSAGE}" == MESSAGE
    assert json.dumps([MESSAGE]) == '["2 drums are shifted by up to 12.3 mm."]'
    assert say("100 % {literal}") == "100 % {literal}"
    assert f"{say('the column'):capital}" == "The column"


def test_fields_reach_into_values_and_only_what_they_find_is_kept():
    message = say("{z.real:.1f} of {d[runs]}", z=1.25 + 0j, d={"runs": 4, "other": object()})
    assert message == "1.2 of 4"
    assert message.values == {"z.real": 1.25, "d[runs]": 4}


def test_texts_of_several_keep_their_parts():
    text = joined(" ", [MESSAGE, "", say("It stands.") + " Or not.", digits(0.5, ".2f") * True, digits(1.0) * False])
    assert text == f"{MESSAGE} It stands. Or not. 0.50"
    assert isinstance(text, Message)
    assert [part for part in text.parts if isinstance(part, Message)] == [MESSAGE, "It stands.", "0.50"]
    assert joined(", ", ["a", "b"]) == "a, b"
    assert not isinstance(joined(", ", ["a", "b"]), Message)


@pytest.mark.parametrize("way", [copy.deepcopy, lambda message: pickle.loads(pickle.dumps(message))])
def test_copies_are_messages(way):
    assert way(MESSAGE).template == MESSAGE.template
    assert way(MESSAGE).values["far"].values == {"value": 12.3456}


def test_a_file_holds_what_its_messages_are_made_of(tmp_path):
    result = {"sentence": MESSAGE, "rows": [{"advice": joined(" ", [MESSAGE, "Yes."])}], "runs": 3}
    write_json(tmp_path / "run.json", result)
    plain = json.loads((tmp_path / "run.json").read_text())
    assert {key: plain[key] for key in result} == result
    content = read_json(tmp_path / "run.json")
    assert content == result
    assert content["sentence"].template == MESSAGE.template
    assert content["rows"][0]["advice"].parts[0].values["n"] == 2


def test_what_somebody_changed_in_a_file_is_his_text(tmp_path):
    write_json(tmp_path / "run.json", {"sentence": MESSAGE})
    content = json.loads((tmp_path / "run.json").read_text()) | {"sentence": "It stands, I say."}
    (tmp_path / "run.json").write_text(json.dumps(content))
    sentence = read_json(tmp_path / "run.json")["sentence"]
    assert sentence == "It stands, I say."
    assert not isinstance(sentence, Message)


@pytest.mark.parametrize(
    "bad", [{"/sentence": 3}, {"/sentence": {}}, {"/sentence": {"template": "{a:999999999}"}}, [1], "x"]
)
def test_messages_as_nobody_writes_them_are_refused_in_one_sentence(tmp_path, bad):
    (tmp_path / "run.json").write_text(json.dumps({"sentence": "x", "messages": bad}))
    try:
        assert read_json(tmp_path / "run.json") == {"sentence": "x"}
    except InputError as error:
        assert "run again" in str(error)  # noqa: PT017  either is right: no message of theirs, no traceback


def test_names_of_options_are_values_not_templates():
    message = say("take it off ({step}) unless it is meant.", step="`condition='demean'`")
    wording = in_options(message)
    assert wording == "take it off (--condition demean) unless it is meant."
    assert wording.template == message.template
    assert restored({"a": str(wording)}, messages_in({"a": wording}))["a"].values == {"step": "--condition demean"}
