"""What may be wrong with a measurement, coded from the physics of the thing and without a look at pirsim's catalogue.

A fault is drawn once a dataset: FAULTS[name](generator) gives its strength, its sensor and its place. Strengths are
assumed: what somebody who has put up a few such sensors would meet and mind. `truth` holds the catalogue's names that
describe the cause, and is empty for an unknown, which the catalogue lacks. `expects` holds what a look at the file should
tell, if the file itself is faulty.
"""
import copy
import dataclasses

import numpy as np

N_SENSORS = 5


def same(value, *_):
    return value


def own_motion(runs, number, scene, random):
    return runs[number].motion


def sharp(rays, shares, rate_hz=None, random=None):
    """The paper's detector: a cluster wakes or falls silent. Triggers (ticks, sensors) from tick 1 on."""
    active = shares > 0
    return by_sensor(rays, active[1:] != active[:-1])


def by_sensor(rays, of_clusters):
    sensor = np.array(rays.sensor_of_cluster)
    return np.column_stack([of_clusters[:, sensor == i].any(1) for i in range(len(rays.sensors))])


@dataclasses.dataclass
class Fault:
    """One measurement's, along the way of the signal."""

    what: str
    truth: tuple = ()
    settings: tuple = ()  # of the study: `pirsim --set`
    furnish: object = same  # triangles (n, 3, 3)
    mount: object = None  # sensor's number, matrix -> matrix
    range_scale: float = 1.0
    optics: object = same  # rays, random -> rays
    people: object = own_motion  # runs, number, scene, random -> motion
    detect: object = sharp  # rays, shares (ticks, clusters), rate_hz, random -> triggers (ticks, sensors)
    electronics: object = same  # triggers, rate_hz, random -> triggers
    books: object = same  # windows (rows, sensors), random, share of the runs that are done -> windows
    in_run: object = None  # share of the runs that are done -> the Fault of that run, which counts instead of all above
    file: object = same  # windows of every run, random -> the same, as the file has them
    expects: tuple = ()  # kinds of findings in report.json's data_findings

    def is_behind_the_optics(self):
        """Room, rays and people are the plain ones."""
        if self.in_run is not None:
            return all(self.in_run(done).is_behind_the_optics() for done in (0.0, 0.5, 1.0))
        plain = (same, None, 1.0, same, own_motion, ())
        return (self.furnish, self.mount, self.range_scale, self.optics, self.people, self.settings) == plain


FAULTS = {}


def fault(make):
    FAULTS[make.__name__] = make
    return make


def either_side(draw, low, high):
    return draw.choice([-1, 1]) * draw.uniform(low, high)


def turn_about(axis, angle):
    """(..., 3, 3) Rotation by Rodrigues' formula; axis (3) of length 1, angle (...) in radians."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.asarray(angle)[..., None, None]
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * (cross @ cross)


@fault
def nothing(draw):
    return Fault("nothing")


# ------------------------------------------------------------------------------------------------------------ mounting
def hung_otherwise(draw, what, truth, change):
    """change: of the sensor's own frame, as a 4 x 4 matrix."""
    which = draw.integers(N_SENSORS)
    return Fault(what, truth, mount=lambda number, world: world @ change if number == which else world)


def rotation(axis, degrees):
    matrix = np.eye(4)
    matrix[:3, :3] = turn_about(np.array(axis, float), np.radians(degrees))
    return matrix


def hung(world, yaw_deg, tilt_deg):
    """A sensor's matrix, turned about the vertical through it and about its own level axis."""
    result = world.copy()
    result[:3, :3] = rotation([0, 1, 0], yaw_deg)[:3, :3] @ world[:3, :3]
    return result @ rotation([1, 0, 0], tilt_deg)


@fault
def turned(draw):
    return hung_otherwise(draw, "a sensor is turned by 5 to 8 degrees", ("sensor_yaw",),
                          rotation([0, 1, 0], either_side(draw, 5, 8)))


@fault
def tipped(draw):
    return hung_otherwise(draw, "a sensor is tipped by 4 to 6 degrees", ("sensor_tilt",),
                          rotation([1, 0, 0], either_side(draw, 4, 6)))


