"""Poses bodies of the base mesh by the rig that is among the data: Rig(DATA/poses).posed(...).

The rig was made for one body. A joint of another body is where the skin that both of its bones move
went, in the mean.
"""

import importlib.util
import json
import random
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
# A joint whose two bones share less skin than this, summed, is that of the bone's own skin.
LEAST_SHARED = 0.05
FINGERS = ("index", "middle", "ring", "pinky")


class Rig:
    """The bones of the base mesh, and what bends them."""

    def __init__(self, folder: Path) -> None:
        """Reads `human_f/rig.json` and `make_poses.py`, which says how skin follows bones."""
        spec = importlib.util.spec_from_file_location("make_poses", folder / "make_poses.py")
        if spec is None or spec.loader is None:
            raise FileNotFoundError(folder / "make_poses.py")
        self.bend = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(self.bend)
        self.rig = json.loads((folder / "human_f" / "rig.json").read_text())
        self.rest: Points = np.array(self.rig["vertices"], dtype=np.float64)
        self.joints = self._joints()

    def _joints(self) -> dict[str, Points]:
        """How much each vertex counts at the head of each bone that has a parent."""
        bones = self.rig["bones"]
        weights = {bone["name"]: np.zeros(len(self.rest)) for bone in bones}
        for name, pairs in self.rig["weights"].items():
            for vertex, weight in pairs:
                weights[name][vertex] = weight
        joints = {}
        for bone in bones:
            name, parent = bone["name"], bone["parent"]
            if parent not in weights:
                continue
            shared = weights[name] * weights[parent]
            if shared.sum() < LEAST_SHARED:
                shared = weights[name]
            if shared.sum() > 0:
                joints[name] = shared / shared.sum()
        return joints

    def posed(self, vertices: Points, chance: random.Random, most: float) -> Points:
        """Bends a body; `most` from 0 to 1 says how far limbs turn at most."""
        moved = vertices - self.rest
        bones = []
        for bone in self.rig["bones"]:
            weights = self.joints.get(bone["name"])
            head = np.array(bone["head"])
            if weights is not None:
                head = head + weights @ moved
            bones.append({**bone, "head": head.tolist()})
        return self.bend.skin(vertices, {**self.rig, "bones": bones}, self._pose(chance, most))

    def _pose(self, chance: random.Random, most: float) -> list[tuple[str, object, float]]:
        bend = self.bend

        def angle(low: float, high: float) -> float:
            return most * chance.uniform(low, high)

        pose: list[tuple[str, object, float]] = []
        for side, out in (("l", bend.LEFT), ("r", bend.RIGHT)):
            pose += [
                (f"upperarm_{side}", bend.UP, angle(-40, 60)),
                (f"upperarm_{side}", bend.FRONT, angle(-25, 45)),
                (f"upperarm_{side}", "twist", angle(-30, 30)),
                (f"lowerarm_{side}", bend.FRONT, angle(0, 85)),
                (f"lowerarm_{side}", "twist", angle(-40, 40)),
                (f"hand_{side}", bend.UP, angle(-25, 25)),
                (f"hand_{side}", bend.FRONT, angle(-15, 15)),
                (f"thigh_{side}", bend.FRONT, angle(-25, 70)),
                (f"thigh_{side}", out, angle(-8, 25)),
                (f"calf_{side}", bend.BACK, angle(0, 80)),
                (f"foot_{side}", bend.UP, angle(-20, 20)),
            ]
            curl = angle(-5, 30)
            for finger in FINGERS:
                pose += [
                    (f"{finger}_{joint}_{side}", bend.DOWN, curl * chance.uniform(0.6, 1.3))
                    for joint in ("01", "02", "03")
                ]
            pose.append((f"thumb_01_{side}", bend.FRONT, angle(-15, 15)))
        for bone in ("spine_01", "spine_02", "neck_01", "head"):
            pose += [
                (bone, bend.FRONT, angle(-10, 15)),
                (bone, bend.LEFT, angle(-10, 10)),
                (bone, "twist", angle(-15, 15)),
            ]
        return pose
