"""The wheel: arrays in, arrays out, progress, cancelling, errors."""

import threading
import time

import numpy as np
import orbflow_native
import pytest
from shapes import Arrays, ball


@pytest.fixture(scope="module")
def mesh() -> Arrays:
    return ball()


def test_quads_come_out_closed_and_as_many_as_asked_for(mesh: Arrays) -> None:
    result = orbflow_native.remesh(*mesh, faces=1000)
    assert (result.positions.dtype, result.positions.shape[1]) == (np.float32, 3)
    assert (result.loop_start.dtype, result.corner_vert.dtype) == (np.int32, np.int32)
    assert np.array_equal(result.loop_start, np.arange(0, len(result.corner_vert), 4))
    assert abs(len(result.loop_start) - 1000) <= 20
    assert result.material_index is None
    output = result.report["output"]
    assert (output["closed"], output["genus"], output["n_components"]) == (True, 0, 1)
    assert result.report["embedding"]["n_folds"] == 0
    assert result.report["embedding"]["degree"] == 1
    assert np.allclose(np.linalg.norm(result.sphere, axis=1), 1, atol=1e-5)


def test_triangles_come_out_as_triangles(mesh: Arrays) -> None:
    result = orbflow_native.remesh(*mesh, faces=500, kind="triangles")
    assert np.array_equal(result.loop_start, np.arange(0, len(result.corner_vert), 3))


def test_the_same_input_gives_the_same_bytes_with_any_number_of_threads(mesh: Arrays) -> None:
    results = [
        orbflow_native.remesh(*mesh, faces=300, kind=kind, threads=threads).positions.tobytes()
        for kind in ("quads", "triangles")
        for threads in (1, 2, 2)
    ]
    assert len(set(results[:3])) == len(set(results[3:])) == 1


def test_materials_come_over(mesh: Arrays) -> None:
    positions, _, corner_vert = mesh
    heights = positions[corner_vert.reshape(-1, 3), 2].mean(1)
    materials = (heights > 0).astype(np.int32) + 5
    result = orbflow_native.remesh(*mesh, faces=1000, material_index=materials)
    assert result.material_index is not None
    new_heights = result.positions[result.corner_vert.reshape(-1, 4), 2].mean(1)
    agrees = result.material_index == (new_heights > 0) + 5
    assert agrees[abs(new_heights) > 0.1].all()


def test_marked_edges_are_edges_of_the_result(mesh: Arrays) -> None:
    points, _, corners = mesh
    ends = np.stack([corners.reshape(-1, 3), np.roll(corners.reshape(-1, 3), 1, 1)], -1)
    sides = np.unique(np.sort(ends.reshape(-1, 2)), axis=0)
    ring = np.ascontiguousarray(sides[(np.abs(points[sides][..., 2]) < 1e-6).all(1)])
    plain, ringed = (
        orbflow_native.remesh(*mesh, faces=500, score_samples=0, marked_edges=edges)
        for edges in (None, ring)
    )
    n_on_ring = [int((np.abs(each.positions[:, 2]) < 1e-5).sum()) for each in (plain, ringed)]
    assert n_on_ring[1] > max(20, 2 * n_on_ring[0])
    ring[3, 1] = -7
    with pytest.raises(orbflow_native.InputError, match="marked edge 3 names vertex -7"):
        orbflow_native.remesh(*mesh, marked_edges=ring)
    with pytest.raises(ValueError, match=r"marked_edges must be of shape \(E, 2\), not \(1, 3\)"):
        orbflow_native.remesh(*mesh, marked_edges=np.zeros((1, 3), np.int32))


def test_mirrored_quads_are_their_own_image(mesh: Arrays) -> None:
    result = orbflow_native.remesh(*mesh, faces=400, mirror="x", score_samples=0)
    assert result.report["plane"]["axis"] == 0
    assert [part["mirrored"] for part in result.report["parts"]] == [{"status": "used"}]
    points = result.positions.astype(np.float64)
    images = points * (-1, 1, 1)
    far = np.linalg.norm(images[:, None] - points[None], axis=2).min(axis=1)
    assert far.max() < 1e-6 * np.linalg.norm(np.ptp(points, axis=0))


def test_a_stretched_object_gets_even_faces_where_it_is_seen(mesh: Arrays) -> None:
    def variation(scale: tuple[float, float, float]) -> float:
        result = orbflow_native.remesh(*mesh, faces=1000, kind="triangles", scale=scale)
        points = result.positions[result.corner_vert.reshape(-1, 3)] * np.array(
            (1, 1, 5), np.float32
        )
        lengths = np.linalg.norm(points - np.roll(points, 1, axis=1), axis=2)
        return float(lengths.std() / lengths.mean())

    assert variation((1, 1, 5)) < 0.7 * variation((1, 1, 1))


def test_the_size_and_the_mirroring_of_an_object_change_nothing(mesh: Arrays) -> None:
    results = [
        orbflow_native.remesh(*mesh, faces=300, scale=scale).positions.tobytes()
        for scale in ((1.0, 1.0, 1.0), (7.0, 7.0, 7.0), (-2.0, 2.0, 2.0))
    ]
    assert len(set(results)) == 1


def test_progress_rises_to_the_end_on_the_calling_thread(mesh: Arrays) -> None:
    heard: list[tuple[str, float, int]] = []
    orbflow_native.remesh(
        *mesh, progress=lambda *told: heard.append((*told, threading.get_ident()))
    )
    shares = [share for _, share, _ in heard]
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    assert {thread for *_, thread in heard} == {threading.get_ident()}