@fault
def lowered(draw):
    down = np.eye(4)
    down[1, 3] = -draw.uniform(0.2, 0.3)
    return hung_otherwise(draw, "a sensor hangs 20 to 30 cm lower", ("sensor_height",), down)


# ---------------------------------------------------------------------------------------------------------------- room
@fault
def cabinet(draw):
    where, height = draw.uniform(0.25, 0.75, 2), draw.uniform(1.3, 1.9)

    def furnish(triangles):
        low, high = triangles.reshape(-1, 3).min(0), triangles.reshape(-1, 3).max(0)
        corner = np.array([0, low[1], 0])
        corner[[0, 2]] = low[[0, 2]] + where * (high - low)[[0, 2]]
        size = np.array([0.5, height, 0.5])
        corners = np.array([corner + size * [i & 1, i >> 1 & 1, i >> 2] for i in range(8)])
        quads = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
        faces = [corners[[q[0], q[i], q[i + 1]]] for q in quads for i in (1, 2)]
        return np.concatenate([triangles, faces])

    return Fault("a cabinet stands in the room", ("missing_occluder",), furnish=furnish)


@fault
def whiteboard(draw):
    """A metal board on one wall: what a beam hits there, it hits by way of the mirror."""
    axis, side = draw.choice([0, 2]), draw.integers(2)

    def optics(rays, random):
        ends = rays.origins + rays.walls[:, None] * rays.directions
        wall = ends[:, axis].max() if side else ends[:, axis].min()
        on_board = (np.abs(ends[:, axis] - wall) < 0.02) & (ends[:, 1] > 0.7) & (ends[:, 1] < 2.2)
        mirrored = rays.chosen(on_board & (rays.walls < rays.ranges))
        mirrored.ranges = mirrored.ranges - mirrored.walls
        mirrored.origins = mirrored.origins + (mirrored.walls - 1e-6)[:, None] * mirrored.directions
        mirrored.directions = mirrored.directions * np.where(np.arange(3) == axis, -1.0, 1.0)
        mirrored.walls = np.full(len(mirrored.ranges), np.inf)  # furniture on the way back is left out
        return rays.joined(mirrored)

    return Fault("a wall has a metal board that mirrors", ("wall_reflection",), optics=optics)


# -------------------------------------------------------------------------------------------------------------- optics
@fault
def dull_lens(draw):
    return Fault("all sensors see two thirds as far", ("range_scale",), range_scale=draw.uniform(0.55, 0.7))


@fault
def half_blind(draw):
    which, share, side = draw.integers(N_SENSORS), draw.uniform(0.4, 0.6), draw.uniform(0, 2 * np.pi)

    def optics(rays, random):
        mine = rays.sensor_of_ray() == which
        ahead = rays.directions[mine].mean(0)
        right = np.cross(ahead, [0, 1, 0])
        up = np.cross(right, ahead)
        across = rays.directions @ (np.cos(side) * right / np.linalg.norm(right) + np.sin(side) * up / np.linalg.norm(up))
        return rays.chosen(~mine | (across < np.quantile(across[mine], 1 - share)))

    return Fault("a part of one lens is covered", ("blind_field",), optics=optics)


def blurred(degrees, copies=5):
    """Each ray becomes several, which deviate as the lens scatters."""

    def optics(rays, random):
        many = rays.chosen(np.tile(np.arange(len(rays.ranges)), copies))
        directions = many.directions + np.radians(degrees) * random.standard_normal(many.directions.shape)
        many.directions = directions / np.linalg.norm(directions, axis=1, keepdims=True)
        return many

    return optics


@fault
def blurred_by_area(draw):
    """A comparator behind an amplifier that passes changes within half a second."""
    degrees, step = draw.uniform(0.8, 1.6), draw.uniform(0.15, 0.3)

    def detect(rays, shares, rate_hz, random):
        lag = rate_hz // 2
        before = np.concatenate([np.repeat(shares[:1], lag, 0), shares])[: len(shares)]
        return by_sensor(rays, np.abs(shares - before)[1:] > step)

    return Fault("zones are blurred, and a change of the covered area counts", ("soft_zone_edges",),
                 optics=blurred(degrees), detect=detect)


