#!/usr/bin/python3
"""A second simulator of motion sensors, written apart from pirsim, in numpy.

    second_simulator.py PIRSIM --scene SCENE --script SCRIPT [--trials S1,S2] [--replicates N] [-o measured.csv]
                        [--missed P] [--dead-s S] [--false-per-s R] [--yaw-deg D] [--seed N]

It shares no code with pirsim. Its own are: the reading of glTF and of the sensor's file, the lens law, the ray tests
(in double precision, other formulas), occlusion, zones, motion, windows, the injected effects and their random
numbers. Not its own: where the thirteen solids of the body are at each tick (`pirsim export`), and the column `phase`
(pirsim's rows). README.md says what that proves and what not.
"""
import argparse
import base64
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

CHUNK = 50  # ticks traced at once


# ---------------------------------------------------------------------------------------------------------- glTF
class Gltf:
    """JSON glTF whose buffers stand in the file."""

    DTYPES = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
    WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}

    def __init__(self, path):
        self.json = json.loads(pathlib.Path(path).read_text())
        self.buffers = [base64.b64decode(buffer["uri"].split(",", 1)[1]) for buffer in self.json["buffers"]]

    def accessor(self, index):
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        kind = np.dtype(self.DTYPES[accessor["componentType"]])
        width = self.WIDTHS[accessor["type"]]
        stride = view.get("byteStride", kind.itemsize * width)
        begin = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        rows = np.ndarray((accessor["count"], width), kind, self.buffers[view["buffer"]], begin, (stride, kind.itemsize))
        return rows.astype(float) if kind.kind == "f" else rows.astype(int)

    def nodes(self):
        """Yields (node, 4 x 4 world matrix), parents first."""
        stack = [(root, np.eye(4)) for root in self.json["scenes"][self.json.get("scene", 0)]["nodes"]]
        while stack:
            index, world_from_parent = stack.pop()
            node = self.json["nodes"][index]
            world = world_from_parent @ local_matrix(node)
            yield node, world
            stack += [(child, world) for child in node.get("children", [])]

    def triangles(self):
        """(n, 3, 3) corners in the world of everything that occludes."""
        parts = []
        for node, world in self.nodes():
            if "mesh" not in node or mark(node).get("type") == "ignore":
                continue
            for primitive in self.json["meshes"][node["mesh"]]["primitives"]:
                assert primitive.get("mode", 4) == 4, "triangles only"
                points = self.accessor(primitive["attributes"]["POSITION"]) @ world[:3, :3].T + world[:3, 3]
                parts.append(points[self.accessor(primitive["indices"])[:, 0]].reshape(-1, 3, 3))
        return np.concatenate(parts)


def mark(node):
    return node.get("extras", {}).get("pirsim", {})


def rotation_matrix(q):
    """Of quaternions (..., 4) in glTF's order x, y, z, w."""
    x, y, z, w = np.moveaxis(q / np.linalg.norm(q, axis=-1, keepdims=True), -1, 0)
    rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def local_matrix(node):
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    matrix = np.eye(4)
    matrix[:3, :3] = rotation_matrix(np.array(node.get("rotation", [0, 0, 0, 1]), float))
    matrix[:3, :3] *= np.array(node.get("scale", [1, 1, 1]), float)
    matrix[:3, 3] = node.get("translation", [0, 0, 0])
    return matrix