def test_a_raised_token_stops_within_a_fifth_of_a_second() -> None:
    mesh = ball(300, 400)

    def latency_s() -> float:
        token = orbflow_native.CancelToken()
        raised: list[float] = []

        def raise_it() -> None:
            time.sleep(0.2)
            raised.append(time.monotonic())
            token.cancel()

        thread = threading.Thread(target=raise_it)
        thread.start()
        with pytest.raises(orbflow_native.Cancelled, match="cancelled"):
            orbflow_native.remesh(*mesh, faces=100_000, cancel=token)
        thread.join()
        return time.monotonic() - raised[0]

    # A busy machine may be late once, not three times.
    assert min(latency_s() for _ in range(3)) < 0.2


def test_what_the_listener_raises_comes_out(mesh: Arrays) -> None:
    def listener(_name: str, _share: float) -> None:
        raise LookupError("from the listener")

    with pytest.raises(LookupError, match="from the listener"):
        orbflow_native.remesh(*mesh, progress=listener)


def test_other_threads_run_meanwhile(mesh: Arrays) -> None:
    ticks: list[float] = []
    done = threading.Event()

    def tick() -> None:
        while not done.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.01)

    thread = threading.Thread(target=tick)
    thread.start()
    orbflow_native.remesh(*ball(100, 150), faces=5000)
    done.set()
    thread.join()
    assert len(ticks) > 5


@pytest.mark.parametrize(
    ("change", "error", "text"),
    [
        ({"positions": np.zeros((4, 3))}, TypeError, r"positions must be a \(V, 3\) float32 array"),
        ({"positions": [[0, 0, 0]]}, TypeError, "positions must be a .* not <class 'list'>"),
        ({"positions": np.zeros((4, 2), np.float32)}, ValueError, r"shape \(V, 3\), not \(4, 2\)"),
        ({"positions": np.zeros(12, np.float32)}, ValueError, r"not \[12\] float32"),
        ({"positions": np.zeros((3, 4), np.float32).T}, ValueError, "must be C-contiguous"),
        ({"loop_start": np.arange(4, dtype=np.int64)}, TypeError, "loop_start must be .* int64"),
        ({"kind": "hexagons"}, ValueError, "kind: unknown variant `hexagons`"),
        ({"primitive": "torus"}, ValueError, "primitive: unknown variant `torus`"),
        ({"predictor": "oracle"}, ValueError, "predictor: unknown name `oracle`"),
        ({"faces": 3}, orbflow_native.InputError, "3 faces were asked for; 4 to 4000000"),
        ({"scale": (1, 0, 1)}, orbflow_native.InputError, "scaled by .1, 0, 1."),
        (
            {"kind": "triangles", "primitive": "quad-sphere"},
            orbflow_native.InputError,
            "makes quads",
        ),
    ],
)
def test_wrong_arguments_are_named(
    mesh: Arrays, change: dict[str, object], error: type[Exception], text: str
) -> None:
    arrays = dict(zip(("positions", "loop_start", "corner_vert"), mesh, strict=True))
    with pytest.raises(error, match=text):
        orbflow_native.remesh(**(arrays | change))  # pyright: ignore[reportArgumentType]


def test_wrong_numbers_in_arrays_are_named(mesh: Arrays) -> None:
    positions, loop_start, corner_vert = mesh[0].copy(), mesh[1], mesh[2].copy()
    corner_vert[7] = -5
    with pytest.raises(orbflow_native.InputError, match="face 2 names vertex -5"):
        orbflow_native.remesh(positions, loop_start, corner_vert)
    corner_vert[7] = len(positions)
    with pytest.raises(orbflow_native.InputError, match=f"face 2 names vertex {len(positions)}"):
        orbflow_native.remesh(positions, loop_start, corner_vert)
    with pytest.raises(orbflow_native.InputError, match="face starts must rise"):
        orbflow_native.remesh(positions, loop_start - 3, mesh[2])
    positions[4, 1] = np.nan
    with pytest.raises(orbflow_native.InputError, match="vertex 4 has a coordinate that is not"):
        orbflow_native.remesh(positions, loop_start, mesh[2])


def test_embedding_gives_every_vertex_a_point_of_the_sphere(mesh: Arrays) -> None:
    embedded = orbflow_native.embed(*mesh)
    assert len(embedded.sphere) == len(embedded.positions) == len(mesh[0])
    assert embedded.report["embedding"]["n_folds"] == 0


def test_decimation_reaches_the_count(mesh: Arrays) -> None:
    decimated = orbflow_native.decimate(*mesh, faces=400)
    assert abs(len(decimated.loop_start) - 400) <= 8


def test_a_mesh_reduced_outside_is_used_when_it_fits_and_refused_when_not(mesh: Arrays) -> None:
    large = ball(120, 160)
    small = (mesh[0], mesh[2].reshape(-1, 3))
    used = orbflow_native.remesh(*large, faces=300, reduced=small)
    assert used.report["parts"][0]["reduced"]["status"] == "used"
    torn = (mesh[0], mesh[2].reshape(-1, 3)[1:])
    refused = orbflow_native.remesh(*large, faces=300, reduced=torn)
    assert refused.report["parts"][0]["reduced"]["status"] == "refused"


def test_large_meshes_are_reduced_by_fast_simplification() -> None:
    pytest.importorskip("fast_simplification")
    result = orbflow_native.remesh(*ball(300, 350), faces=300)
    assert result.report["parts"][0]["reduced"]["status"] in {"used", "refused"}


def test_a_mesh_scores_itself_as_equal(mesh: Arrays) -> None:
    score = orbflow_native.score(mesh, mesh, n_samples=2000)
    assert score["chamfer_pct"] < 1e-6
    assert score["same_topology"]
    assert score["f1_at_0.5_pct"] == 100