@fault
def blurred_by_chance(draw):
    """Noise decides: the more area is swept at a tick, the likelier it is noticed."""
    degrees, gain = draw.uniform(0.8, 1.6), draw.uniform(1.0, 2.0)

    def detect(rays, shares, rate_hz, random):
        swept = np.abs(np.diff(shares, axis=0))
        return by_sensor(rays, random.random(swept.shape) < 1 - np.exp(-gain * swept))

    return Fault("zones are blurred, and a swept area is noticed with a chance", ("soft_zone_edges",),
                 optics=blurred(degrees), detect=detect)


# -------------------------------------------------------------------------------------------------------------- people
def moved(motion, change):
    """A copy of the motion with other solids."""
    other = copy.copy(motion)
    other.solids = [change(*solid) for solid in motion.solids]
    return other


def part(motion, name):
    return next(solid for solid in motion.solids if solid[0].get("part") == name)


def with_people(change):
    """change: motion, random -> motion."""
    return lambda runs, number, scene, random: change(runs[number].motion, random)


@fault
def chairs_back(draw):
    back_m = draw.uniform(0.15, 0.25)

    def people(motion, random):
        ahead = -part(motion, "pelvis")[2][motion.working][..., :, 2].mean(0)
        shift = -back_m * np.array([ahead[0], 0, ahead[2]]) / np.hypot(ahead[0], ahead[2])
        return moved(motion, lambda about, origins, rotations, present: (about, origins + shift, rotations, present))

    return Fault("everybody sits 15 to 25 cm further back", ("seat_shift",), people=with_people(people))


@fault
def small_person(draw):
    stature = round(draw.uniform(1.5, 1.6), 2)
    return Fault("the person is 1.5 to 1.6 m tall", ("body_size",), settings=(f"people.0.stature_m={stature}",))


@fault
def small_arm_movements(draw):
    amplitude = round(draw.uniform(0.03, 0.05), 3)
    return Fault("arms move by 3 to 5 cm", ("arm_motion",),
                 settings=(f"people.0.actions.3.work.arm_amplitude_m={amplitude}",))


@fault
def keeps_still(draw):
    tilt = round(draw.uniform(4, 7), 1)
    return Fault("the trunk tilts by 4 to 7 degrees", ("trunk_tilt",),
                 settings=(f"people.0.actions.3.work.tilt_choices_deg=[{-tilt}, 0, {tilt}]",))


def turned_about(pivot, rotations_of_ticks, names=None):
    """Solids (of these names) turn about a point (ticks, 3) by (ticks, 3, 3)."""

    def change(about, origins, rotations, present):
        if names is not None and not any(name in about["part"] for name in names):
            return about, origins, rotations, present
        moved_origins = pivot + np.einsum("tij,tj->ti", rotations_of_ticks, origins - pivot)
        return about, moved_origins, rotations_of_ticks @ rotations, present

    return change


def in_bouts(working, rate_hz, period_s, random, share):
    """(ticks) A sine in bouts of whole periods, as long as the person works."""
    period = round(period_s * rate_hz)
    bout = period * max(1, round(20 / period_s))
    wave = np.zeros(len(working))
    ticks = np.flatnonzero(working)
    for first in range(0, len(ticks) - bout, bout):
        if random.random() < share:
            wave[ticks[first : first + bout]] = np.sin(2 * np.pi * np.arange(bout) / period)
    return wave


@fault
def swings_on_the_chair(draw):
    angle, period_s = np.radians(draw.uniform(8, 20)), draw.uniform(2, 5)

    def people(motion, random):
        wave = angle * in_bouts(motion.working, 50, period_s, random, 0.5)
        return moved(motion, turned_about(part(motion, "pelvis")[1], turn_about([0, 1, 0], wave)))

    return Fault("the sitter swings on the chair, half of the time", ("chair_swing",), people=with_people(people))


@fault
def sways(draw):
    angle, period_s = np.radians(draw.uniform(1.5, 3)), draw.uniform(3, 6)

    def people(motion, random):
        pelvis = part(motion, "pelvis")
        ahead = pelvis[2][motion.working][..., :, 2].mean(0)
        wave = angle * in_bouts(motion.working, 50, period_s, random, 1.0)
        turn = turned_about(pelvis[1], turn_about(ahead / np.linalg.norm(ahead), wave), ("torso", "head", "arm"))
        return moved(motion, turn)

    return Fault("the sitter's trunk sways from side to side", ("trunk_sway",), people=with_people(people))