# ---------------------------------------------------------------------------------------------------------- optics
class Rays:
    """All sensors' rays: origins and directions (n, 3), limits (n), clusters (n) numbered over all sensors."""

    def __init__(self, scene, sensor_folder, yaw_deg=0.0):
        self.sensors, self.sensor_of_cluster = [], []
        origins, directions, ranges, clusters = [], [], [], []
        for node, world in sorted_sensors(scene):
            about = mark(node)
            turn = rotation_matrix(np.array([0, np.sin(np.radians(yaw_deg) / 2), 0, np.cos(np.radians(yaw_deg) / 2)]))
            for facet, range_m in facets_of(pathlib.Path(sensor_folder) / (about["model"] + ".yaml")):
                looking = facet @ (turn @ world[:3, :3]).T
                directions.append(looking / np.linalg.norm(looking, axis=1, keepdims=True))
                origins.append(np.tile(world[:3, 3], (len(facet), 1)))
                ranges.append(np.full(len(facet), range_m))
                clusters.append(np.full(len(facet), len(self.sensor_of_cluster)))
                self.sensor_of_cluster.append(len(self.sensors))
            self.sensors.append(about["id"])
        self.origins, self.directions = np.concatenate(origins), np.concatenate(directions)
        self.clusters = np.concatenate(clusters)
        self.limits = np.minimum(np.concatenate(ranges), nearest_triangle(self, scene.triangles()))


def sorted_sensors(scene):
    """In the order of the file's nodes."""
    placed = {id(node): (node, world) for node, world in scene.nodes()}
    return [placed[id(node)] for node in scene.json["nodes"] if mark(node).get("type") == "sensor" and id(node) in placed]


def facets_of(path):
    """Per facet of a diamond lens: twenty directions (five for each of four zones) and the range."""
    text = path.read_text()
    number = lambda key: float(re.search(rf"^{key}: *([-\d.]+)", text, re.M).group(1))
    assert re.search(r"^layout: *diamond", text, re.M), f"{path}: only diamond lenses are known here"
    plane, spacing, half_diagonal = number("plane_m"), number("half_spacing_ratio"), number("half_diagonal_ratio")
    steps = np.array([[1, 0], [0, 1], [-1, 0], [0, -1]], float)
    facets = []
    for x, y, reach in re.findall(r"- \{x_m: *([-\d.]+), *y_m: *([-\d.]+),.*range_m: *([\d.]+)\}", text):
        centre = np.array([float(x), float(y)])
        length = np.sqrt(centre @ centre + plane**2)
        points = [zone + step for zone in centre + spacing * length * steps
                  for step in np.vstack([half_diagonal * length * steps, [[0, 0]]])]
        facets.append((np.column_stack([points, np.full(len(points), -plane)]), float(reach)))
    return facets


# ---------------------------------------------------------------------------------------------------------- ray tests
def nearest_triangle(rays, triangles):
    """Distance of the first triangle along each ray; infinity if there is none. By planes and half-planes."""
    nearest = np.full(len(rays.directions), np.inf)
    for a, b, c in triangles:
        normal = np.cross(b - a, c - a)
        slope = rays.directions @ normal
        with np.errstate(divide="ignore", invalid="ignore"):
            distance = np.where(slope != 0, ((a - rays.origins) @ normal) / slope, np.inf)
        points = rays.origins + np.where(np.isfinite(distance), distance, 0)[:, None] * rays.directions
        inside = distance >= 0
        for p, q in ((a, b), (b, c), (c, a)):
            inside &= np.cross(q - p, points - p) @ normal >= -1e-9 * (normal @ normal)
        nearest = np.where(inside & (distance < nearest), distance, nearest)
    return nearest


def sphere_entry(o, d, centre, radius):
    """Rays o + t d against spheres: t of the entry, 0 from inside, infinity for a miss. Shapes (..., 3)."""
    to = o - centre
    b, c = (to * d).sum(-1), (to * to).sum(-1) - radius**2
    root = b * b - c
    t = -b - np.sqrt(np.maximum(root, 0))
    return np.where(c < 0, 0.0, np.where((root >= 0) & (t >= 0), t, np.inf))


