#!/usr/bin/python3
"""A second simulator of motion sensors, written apart from pirsim, in numpy.

    second_simulator.py PIRSIM --scene SCENE --script SCRIPT [--trials S1,S2] [--replicates N] [--fault NAME]
                        [--seed N] [-o measured.csv]

It shares no code with pirsim. Its own are: the reading of glTF and of the sensor's file, the lens law, the ray tests
(in double precision, other formulas), occlusion, zones, motion, windows, and what may be wrong with all this
(faults.py), with its random numbers. Not its own: where the thirteen solids of the body are at each tick
(`pirsim export`), and the column `phase` (pirsim's rows). README.md says what that proves and what not.
"""
import argparse
import base64
import copy
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

from faults import FAULTS, sharp  # noqa: F401: the detector without faults, for tests

CHUNK = 50  # ticks traced at once


# ---------------------------------------------------------------------------------------------------------- glTF
class Gltf:
    """glTF whose buffers stand in the file: JSON, or binary, which is mapped and not read."""

    DTYPES = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
    WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}

    def __init__(self, path):
        if pathlib.Path(path).suffix == ".glb":
            binary = np.memmap(path, mode="r")
            text_end = 20 + int(binary[12:16].view("<u4")[0])  # a header of 12 bytes, then chunks with one of 8
            self.json = json.loads(binary[20:text_end].tobytes())
            self.buffers = [binary[text_end + 8 :]]
            return
        self.json = json.loads(pathlib.Path(path).read_text())
        self.buffers = [base64.b64decode(buffer["uri"].split(",", 1)[1]) for buffer in self.json["buffers"]]

    def accessor(self, index, chosen=slice(None)):
        """(n, width) Its rows, or the chosen ones, as floats or whole numbers."""
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        kind = np.dtype(self.DTYPES[accessor["componentType"]])
        width = self.WIDTHS[accessor["type"]]
        stride = view.get("byteStride", kind.itemsize * width)
        begin = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        rows = np.ndarray((accessor["count"], width), kind, self.buffers[view["buffer"]], begin, (stride, kind.itemsize))[chosen]
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

    def __init__(self, scene, sensor_folder, mount=None, range_scale=1.0, triangles=None):
        """mount: function of a sensor's number and its 4 x 4 world matrix to the matrix that it really hangs with."""
        self.sensors, self.sensor_of_cluster = [], []
        origins, directions, ranges, clusters = [], [], [], []
        for number, (node, world) in enumerate(sorted_sensors(scene)):
            about = mark(node)
            if mount is not None:
                world = mount(number, world)
            for facet, range_m in facets_of(pathlib.Path(sensor_folder) / (about["model"] + ".yaml")):
                looking = facet @ world[:3, :3].T
                directions.append(looking / np.linalg.norm(looking, axis=1, keepdims=True))
                origins.append(np.tile(world[:3, 3], (len(facet), 1)))
                ranges.append(np.full(len(facet), range_scale * range_m))
                clusters.append(np.full(len(facet), len(self.sensor_of_cluster)))
                self.sensor_of_cluster.append(len(self.sensors))
            self.sensors.append(about["id"])
        self.origins, self.directions = np.concatenate(origins), np.concatenate(directions)
        self.clusters, self.ranges = np.concatenate(clusters), np.concatenate(ranges)
        self.walls = nearest_triangle(self, scene.triangles() if triangles is None else triangles)

    @property
    def limits(self):
        return np.minimum(self.ranges, self.walls)

    def sensor_of_ray(self):
        return np.array(self.sensor_of_cluster)[self.clusters]

    def chosen(self, which):
        """The rays of these numbers; a number may come more than once."""
        other = copy.copy(self)
        for name in ("origins", "directions", "clusters", "ranges", "walls"):
            setattr(other, name, getattr(self, name)[which])
        return other

    def joined(self, more):
        other = copy.copy(self)
        for name in ("origins", "directions", "clusters", "ranges", "walls"):
            setattr(other, name, np.concatenate([getattr(self, name), getattr(more, name)]))
        return other


