"""Many files on Dask: told one by one, tried again, gone on with, none lost with a worker."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from orbflow_native import folder
from orbflow_native.folder import FolderError, Outcome, Task

# Stands for the program: what it does is written in the file that it is given.
_PROGRAM = """#!{python}
import json, os, pathlib, signal, sys
_, verb, source, target, _, report, *options = sys.argv
assert verb == "remesh"
text = pathlib.Path(source).read_text()
with open(source + ".tries", "a") as tries:
    tries.write("x")
n_tries = len(pathlib.Path(source + ".tries").read_text())
if "cannot" in text:
    print("it has no faces", file=sys.stderr)
    sys.exit(3)
if "fails once" in text and n_tries == 1:
    sys.exit(101)
if "always fails" in text:
    sys.exit(101)
if "kills its worker once" in text and n_tries == 1:
    os.kill(os.getppid(), signal.SIGKILL)
    sys.exit(101)
pathlib.Path(target).write_text(text + " ".join(options))
pathlib.Path(report).write_text(json.dumps({{"output": {{"n_faces": 1234}}}}))
"""


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "orbflow"
    path.write_text(_PROGRAM.format(python=sys.executable))
    path.chmod(0o755)
    return path


def meshes(tmp_path: Path, **texts: str) -> Path:
    """A folder with files of these names and texts."""
    source = tmp_path / "in"
    for name, text in texts.items():
        path = source / f"{name}.obj"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return source


def tries(task: Task) -> int:
    path = Path(task.source + ".tries")
    return len(path.read_text()) if path.exists() else 0


def test_every_mesh_of_a_folder_has_a_result_of_its_own(tmp_path: Path) -> None:
    source = meshes(tmp_path, one="", **{"deep/two": ""})
    (source / "three.stl").write_text("")
    (source / "notes.txt").write_text("")
    target = source / "out"
    target.mkdir()
    (target / "old.obj").write_text("")
    found = folder.tasks(source, target, ["--faces", "9"])
    names = {Path(each.target).relative_to(target).as_posix() for each in found}
    assert names == {"one.obj", "deep/two.obj", "three.obj"}
    assert {each.options for each in found} == {("--faces", "9")}
    (source / "one.stl").write_text("")
    with pytest.raises(FolderError, match=r"one\.obj and .*one\.stl would both become"):
        folder.tasks(source, target)
    with pytest.raises(FolderError, match="no mesh"):
        folder.tasks(tmp_path / "nowhere", target)


def test_a_file_is_done_once_for_the_same_input_and_options(tmp_path: Path, program: Path) -> None:
    source = meshes(tmp_path, one="a mesh ")
    (task,) = folder.tasks(source, tmp_path / "out", ["--faces", "9"], str(program))
    outcome = folder.remesh_one(task)
    assert (outcome.state, outcome.is_old) == ("done", False)
    assert Path(task.target).read_text() == "a mesh --faces 9"
    told = json.loads(Path(task.told).read_text())
    assert told["outcome"]["report"] == {"output": {"n_faces": 1234}}
    assert sorted(each.name for each in (tmp_path / "out").iterdir()) == ["one.obj", "one.obj.json"]
    assert folder.remesh_one(task).is_old
    assert tries(task) == 1
    Path(task.target).unlink()
    assert not folder.remesh_one(task).is_old
    Path(task.source).write_text("another mesh ")
    assert not folder.remesh_one(task).is_old
    (other,) = folder.tasks(source, tmp_path / "out", ["--faces", "8"], str(program))
    assert not folder.remesh_one(other).is_old
    Path(task.told).write_text("{")
    assert not folder.remesh_one(other).is_old
    assert tries(task) == 5


def test_what_cannot_be_done_is_not_tried_again_but_what_fails_is(
    tmp_path: Path, program: Path
) -> None:
    source = meshes(tmp_path, bad="cannot", broken="always fails")
    bad, broken = folder.tasks(source, tmp_path / "out", (), str(program))
    for is_old in (False, True):
        outcome = folder.remesh_one(bad)
        assert (outcome.state, outcome.is_old) == ("refused", is_old)
        assert "it has no faces" in outcome.line()
    assert tries(bad) == 1
    for n in (1, 2):
        with pytest.raises(folder.Failed, match="ended with 101"):
            folder.remesh_one(broken)
        assert tries(broken) == n
    assert not Path(broken.told).exists()


def test_a_line_tells_what_became_of_a_file() -> None:
    report = {"output": {"n_faces": 2000}}
    done = Outcome("a/b.obj", "c.obj", "done", "a warning", seconds=1.25, report=report)
    assert done.line() == "b.obj done 2,000 faces (1.2 s)"
    failed = Outcome("a/b.obj", "c.obj", "failed", "lost\n")
    assert failed.line() == "b.obj failed (0.0 s): lost"


def test_on_dask_no_file_is_lost_with_its_worker(tmp_path: Path, program: Path) -> None:
    pytest.importorskip("distributed")
    texts = {f"mesh{i}": "a mesh " for i in range(6)}
    source = meshes(
        tmp_path, killer="kills its worker once", shaky="fails once", broken="always fails", **texts
    )
    command = [sys.executable, "-m", "orbflow_native.folder", source, tmp_path / "out"]
    command += ["--workers", "2", "--retries", "1", "--program", program, "--", "--faces", "9"]
    ended = subprocess.run([*map(str, command)], capture_output=True, text=True, timeout=120)
    assert ended.returncode == 3, ended.stderr
    assert json.loads(ended.stdout) == {"done": 8, "refused": 0, "failed": 1, "before": 0}
    assert "9 of 9: " in ended.stderr
    assert "broken.obj failed" in ended.stderr
    results = {path.stem for path in (tmp_path / "out").glob("*.obj")}
    assert results == {"killer", "shaky", *texts}
    found = {Path(each.source).stem: each for each in folder.tasks(source, tmp_path / "out")}
    assert [tries(found[name]) for name in ("killer", "shaky", "broken", "mesh0")] == [2, 2, 2, 1]


def test_without_dask_it_is_said_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    source = meshes(tmp_path, one="")
    assert folder.main([str(source), str(tmp_path / "out")]) == 2
    assert "pip install 'orbflow-native[dask]'" in capsys.readouterr().err