def capsule_entry(o, d, a, b, radius):
    """Against the two balls, and the round side between them."""
    along = b - a
    length = np.linalg.norm(along, axis=-1, keepdims=True)
    axis = along / length
    to = o - a
    d_across, o_across = d - (d * axis).sum(-1)[..., None] * axis, to - (to * axis).sum(-1)[..., None] * axis
    qa, qb = (d_across**2).sum(-1), (d_across * o_across).sum(-1)
    qc = (o_across**2).sum(-1) - radius**2
    root = qb * qb - qa * qc
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (-qb - np.sqrt(np.maximum(root, 0))) / qa
    t = np.where(qc < 0, 0.0, t)
    height = ((to + np.nan_to_num(t)[..., None] * d) * axis).sum(-1)
    on_side = (root >= 0) & (t >= 0) & (height >= 0) & (height <= length[..., 0])
    ends = np.minimum(sphere_entry(o, d, a, radius), sphere_entry(o, d, b, radius))
    return np.minimum(ends, np.where(on_side, t, np.inf))


def box_entry(o, d, centre, rotation, half):
    """In the box's own frame, by three pairs of planes."""
    start, step = np.einsum("...ij,...i->...j", rotation, o - centre), np.einsum("...ij,...i->...j", rotation, d)
    with np.errstate(divide="ignore", invalid="ignore"):
        one, two = (-half - start) / step, (half - start) / step
    enter, leave = np.minimum(one, two).max(-1), np.maximum(one, two).min(-1)
    return np.where((enter <= leave) & (leave >= 0), np.maximum(enter, 0.0), np.inf)


# ---------------------------------------------------------------------------------------------------------- motion
class Motion:
    """The solids of all people at every tick, from an exported run."""

    def __init__(self, exported):
        tracks = {}
        animation = exported.json["animations"][0]
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            tracks[channel["target"]["node"], channel["target"]["path"]] = exported.accessor(sampler["output"])
            self.times = exported.accessor(sampler["input"])[:, 0]
        nodes = exported.json["nodes"]
        persons = {mark(node)["id"]: i for i, node in enumerate(nodes) if mark(node).get("type") == "person"}
        self.solids = []  # (about, origins, rotations, present)
        for i, node in enumerate(nodes):
            if mark(node).get("type") == "body_part":
                present = tracks[persons[mark(node)["person"]], "scale"][:, 0] > 0.5
                self.solids.append((mark(node), tracks[i, "translation"], rotation_matrix(tracks[i, "rotation"]), present))


def entry(about, o, d, origin, rotation):
    if about["primitive"] == "sphere":
        return sphere_entry(o, d, origin, about["radius_m"])
    if about["primitive"] == "box":
        return box_entry(o, d, origin, rotation, np.array(about["half_extents_m"]))
    half_axis = rotation[..., :, 1] * about["half_length_m"]
    return capsule_entry(o, d, origin - half_axis, origin + half_axis, about["radius_m"])


def reach_of(about):
    return np.linalg.norm(about["half_extents_m"]) if about["primitive"] == "box" else (
        about["radius_m"] + about.get("half_length_m", 0.0))


def active_clusters(rays, motion):
    """(ticks, clusters): a ray of the cluster meets a body before the room and within its range. The first is empty."""
    n_ticks = len(motion.times)
    active = np.zeros((n_ticks, len(rays.sensor_of_cluster)), bool)
    for first in range(1, n_ticks, CHUNK):
        ticks = slice(first, min(first + CHUNK, n_ticks))
        seen = np.zeros((ticks.stop - first, len(rays.limits)), bool)
        for about, origins, rotations, present in motion.solids:
            to = origins[ticks, None] - rays.origins  # a ball round the solid leaves out most rays
            near = np.maximum((to * rays.directions).sum(-1), 0)
            gap = ((to - near[..., None] * rays.directions) ** 2).sum(-1)
            t, r = np.nonzero((gap <= (reach_of(about) + 1e-6) ** 2) & present[ticks, None] & ~seen)
            hit = entry(about, rays.origins[r], rays.directions[r], origins[ticks][t], rotations[ticks][t])
            seen[t, r] |= hit < rays.limits[r]
        for cluster in range(active.shape[1]):
            active[ticks, cluster] = seen[:, rays.clusters == cluster].any(1)
    return active