def sorted_sensors(scene):
    """In the order of the file's nodes."""
    placed = {id(node): (node, world) for node, world in scene.nodes()}
    return [placed[id(node)] for node in scene.json["nodes"] if mark(node).get("type") == "sensor" and id(node) in placed]


def facets_of(path):
    """Per facet: five directions for each of its zones, and the range."""
    text = path.read_text()
    numbers_in = lambda part: {key: float(value) for key, value in re.findall(r"(\w+): *([-\d.]+)", part)}
    lens = numbers_in("\n".join(re.findall(r"^\w+: *[-\d.]+ *$", text, re.M)))
    if dome := re.search(r"^dome: *\{(.*)\}", text, re.M):
        return [(directions, lens["range_m"]) for directions in dome_lenses(**numbers_in(dome.group(1)))]
    layout = re.search(r"^layout: *(\w+)", text, re.M).group(1)
    assert "missing: outer" not in text, f"{path}: only whole facets are known here"
    facets = []
    for facet in map(numbers_in, re.findall(r"^ *- \{(x_m:.*)\}", text, re.M)):
        centre = np.array([facet["x_m"], facet["y_m"]])
        to_zones, to_corners = quad(layout, lens, facet, np.sqrt(centre @ centre + lens["plane_m"] ** 2))
        points = [centre + zone + corner for zone in to_zones for corner in np.vstack([to_corners, [[0, 0]]])]
        directions = np.column_stack([points, np.full(len(points), -lens["plane_m"])])
        facets.append((directions, facet.get("range_m", lens.get("range_m"))))
    return facets


def dome_lenses(lenses=29, wide_deg=110, tall_deg=None, focal_mm=12, strip_width_mm=1, strip_height_mm=2, gap_mm=1):
    """[(10, 3)] Of each lens: where the corners and the middles of two strips look through its middle."""
    x = gap_mm / 2 + strip_width_mm * np.array([0, 1, 1, 0, 0.5])
    y = strip_height_mm / 2 * np.array([-1, -1, 1, 1, 0])
    strips = np.column_stack([np.concatenate([x, -x]), np.concatenate([y, y]), np.zeros(10)])
    outermost = np.array([outermost_lens(np.radians(wide_deg) / 2, x.max() / focal_mm),
                          outermost_lens(np.radians(tall_deg or wide_deg) / 2, y.max() / focal_mm)])
    n_rings = min(range(1, 20), key=lambda n: abs(1 + 3 * n * (n + 1) - lenses))
    pairs_within = [int(lenses) // 2 * n * (n + 1) // (n_rings * (n_rings + 1)) for n in range(n_rings + 1)]
    tilts = [np.zeros(2)] * (int(lenses) % 2)
    for ring in range(1, n_rings + 1):
        turns = np.linspace(0, 2 * np.pi, 2 * (pairs_within[ring] - pairs_within[ring - 1]), endpoint=False)
        tilts += [outermost * ring / n_rings * [np.cos(turn), np.sin(turn)] for turn in turns]
    middles = [np.append(np.sinc(np.linalg.norm(tilt) / np.pi) * tilt, -np.cos(np.linalg.norm(tilt))) for tilt in tilts]
    return [focal_mm * middle - strips for middle in middles]


def outermost_lens(edge, far):
    """Angle off the axis of a lens through which the element's far edge, so many focal lengths off the axis, looks out
    at this angle. By bisection."""
    low, high = 0.0, edge
    for _ in range(60):
        angle = (low + high) / 2
        low, high = (low, angle) if np.sin(angle) + far > np.cos(angle) * np.tan(edge) else (angle, high)
    return low


def quad(layout, lens, facet, distance):
    """(4, 2) From a facet's centre to its zones' centres, and (4, 2) from these to a zone's corners, on the plane."""
    if layout == "diamond":
        axes = np.array([[1, 0], [0, 1], [-1, 0], [0, -1]], float)
        return lens["half_spacing_ratio"] * distance * axes, lens["half_diagonal_ratio"] * distance * axes
    diagonals = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]], float)
    side = facet["zone_side_m"]
    return facet.get("pitch_m", side / 0.6) / 2 * diagonals, side / 2 * diagonals


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
    """Against the two spheres, and the round side between them."""
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
    """The solids of all people at every tick, or at the chosen ones, from an exported run."""

    def __init__(self, exported, ticks=slice(None)):
        tracks = {}
        animation = exported.json["animations"][0]
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            tracks[channel["target"]["node"], channel["target"]["path"]] = exported.accessor(sampler["output"], ticks)
            self.times = exported.accessor(sampler["input"], ticks)[:, 0]
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