def sits_there_too(runs, number, which):
    """Solids of the person of another run, at work for as long as this one lasts."""
    ticks, other = np.arange(len(runs[number].motion.times)), runs[which].motion
    working = np.flatnonzero(other.working)
    at = working[ticks % len(working)]
    return [(about, origins[at], rotations[at], np.ones(len(at), bool)) for about, origins, rotations, _ in other.solids]


@fault
def colleague(draw):
    share = draw.random()

    def people(runs, number, scene, random):
        which = int(share * len(runs))
        if which == number:
            return runs[number].motion
        other = copy.copy(runs[number].motion)
        other.solids = [*other.solids, *sits_there_too(runs, number, which)]
        return other

    return Fault("a colleague works on another seat", ("second_person",), people=people)


def warm_sphere(radius_m, path):
    """path: ticks, floor's low and high corner, random -> (ticks, 3)."""

    def people(runs, number, scene, random):
        other = copy.copy(runs[number].motion)
        corners = scene.triangles().reshape(-1, 3)
        origins = path(np.arange(len(other.times)) / 50, corners.min(0), corners.max(0), random)
        eye = np.broadcast_to(np.eye(3), (len(origins), 3, 3))
        about = {"primitive": "sphere", "radius_m": radius_m}
        other.solids = [*other.solids, (about, origins, eye, np.ones(len(origins), bool))]
        return other

    return people


@fault
def cat(draw):
    """Walks along a wall, rests, walks on."""
    axis, side = draw.choice([0, 2]), draw.integers(2)

    def path(times, low, high, random):
        places, at = np.zeros(len(times)), random.random()
        tick = 0
        while tick < len(times):
            rest, goal = round(random.exponential(15) * 50), random.uniform(0.1, 0.9)
            places[tick : tick + rest] = at
            tick += rest
            n = max(1, round(abs(goal - at) * (high - low)[2 - axis] / 0.5 * 50))
            places[tick : tick + n] = np.linspace(at, goal, n)[: max(0, len(times) - tick)]
            tick, at = tick + n, goal
        point = np.empty((len(times), 3))
        point[:, 1] = low[1] + 0.15
        point[:, axis] = high[axis] - 0.4 if side else low[axis] + 0.4
        point[:, 2 - axis] = low[2 - axis] + places * (high - low)[2 - axis]
        return point

    return Fault("a cat walks along a wall", ("warm_object",), people=warm_sphere(0.12, path))


@fault
def fan_heater(draw):
    where, period_s, height = draw.uniform(0.2, 0.8, 2), draw.uniform(5, 9), draw.uniform(0.5, 1.1)

    def path(times, low, high, random):
        point = np.empty((len(times), 3))
        point[:, 1] = low[1] + height
        for axis, share in zip((0, 2), where):
            point[:, axis] = low[axis] + share * (high[axis] - low[axis])
        point[:, 0] += 0.25 * np.sin(2 * np.pi * times / period_s)
        return point

    return Fault("a fan heater sweeps to and fro", ("warm_object",), people=warm_sphere(0.15, path))


# --------------------------------------------------------------------------------------------------------- electronics
@fault
def lost_telegrams(draw):
    chance = draw.uniform(0.25, 0.4)
    return Fault("the radio loses seconds", ("missed_triggers",),
                 books=lambda windows, random, done: windows & (random.random(windows.shape) >= chance))


def heard(chance):
    """A change of one cluster is a weak signal; the more change at a tick, the surer it is heard."""

    def detect(rays, shares, rate_hz, random):
        active = shares > 0
        changed = active[1:] != active[:-1]
        return by_sensor(rays, changed & (random.random(changed.shape) < chance))

    return detect


def noisy(rate):
    """Triggers from nothing, by the second; rate: of all sensors, or of each."""
    return lambda t, rate_hz, random: t | (random.random(t.shape) < rate / rate_hz)


@fault
def weak_comparator(draw):
    return Fault("the comparator misses weak signals", ("missed_triggers",), detect=heard(draw.uniform(0.1, 0.25)))


@fault
def noise_spikes(draw):
    return Fault("noise trips each sensor", ("false_triggers",), electronics=noisy(draw.uniform(0.02, 0.05)))