def triggers_of(rays, active):
    """(ticks, sensors) from tick 1: a cluster wakes or falls silent."""
    changed = active[1:] != active[:-1]
    sensor = np.array(rays.sensor_of_cluster)
    return np.column_stack([changed[:, sensor == i].any(1) for i in range(len(rays.sensors))])


def windows_of(triggers, ticks_per_window):
    n = len(triggers) // ticks_per_window
    return triggers[: n * ticks_per_window].reshape(n, ticks_per_window, -1).any(1)


# --------------------------------------------------------------------------------------------------------- injecting
def inject(triggers, rate_hz, ticks_per_window, options, random):
    """Electronics and surroundings gone wrong, in the order of the signal."""
    triggers = triggers.copy()
    if options.false_per_s > 0:
        triggers |= random.random(triggers.shape) < 1 - np.exp(-options.false_per_s / rate_hz)
    if options.dead_s > 0:
        for column in triggers.T:
            awake = 0
            for tick in np.flatnonzero(column):
                column[tick] = tick >= awake
                awake = tick + round(options.dead_s * rate_hz) if tick >= awake else awake
    windows = windows_of(triggers, ticks_per_window)
    return windows & (random.random(windows.shape) >= options.missed)


# ---------------------------------------------------------------------------------------------------------- commands
def run_pirsim(options, *words):
    study = ["--scene", options.scene, "--script", options.script, *(w for s in options.set for w in ("--set", s))]
    return subprocess.run([options.pirsim, *map(str, words), *study], check=True, stdout=subprocess.PIPE, text=True).stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pirsim")
    parser.add_argument("--scene", required=True)
    parser.add_argument("--script", required=True)
    parser.add_argument("--sensors", default=pathlib.Path(__file__).parents[2] / "data/sensors")
    parser.add_argument("--set", action="append", default=[], help="as pirsim's own")
    parser.add_argument("--trials", help="default: all")
    parser.add_argument("--replicates", type=int, default=1)
    parser.add_argument("-o", "--output", default="/dev/stdout")
    parser.add_argument("--missed", type=float, default=0.0, help="chance that a window is lost")
    parser.add_argument("--dead-s", type=float, default=0.0, help="blind after a trigger")
    parser.add_argument("--false-per-s", type=float, default=0.0, help="triggers without anybody")
    parser.add_argument("--yaw-deg", type=float, default=0.0, help="all sensors are turned to the left")
    parser.add_argument("--seed", type=int, default=0, help="of the injected effects")
    options = parser.parse_args()
    options.set.append(f"replicates={options.replicates}")

    rays = Rays(Gltf(options.scene), options.sensors, options.yaw_deg)
    plain = list(csv.DictReader(run_pirsim(options, "-q").splitlines()))
    runs = list(dict.fromkeys((row["replicate"], row["trial"]) for row in plain))
    random = np.random.default_rng(options.seed)
    with open(options.output, "w", newline="") as file, tempfile.TemporaryDirectory() as folder:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["replicate", "trial", "time_s", "phase", *rays.sensors])
        for replicate, trial in runs:
            if options.trials and trial not in options.trials.split(","):
                continue
            rows = [row for row in plain if (row["replicate"], row["trial"]) == (replicate, trial)]
            exported = pathlib.Path(folder) / "run.gltf"
            run_pirsim(options, "export", "-q", "--trial", trial, "--replicate", replicate, "--keys-per-s", 1000,
                       "--beams", "none", "-o", exported)
            motion = Motion(Gltf(exported))
            rate_hz = round(1 / np.diff(motion.times).min())
            per_window = round(rate_hz * float(rows[0]["time_s"]))
            bits = inject(triggers_of(rays, active_clusters(rays, motion)), rate_hz, per_window, options, random)
            assert len(bits) == len(rows), (len(bits), len(rows))
            for row, sensed in zip(rows, bits):
                out.writerow([replicate, trial, row["time_s"], row["phase"], *sensed.astype(int)])


if __name__ == "__main__":
    sys.exit(main())