def covered_rays(rays, motion):
    """Yields (ticks, (n_ticks, n_rays) True where a body is hit before the room and within range), from tick 1 on."""
    last = [np.zeros(len(rays.limits), bool) for _ in motion.solids]  # what each solid covered at the tick before
    for first in range(1, len(motion.times), CHUNK):
        ticks = np.arange(first, min(first + CHUNK, len(motion.times)))
        seen = np.zeros((len(ticks), len(rays.limits)), bool)
        for number, (about, origins, rotations, present) in enumerate(motion.solids):
            moved = (ticks == 1) | (origins[ticks] != origins[ticks - 1]).any(-1) | (present[ticks] != present[ticks - 1])
            moved |= (rotations[ticks] != rotations[ticks - 1]).any((-2, -1))
            poses = ticks[moved]
            t, r = np.nonzero((distance_of_line(rays, origins[poses]) <= reach_of(about) + 1e-6) & present[poses, None])
            hit = entry(about, rays.origins[r], rays.directions[r], origins[poses][t], rotations[poses][t])
            covered = np.concatenate([last[number][None], np.zeros((len(poses), len(rays.limits)), bool)])
            covered[t + 1, r] = hit < rays.limits[r]
            seen |= covered[np.cumsum(moved)]
            last[number] = covered[-1]
        yield slice(ticks[0], ticks[-1] + 1), seen


def distance_of_line(rays, points):
    """(n_points, n_rays) How close each ray comes to each point."""
    to_point = points @ rays.directions.T - (rays.origins * rays.directions).sum(-1)
    along = np.maximum(to_point, 0)
    square = (points**2).sum(-1)[:, None] - 2 * points @ rays.origins.T + (rays.origins**2).sum(-1)
    return np.sqrt(np.maximum(square + along * (along - 2 * to_point), 0))


def covered_shares(rays, motion, covered=covered_rays):
    """(ticks, clusters) share of a cluster's rays that hit a body. The first is empty."""
    shares = np.zeros((len(motion.times), len(rays.sensor_of_cluster)))
    for ticks, seen in covered(rays, motion):
        for cluster in range(shares.shape[1]):
            its = rays.clusters == cluster
            if its.any():
                shares[ticks, cluster] = seen[:, its].mean(1)
    return shares


def windows_of(triggers, ticks_per_window):
    n = len(triggers) // ticks_per_window
    return triggers[: n * ticks_per_window].reshape(n, ticks_per_window, -1).any(1)


# ---------------------------------------------------------------------------------------------------------- commands
def run_pirsim(pirsim, study, *words):
    return subprocess.run([pirsim, *map(str, words), *map(str, study)], check=True, stdout=subprocess.PIPE,
                          text=True).stdout


class Run:
    """What pirsim tells of one run: its rows' times and phases, and where everybody is."""

    def __init__(self, pirsim, study, rows, folder):
        self.replicate, self.trial, self.rows = rows[0]["replicate"], rows[0]["trial"], rows
        exported = pathlib.Path(folder) / "run.gltf"
        run_pirsim(pirsim, study, "export", "-q", "--trial", self.trial, "--replicate", self.replicate, "--keys-per-s",
                   1000, "--beams", "none", "-o", exported)
        self.motion = Motion(Gltf(exported))
        self.rate_hz = round(1 / np.diff(self.motion.times).min())
        self.per_window = round(self.rate_hz * float(rows[0]["time_s"]))
        self.motion.working = np.repeat([False] + [row["phase"] == "working" for row in rows],
                                        [1] + [self.per_window] * len(rows))