@fault
def supply_glitches(draw):
    rate = draw.uniform(0.02, 0.05)
    return Fault("the supply trips all sensors at once", ("false_triggers",),
                 electronics=lambda t, rate_hz, random: t | (random.random((len(t), 1)) < rate / rate_hz))


@fault
def draught(draw):
    every_s, lasts_s = draw.uniform(40, 90), draw.uniform(3, 8)

    def electronics(triggers, rate_hz, random):
        phase = (np.arange(len(triggers)) / rate_hz + random.uniform(0, every_s)) % every_s
        return triggers | ((phase < lasts_s)[:, None] & (random.random(triggers.shape) < 2 / rate_hz))

    return Fault("a heating's draught trips the sensors again and again", ("trigger_bursts",), electronics=electronics)


def blind_after(blind_s):
    """A trigger, then none for blind_s."""

    def electronics(triggers, rate_hz, random):
        triggers = triggers.copy()
        for column in triggers.T:
            awake = 0
            for tick in np.flatnonzero(column):
                column[tick] = tick >= awake
                awake = tick + round(blind_s * rate_hz) if tick >= awake else awake
        return triggers

    return electronics


def held_on(hold_s):
    """The output is on for hold_s, at least a tick, from the last trigger on."""

    def electronics(triggers, rate_hz, random):
        held = np.cumsum(np.vstack([np.zeros((1, triggers.shape[1]), int), triggers]), axis=0)
        before = np.maximum(np.arange(1, len(held)) - max(1, round(hold_s * rate_hz)), 0)
        return held[1:] > held[before]

    return electronics


@fault
def lock_out(draw):
    return Fault("a sensor is blind for some seconds after a trigger", ("dead_time",),
                 electronics=blind_after(draw.uniform(2.5, 4.5)))


@fault
def monostable(draw):
    return Fault("the output stays on for some seconds after the last trigger", ("pulse_stretching",),
                 electronics=held_on(draw.uniform(1.5, 3)))


# --------------------------------------------------------------------------------------------------------------- books
@fault
def swapped_wires(draw):
    one, other = draw.choice(N_SENSORS, 2, replace=False)
    order = np.arange(N_SENSORS)
    order[[one, other]] = other, one
    return Fault("two sensors' wires are swapped", ("labels_swapped",),
                 books=lambda windows, random, done: windows[:, order])


@fault
def late_clock(draw):
    lag = draw.integers(4, 9)

    def books(windows, random, done):
        return np.concatenate([np.zeros((lag, windows.shape[1]), bool), windows[:-lag]])

    return Fault("the logger's clock is 4 to 8 s late", ("clock_lag",), books=books)


@fault
def broken_sensor(draw):
    which = draw.integers(N_SENSORS)
    return Fault("a sensor says nothing", ("dead_sensor", "missed_triggers"),
                 books=lambda windows, random, done: windows & (np.arange(windows.shape[1]) != which))


# ------------------------------------------------------------------------------------------------------------ unknowns
@fault
def late_telegrams(draw):
    most = draw.integers(3, 6)

    def books(windows, random, done):
        late = np.zeros_like(windows)
        rows, sensors = np.nonzero(windows)
        late[np.minimum(rows + random.integers(0, most + 1, len(rows)), len(late) - 1), sensors] = True
        return late

    return Fault("telegrams come up to some seconds late, each by itself", books=books)


@fault
def fading_battery(draw):
    worst = draw.uniform(0.6, 0.9)
    return Fault("more and more is missed from trial to trial", ("missed_triggers",),
                 books=lambda windows, random, done: windows & (random.random(windows.shape) >= worst * done))


