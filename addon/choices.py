# SPDX-License-Identifier: GPL-3.0-or-later
"""What can be chosen for each setting that is a choice: identifier, name, description."""

SIZES = (
    ("FACES", "Faces", "A number of faces"),
    ("RATIO", "Ratio", "A share of the faces that the object has, modifiers included"),
    ("EDGE", "Edge Length", "As many faces as it takes for edges of this length"),
)
KINDS = (
    ("QUADS", "Quads", "Faces with four corners"),
    ("TRIANGLES", "Triangles", "Faces with three corners"),
)
PRIMITIVES = (
    ("AUTO", "Automatic", "Flow for quads, adaptive for triangles"),
    ("FLOW", "Flow", "Quads whose edges follow the shape"),
    ("QUAD_SPHERE", "Quad Sphere", "A subdivided box: even rows of quads, 8 irregular vertices"),
    ("ADAPTIVE", "Adaptive", "Triangles placed where the surface needs them"),
    ("ICOSPHERE", "Icosphere", "A subdivided icosahedron: 12 irregular vertices"),
)
MARKS = (
    ("SHARP", "Sharp", "Edges marked as sharp"),
    ("CREASE", "Crease", "Edges with a subdivision crease"),
    ("SEAM", "Seam", "Edges marked as seams of the UV map"),
    ("UV", "UV Islands", "Borders of islands of the active UV map, marked as seams or not"),
    ("MATERIAL", "Material", "Borders between materials"),
    ("FACE_SETS", "Face Sets", "Borders between the face sets of sculpt mode"),
)
STRENGTHS = (
    ("FOLLOW", "Follow", "Edges run along a guide, on it or beside it"),
    ("EXACT", "Exact", "Edges lie on a guide, as on a sharp edge"),
)
SMALL_PARTS = (
    ("KEEP", "Keep", "They stay as they were"),
    ("DROP", "Leave Out", "The result is without them"),
)
BORDERS = (
    ("KEEP", "Keep", "Open edges stay open: lines of edges of the result lie on them"),
    ("FILL", "Fill", "Holes are closed, all of them or the small ones"),
)
HANDLES = (
    ("KEEP", "Keep", "Handles, as of a cup, stay, and so do holes that go through"),
    ("SEAL", "Seal", "Small ones, as noise in scans has them, are cut and closed"),
)
INNER = (
    ("KEEP", "Keep", "They are parts like others"),
    ("DROP", "Leave Out", "The result is without them"),
)
MIRRORS = (
    ("OFF", "Off", "The two sides of a mesh need not be alike"),
    ("AUTO", "Automatic", "Across the first axis, if any, in which every vertex has its image"),
    ("X", "X", "Across X; a mesh that is not symmetric is made so from the side of positive X"),
    ("Y", "Y", "Across Y; a mesh that is not symmetric is made so from the side of positive Y"),
    ("Z", "Z", "Across Z; a mesh that is not symmetric is made so from the side of positive Z"),
)
MIRROR_MODIFIERS = (
    ("WHOLE", "Whole", "A Mirror modifier goes into the result and leaves the stack"),
    ("HALF", "Half", "The result is one half, which the Mirror modifier makes whole as before"),
)
PREDICTORS = (
    ("AUTO", "Auto", "Network for more than some 10,000 faces, where it saves time, else Solver"),
    (
        "NETWORK",
        "Network",
        "A graph network proposes, the solver mends and grows: faster than Solver and as good",
    ),
    ("SOLVER", "Solver", "Finds the map to the sphere by optimisation alone"),
)
