"""What the add-on says in other languages: every text of it, and no other."""

import ast
import string
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from conftest import ROOT
from test_operator import addon

ADDON = ROOT / "addon"
# What marks a text, or looks it up: which of its arguments are texts.
CALLS = {"n_": 1, "rpt_": 1, "iface_": 1, "tip_": 1}
# Made of values alone, of names that are the same in every language.
SAME = {"X", "Y", "Z", "Orbflow", "{:.0f}°"}
# Properties that no artist sees.
HIDDEN = {"HIDDEN"}


def sources() -> list[Path]:
    return [path for path in ADDON.rglob("*.py") if path.parent.name != "translations"]


def is_a(node: Any, *kinds: str) -> bool:  # noqa: ANN401
    return type(node).__name__ in kinds


def walked(node: Any) -> Iterator[Any]:  # noqa: ANN401
    yield from ast.walk(node)


def nodes(path: Path) -> Iterator[Any]:
    return walked(ast.parse(path.read_text()))


def marked(path: Path) -> Iterator[str]:
    """The texts of a file that are looked up at run time."""
    for node in nodes(path):
        if is_a(node, "Call") and is_a(node.func, "Name"):
            for each in node.args[: CALLS.get(node.func.id, 0)]:
                yield from (
                    leaf.value
                    for leaf in walked(each)
                    if is_a(leaf, "Constant") and isinstance(leaf.value, str)
                    if not is_a(each, "Call", "Subscript")
                )


def keyword(node: Any, name: str) -> Any:  # noqa: ANN401
    return next((each.value for each in node.keywords if each.arg == name), None)


def declared(path: Path) -> Iterator[str]:
    """The names and descriptions of properties, of what can be chosen, and of classes."""
    for node in nodes(path):
        if is_a(node, "Call"):
            called = getattr(node.func, "id", getattr(node.func, "attr", ""))
            options = keyword(node, "options")
            is_hidden = options is not None and bool(HIDDEN & ast.literal_eval(options))
            if called.endswith("Property") and not is_hidden:
                found = (keyword(node, name) for name in ("name", "description"))
                yield from (each.value for each in found if is_a(each, "Constant"))
            if called == "_share":
                yield from (each.value for each in node.args if is_a(each, "Constant"))
        if is_a(node, "ClassDef"):
            yield from of_class(node)
        is_choices = is_a(node, "Assign") and is_a(node.value, "Tuple")
        if is_choices and (
            path.name == "choices.py" or getattr(node.targets[0], "id", "") == "_METHODS"
        ):
            for each in ast.literal_eval(node.value):
                yield from each[1:]


def of_class(node: Any) -> Iterator[str]:  # noqa: ANN401
    """What Blender shows of a class: an operator's docstring is its tooltip."""
    for each in node.body:
        if is_a(each, "Assign") and each.targets[0].id in {"bl_label", "bl_description"}:
            yield ast.literal_eval(each.value)
    if "_OT_" in node.name and (told := ast.get_docstring(node)):
        yield told


def texts() -> set[str]:
    found = {text for path in sources() for text in (*marked(path), *declared(path))}
    return {text for text in found if text} - SAME


def languages() -> dict[str, dict[str, str]]:
    return addon("translations").LANGUAGES


@pytest.mark.usefixtures("open_fixture")
@pytest.mark.parametrize("language", ["de", "fr"])
def test_every_text_has_a_translation_and_none_is_left_over(language: str) -> None:
    words, wanted = languages()[language], texts()
    assert len(wanted) > 250
    assert sorted(wanted - words.keys()) == []
    assert sorted(words.keys() - wanted) == []
    assert [text for text, told in words.items() if not told.strip()] == []


def fields(text: str) -> list[tuple[str, str]]:
    parsed = string.Formatter().parse(text)
    return [(name, form or "") for _, name, form, _ in parsed if name is not None]


@pytest.mark.usefixtures("open_fixture")
@pytest.mark.parametrize("language", ["de", "fr"])
def test_a_translation_has_the_places_for_values_of_its_text(language: str) -> None:
    words = languages()[language]
    assert sum(bool(fields(text)) for text in words) > 50
    assert [text for text, told in words.items() if fields(text) != fields(told)] == []


def test_no_sentence_is_made_past_the_translations() -> None:
    past = []
    for path in sources():
        for node in nodes(path):
            if is_a(node, "Call"):
                called = getattr(node.func, "id", getattr(node.func, "attr", ""))
                said = node.args[-1:] if called in {"report", "poll_message_set"} else []
                if called in {"Refused", "Gone", "NoHalf", "NoRegion", "NoGuides", "NoSuchName"}:
                    said = node.args[:1]
                past += [
                    f"{path.name}:{node.lineno}"
                    for each in said
                    if is_a(each, "Constant", "JoinedStr")
                ]
    assert past == []


@pytest.mark.usefixtures("open_fixture")
@pytest.mark.parametrize("language", ["de", "fr"])
def test_names_of_settings_are_short_enough_for_the_sidebar(language: str) -> None:
    words, settings = languages()[language], addon("settings")
    names = {
        each.name or "": each.type == "BOOLEAN"
        for each in settings.OrbflowSettings.bl_rna.properties
        if each.identifier in settings.OrbflowSettings.__annotations__
        or each.identifier in settings.NAMES
    }
    assert len(names) > 25
    # Beside its box a name has more room than before its field.
    told = {words.get(name, name): is_box for name, is_box in names.items()}
    assert [name for name, is_box in told.items() if len(name) > (19 if is_box else 16)] == []
    assert [name for name, is_box in names.items() if len(name) > (19 if is_box else 18)] == []
