"""Which figures the tables show: the key of a row, the title, the form."""

from collections.abc import Sequence

Columns = Sequence[tuple[str, str, str]]

TRIANGLES = (
    ("triangles", "triangles", "d"),
    ("chamfer_pct", "mean distance %", ".4f"),
    ("isotropic_chamfer_pct", "isotropic's", ".4f"),
    ("chamfer_ratio", "ratio", ".2f"),
    ("hausdorff_pct", "Hausdorff %", ".2f"),
    ("f1_at_0.5_pct", "F1 at 0.5 %", ".2f"),
    ("edge_cv", "edge CV", ".3f"),
    ("triangle_angle_mean_min", "mean min angle", ".1f"),
    ("self_intersecting_pct", "crossing %", ".3f"),
    ("run_s", "CPU s", ".2f"),
    ("isotropic_cpu_s", "isotropic's", ".2f"),
)
QUADS = (
    ("faces", "quads", "d"),
    ("chamfer_pct", "mean distance %", ".4f"),
    ("instant_meshes_chamfer_pct", "Instant Meshes'", ".4f"),
    ("quadriflow_chamfer_pct", "QuadriFlow's", ".4f"),
    ("hausdorff_pct", "Hausdorff %", ".2f"),
    ("f1_at_1_pct", "F1 at 1 %", ".2f"),
    ("edge_cv", "edge CV", ".3f"),
    ("jacobian_mean", "scaled Jacobian", ".3f"),
    ("self_intersecting_pct", "crossing %", ".3f"),
    ("alignment_deg", "alignment °", ".1f"),
    ("irregular_pct", "irregular %", ".2f"),
    ("loop_edges_pct", "loop edges %", ".0f"),
    ("spiral_pct", "spiral %", ".0f"),
)
FLOW = (
    ("faces", "quads", "d"),
    ("chamfer_pct", "mean distance %", ".3f"),
    ("hausdorff_pct", "Hausdorff %", ".2f"),
    ("edge_cv", "edge CV", ".3f"),
    ("jacobian_min", "Jacobian min", ".2f"),
    ("jacobian_p01", "1 %", ".2f"),
    ("jacobian_mean", "mean", ".3f"),
    ("self_intersecting_pct", "crossing %", ".2f"),
    ("irregular_pct", "irregular %", ".1f"),
    ("alignment_deg", "alignment °", ".1f"),
    ("loop_edges_pct", "loop edges %", ".0f"),
    ("spiral_pct", "spiral %", ".0f"),
    ("feature_f1_pct", "feature F1 %", ".0f"),
    ("run_s", "CPU s", ".2f"),
    ("quadriflow_s", "QuadriFlow's", ".2f"),
)
BODIES = (
    ("faces", "quads", "d"),
    ("chamfer_pct", "mean distance %", ".3f"),
    ("posed_chamfer_pct", "posed", ".3f"),
    ("hausdorff_pct", "Hausdorff %", ".2f"),
    ("edge_cv", "edge CV", ".3f"),
    ("jacobian_min", "Jacobian min", ".2f"),
    ("irregular_pct", "irregular %", ".1f"),
    ("alignment_deg", "alignment °", ".1f"),
    ("loop_edges_pct", "loop edges %", ".0f"),
    ("spiral_pct", "spiral %", ".1f"),
    ("run_s", "CPU s", ".2f"),
)
FEW = (
    ("n_asked", "asked", "d"),
    ("flow_share", "flow used", ".0%"),
    ("upright_share", "no inverted quad", ".0%"),
    ("count_error_pct", "count error %", ".1f"),
    ("chamfer_pct", "mean distance %", ".3f"),
    ("hausdorff_pct", "Hausdorff %", ".1f"),
    ("jacobian_mean", "scaled Jacobian", ".3f"),
    ("irregular_pct", "irregular %", ".0f"),
    ("loop_edges_pct", "loop edges %", ".0f"),
    ("run_s", "CPU s", ".2f"),
)
WHOLE = (
    ("input_triangles", "input triangles", "d"),
    ("run_s", "Orbflow, CPU s", ".2f"),
    ("instant_meshes_s", "Instant Meshes, algorithm alone", ".2f"),
    ("quadriflow_s", "QuadriFlow, algorithm alone", ".2f"),
    ("peak_mb", "our peak MB", ".0f"),
)
COST = (
    ("n_vertices", "vertices", "d"),
    ("cpu_s", "CPU s", ".2f"),
    ("energy", "energy", ".3f"),
    ("n_relaxations", "relaxations", "d"),
    ("peak_mb", "peak MB", ".0f"),
    ("instant_meshes_s", "Instant Meshes' whole run, CPU s", ".2f"),
)
THREADS = (
    ("embed_1_s", "embedding, 1 thread, s", ".2f"),
    ("embed_2_s", "2 threads, s", ".2f"),
    ("ratio", "ratio", ".2f"),
    ("whole_ratio", "ratio of the whole process", ".2f"),
)
LARGE = (
    ("kind", "kind", "s"),
    ("faces", "faces", "d"),
    ("cpu_s", "CPU s", ".1f"),
    ("wall_s", "wall s", ".1f"),
    ("peak_mb", "peak MB", ".0f"),
)