@fault
def frozen_logger(draw):
    lasts = draw.integers(8, 20)

    def books(windows, random, done):
        windows = windows.copy()
        for _ in range(1 + len(windows) // 50):
            first = random.integers(1, len(windows) - lasts)
            windows[first : first + lasts] = windows[first - 1]
        return windows

    return Fault("the logger repeats its last row for a while, now and then", books=books)


@fault
def cross_talk(draw):
    one, other = draw.choice(N_SENSORS, 2, replace=False)
    chance = draw.uniform(0.5, 0.9)

    def books(windows, random, done):
        windows = windows.copy()
        windows[:, one] |= windows[:, other] & (random.random(len(windows)) < chance)
        return windows

    return Fault("a sensor's line picks up another's pulses", books=books)


@fault
def dazzled(draw):
    every_s, lasts_s = draw.uniform(50, 90), draw.uniform(15, 25)

    def electronics(triggers, rate_hz, random):
        phase = (np.arange(len(triggers)) / rate_hz + random.uniform(0, every_s)) % every_s
        return triggers & (phase >= lasts_s)[:, None]

    return Fault("all sensors are blind together again and again, as in passing sunlight", electronics=electronics)


@fault
def inverted(draw):
    which = draw.integers(N_SENSORS)
    return Fault("a sensor's output is inverted",
                 books=lambda windows, random, done: windows ^ (np.arange(windows.shape[1]) == which))


@fault
def changes_seats(draw):
    """Half way through the work the person sits on the next seat."""

    def people(runs, number, scene, random):
        motion, others = runs[number].motion, runs[(number + 1) % len(runs)].motion
        ticks = np.flatnonzero(motion.working)
        n = min(len(motion.times), len(others.times))
        later = np.arange(len(motion.times)) > ticks[len(ticks) // 2]
        at = np.minimum(np.arange(len(motion.times)), n - 1)
        other = copy.copy(motion)
        other.solids = [
            (about, np.where(later[:, None], o2[at], o1), np.where(later[:, None, None], r2[at], r1),
             np.where(later, p2[at], p1))
            for (about, o1, r1, p1), (_, o2, r2, p2) in zip(motion.solids, others.solids)]
        return other

    return Fault("the person changes seats half way", people=people)


@fault
def polled(draw):
    every = draw.integers(3, 6)

    def books(windows, random, done):
        return windows[np.arange(len(windows)) // every * every]

    return Fault("the logger asks only every few seconds and repeats the answer", books=books, expects=("polled",))


# ---------------------------------------------------------------------------------------------- changes through a session
def half_way(what, before, after):
    """Everything is as `before` says in the first half of the session's runs, and then as `after` says."""
    return Fault(what, in_run=lambda done: before if done < 0.5 else after)


@fault
def warming_room(draw):
    """The room warms up towards the people's surface. A small target is seen as far as the root of its contrast."""
    left = draw.uniform(0.15, 0.35)

    def in_run(done):
        return Fault("", range_scale=np.sqrt(1 - (1 - left) * done))

    return Fault("the room warms up from trial to trial, so that people stand out less", in_run=in_run)


@fault
def coat(draw):
    return half_way("half way through the session the person puts on a coat", Fault(""),
                    Fault("", range_scale=np.sqrt(draw.uniform(0.2, 0.4))))


@fault
def knocked(draw):
    which, change = draw.integers(N_SENSORS), rotation([0, 1, 0], either_side(draw, 12, 20))
    return half_way("half way through the session a sensor is knocked and turned by 12 to 20 degrees", Fault(""),
                    Fault("", mount=lambda number, world: world @ change if number == which else world))


@fault
def longer_hold(draw):
    return half_way("half way through the session the hold of the outputs is turned up", Fault(""),
                    Fault("", electronics=held_on(draw.uniform(2, 4))))


@fault
def growing_noise(draw):
    most = draw.uniform(0.06, 0.12)
    return Fault("noise trips each sensor more and more often from trial to trial",
                 in_run=lambda done: Fault("", electronics=noisy(most * done)))


# ------------------------------------------------------------------------------------------------ all sensors at once
@fault
def jammed_radio(draw):
    """Another sender takes the channel for some seconds, again and again."""
    chance = draw.uniform(0.25, 0.4)

    def books(windows, random, done):
        jammed = np.zeros(len(windows), bool)
        while jammed.mean() < chance:
            first = random.integers(len(windows))
            jammed[first : first + random.integers(1, 4)] = True
        return windows & ~jammed[:, None]

    return Fault("the radio is jammed now and then, and all sensors lose the same seconds", books=books)


@fault
def mains_pulse(draw):
    every_s = draw.uniform(15, 40)

    def electronics(triggers, rate_hz, random):
        first = random.uniform(0, every_s)
        triggers = triggers.copy()
        triggers[np.arange(first * rate_hz, len(triggers), every_s * rate_hz).astype(int)] = True
        return triggers

    return Fault("a compressor switches, and its pulse on the mains trips all sensors", ("false_triggers", "trigger_bursts"),
                 electronics=electronics)


@fault
def clouds(draw):
    """The patch of sun on the floor goes and comes: all sensors see the room flicker for some seconds."""
    every_s, lasts_s = draw.uniform(25, 50), draw.uniform(3, 8)

    def electronics(triggers, rate_hz, random):
        triggers = triggers.copy()
        at = random.exponential(every_s)
        while at * rate_hz < len(triggers):
            n = len(triggers[int(at * rate_hz) : int((at + lasts_s) * rate_hz)])
            triggers[int(at * rate_hz) : int(at * rate_hz) + n] |= random.random((n, 1)) < 1.5 / rate_hz
            at += random.exponential(every_s)
        return triggers

    return Fault("sun and clouds trip all sensors together for some seconds", ("trigger_bursts", "false_triggers"),
                 electronics=electronics)


# ------------------------------------------------------------------------------------------------------------ the file
@fault
def twin_columns(draw):
    """Two sensors on one input."""
    one, other = draw.choice(N_SENSORS, 2, replace=False)

    def file(runs, random):
        return [np.where(np.arange(N_SENSORS) == other, run[:, [one]], run) for run in runs]

    return Fault("a sensor's column holds another's rows", file=file, expects=("equal_columns",))


@fault
def heartbeat(draw):
    """The gateway polls the sensor, and writes its sign of life as motion."""
    which, every = draw.integers(N_SENSORS), 5

    def file(runs, random):
        return [run | ((np.arange(len(run)) % every == 0)[:, None] & (np.arange(N_SENSORS) == which)) for run in runs]

    return Fault("a sensor's sign of life every 5 s is logged as motion", file=file, expects=("beats",))


@fault
def pasted_rows(draw):
    """A download that overlaps: a part of one run stands in another, too."""
    lasts, share = draw.integers(40, 70), draw.uniform(size=2)

    def file(runs, random):
        runs = [run.copy() for run in runs]
        source = int(share[0] * len(runs))
        target = (source + 1 + int(share[1] * (len(runs) - 1))) % len(runs)
        n = min(lasts, len(runs[source]) // 2, len(runs[target]) // 2)
        changes = (runs[source][1:] != runs[source][:-1]).any(1)  # a minute without any could be from anywhere
        busy = np.convolve(changes, np.ones(n), "valid").argmax()
        first = random.integers(len(runs[target]) - n)
        runs[target][first : first + n] = runs[source][busy : busy + n]
        return runs

    return Fault("a minute of one run stands in another as well", file=file, expects=("repeated_rows",))


@fault
def trial_copied(draw):
    """Somebody saved a trial under the next one's name."""
    share = draw.random()

    def file(runs, random):
        runs = [run.copy() for run in runs]
        source = int(share * len(runs))
        target = (source + 1) % len(runs)
        n = min(len(runs[source]), len(runs[target]))
        runs[target][:n] = runs[source][:n]
        return runs

    return Fault("a trial's rows are those of the trial before", file=file, expects=("repeated_rows",))


@fault
def gap_of_zeros(draw):
    """The gateway starts anew; what it didn't hear is filled with zeros."""
    lasts, share = draw.integers(40, 80), draw.random()

    def file(runs, random):
        runs = [run.copy() for run in runs]
        target = runs[int(share * len(runs))]
        first = random.integers(max(1, len(target) - lasts))
        target[first : first + lasts] = False
        return runs

    return Fault("for a minute nothing was recorded, and zeros stand there", file=file, expects=("all_silent",))


@fault
def sorted_as_text(draw):
    """A spreadsheet puts second 10 before second 2, and the seconds are numbered anew."""

    def file(runs, random):
        return [run[sorted(range(len(run)), key=lambda row: str(row + 1))] for run in runs]

    return Fault("rows are sorted by their time as text", file=file)


@fault
def other_order(draw):
    """Recorded in another order than the list of trials says."""

    def file(runs, random):
        longest = max(len(run) for run in runs)
        moved = [np.concatenate([run, np.zeros((longest - len(run), N_SENSORS), bool)]) for run in runs]
        return [moved[number - 1][: len(run)] for number, run in enumerate(runs)]

    return Fault("every trial has the rows of the one before", ("labels_swapped",), file=file)