def runs_of(pirsim, study, trials=None):
    plain = list(csv.DictReader(run_pirsim(pirsim, study, "-q").splitlines()))
    names = dict.fromkeys((row["replicate"], row["trial"]) for row in plain)
    with tempfile.TemporaryDirectory() as folder:
        return [Run(pirsim, study, [row for row in plain if (row["replicate"], row["trial"]) == name], folder)
                for name in names if not trials or name[1] in trials]


def rows_of(fault, rays, shares, run, random, done=0.0):
    """(rows, sensors) from what the rays hit; done: share of the measurement's runs that came before."""
    triggers = fault.electronics(fault.detect(rays, shares, run.rate_hz, random), run.rate_hz, random)
    return fault.books(windows_of(triggers, run.per_window), random, done)


class Measurement:
    """Rows of every run as sensors with a fault would have measured them."""

    def __init__(self, scene, sensor_folder, fault, seed, plain=None, hang=lambda number, world: world):
        """plain: the measurement with nothing wrong of the same runs, whose rays are not traced again if that is what
        the fault's rays would hit. hang: as `mount` of Rays, how every sensor of the room hangs, fault or not."""
        self.scene, self.fault, self.seed, self.shares = scene, fault, seed, {}
        self.inputs, self.parts = (sensor_folder, seed, plain, hang), {}
        if plain is not None and fault.is_behind_the_optics():
            self.rays, self.shares = plain.rays, plain.shares
        else:
            mount = fault.mount or (lambda number, world: world)
            rays = Rays(scene, sensor_folder, lambda number, world: mount(number, hang(number, world)), fault.range_scale,
                        fault.furnish(scene.triangles()))
            self.rays = fault.optics(rays, np.random.default_rng([seed, 1]))

    def bits(self, runs, number):
        """(rows, sensors) of runs[number]."""
        done = number / max(1, len(runs) - 1)
        if self.fault.in_run is not None:
            return self.with_fault(self.fault.in_run(done)).bits(runs, number)
        random = np.random.default_rng([self.seed, 2, number])
        if number not in self.shares:
            self.shares[number] = covered_shares(self.rays, self.fault.people(runs, number, self.scene, random))
        return rows_of(self.fault, self.rays, self.shares[number], runs[number], random, done)

    def with_fault(self, fault):
        """This measurement with another fault. One that comes again is not traced again."""
        if id(fault) not in self.parts:
            folder, seed, plain, hang = self.inputs
            self.parts[id(fault)] = Measurement(self.scene, folder, fault, seed, plain, hang)
        return self.parts[id(fault)]

    def all_bits(self, runs):
        """[(rows, sensors) of every run], as the file has them."""
        return self.fault.file([self.bits(runs, number) for number in range(len(runs))],
                               np.random.default_rng([self.seed, 4]))

    def write(self, path, runs):
        with open(path, "w", newline="") as file:
            out = csv.writer(file, lineterminator="\n")
            out.writerow(["replicate", "trial", "time_s", "phase", *self.rays.sensors])
            for run, bits in zip(runs, self.all_bits(runs)):
                assert len(bits) == len(run.rows), (len(bits), len(run.rows))
                for row, sensed in zip(run.rows, bits):
                    out.writerow([run.replicate, run.trial, row["time_s"], row["phase"], *sensed.astype(int)])


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
    parser.add_argument("--fault", default="nothing", choices=FAULTS, metavar="NAME", help=", ".join(FAULTS))
    parser.add_argument("--seed", type=int, default=0, help="of the fault's strength and of all that is random in it")
    options = parser.parse_args()

    scene = Gltf(options.scene)
    fault = FAULTS[options.fault](np.random.default_rng([options.seed, 0]))
    study = study_of(options.scene, options.script, [*options.set, f"replicates={options.replicates}", *fault.settings])
    runs = runs_of(options.pirsim, study, options.trials and options.trials.split(","))
    Measurement(scene, options.sensors, fault, options.seed).write(options.output, runs)


def study_of(scene, script, settings):
    return ["--scene", scene, "--script", script, *(word for setting in settings for word in ("--set", setting))]


if __name__ == "__main__":
    sys.exit(main())
